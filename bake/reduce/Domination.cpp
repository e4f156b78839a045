#include "bake/reduce/Domination.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

constexpr double largestLambda = 10; ///< multiplier of the S-lemma that is tried

/// A bound of how much |y_k|^2 - beta |y_p|^2 can grow over the cell against its value at the centre: of
/// 2 y_k . D_k - 2 beta y_p . D_p + |D_k|^2 - lambda |D_p|^2 with D the displacements of the two centres.
/// Returns as soon as it exceeds stopAt.
double growthBound(const CellMotion& cell, const PairInCell& k, const PairInCell& p, double beta,
                   double lambda, double stopAt) {
    double bound = 0;
    for (std::size_t l = 0; l < cell.dofs(); ++l)
        bound += std::abs(k.slope[l] - beta * p.slope[l]) * cell.half(l);
    bound *= 2;
    if (bound > stopAt) return bound;
    const double apart = (k.x - p.x).norm();
    const double curve =
        apart * cell.relativeMove() * (k.move + p.move) + std::max(0.0, 1 - lambda) * p.move * p.move;
    bound += std::min(curve, k.move * k.move) + 2 * apart * k.distance * cell.relativeRemainder();
    return bound + 2 * (k.y - beta * p.y).norm() * p.remainder;
}

/// Yes/no tables: whether |y_p| <= R_p implies |y_k| <= limit all over the cell. By the S-lemma this follows
/// from |y_k|^2 - limit^2 <= lambda (|y_p|^2 - R_p^2) for some lambda >= 0; tried is the lambda for which the
/// slopes of both sides agree best.
bool contactImplied(const CellMotion& cell, const PairInCell& k, const PairInCell& p, double limit,
                    double slack) {
    double kp = 0, pp = 0;
    for (std::size_t l = 0; l < cell.dofs(); ++l) {
        const double h2 = cell.half(l) * cell.half(l);
        kp += h2 * k.slope[l] * p.slope[l];
        pp += h2 * p.slope[l] * p.slope[l];
    }
    const double ownK = k.squared - limit * limit;
    const double ownP = p.squared - p.contactPair.contactDistance * p.contactPair.contactDistance;
    const auto shown = [&](double lambda) {
        const double free = lambda * ownP - ownK - slack * (1 + lambda);
        return free > 0 && growthBound(cell, k, p, lambda, lambda, free) <= free;
    };
    const double lambda = pp > 0 ? std::clamp(kp / pp, 0.0, largestLambda) : 1.0;
    return lambda > 0 && shown(lambda);
}

/// Gap-true tables: whether |y_k| <= |y_p| + extra all over the cell, shown for the squares. |y_p| is bounded
/// by its tangent parabola where extra < 0, by its tangent plane where extra >= 0; both have the slope beta.
bool distanceBounded(const CellMotion& cell, const PairInCell& k, const PairInCell& p, double extra,
                     double slack) {
    if (p.distance <= 0 || p.distance + extra <= 0) return false;
    if (extra < 0 && p.distance - p.move + extra < 0) return false;
    const double beta = 1 + extra / p.distance;
    const double sum = p.distance + extra;
    const double free = sum * sum - k.squared - slack;
    return free > 0 && growthBound(cell, k, p, beta, std::min(1.0, beta), free) <= free;
}

} // namespace

bool dominates(const CellMotion& cell, const PairInCell& k, const PairInCell& p,
               const ErrorContract& contract, double band) {
    const double slack = 16 * (k.distance + p.distance + k.move + p.move + band) * band;
    if (contract.yesNo())
        return contactImplied(cell, k, p, k.contactPair.contactDistance + contract.epsilon, slack);
    return distanceBounded(
        cell, k, p, k.contactPair.contactDistance - p.contactPair.contactDistance + contract.epsilon, slack);
}

double answerRank(const PairInCell& k, const ErrorContract& contract) {
    const double limit = k.contactPair.contactDistance + contract.epsilon;
    return contract.yesNo() ? k.squared - limit * limit : k.gap;
}

double rankNeeded(const PairInCell& p, const ErrorContract& contract) {
    if (!contract.yesNo()) return p.gap + contract.epsilon;
    return largestLambda *
           std::max(0.0, p.squared - p.contactPair.contactDistance * p.contactPair.contactDistance);
}

} // namespace tss
