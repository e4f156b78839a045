#include "bake/reduce/Domination.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

constexpr double largestLambda = 10; ///< that is tried

/// How much the comparison of k with p can grow over the cell against its value at the centre. With D the
/// moves of the two centres: 2 y_k . D_k - 2 beta y_p . D_p + |D_k|^2 - lambda |D_p|^2. Gives up, above
/// stopAt, early.
double change(const CellMotion& cell, const PairInCell& k, const PairInCell& p, double beta, double lambda,
              double stopAt) {
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

/// Yes/no: |y_p| <= R_p implies |y_k| <= limit, shown by |y_k|^2 - limit^2 <= lambda (|y_p|^2 - R_p^2) for
/// some lambda >= 0. The best lambda makes the slopes agree.
bool firesWith(const CellMotion& cell, const PairInCell& k, const PairInCell& p, double limit, double slack) {
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
        return free > 0 && change(cell, k, p, lambda, lambda, free) <= free;
    };
    const double lambda = pp > 0 ? std::clamp(kp / pp, 0.0, largestLambda) : 1.0;
    return lambda > 0 && shown(lambda);
}

/// |y_k| <= |y_p| + extra all over the cell. With extra < 0 the root is bounded by its tangent parabola, with
/// extra >= 0 by its tangent plane; both have the slope beta.
bool staysNearer(const CellMotion& cell, const PairInCell& k, const PairInCell& p, double extra,
                 double slack) {
    if (p.distance <= 0 || p.distance + extra <= 0) return false;
    if (extra < 0 && p.distance - p.move + extra < 0) return false;
    const double beta = 1 + extra / p.distance;
    const double sum = p.distance + extra;
    const double free = sum * sum - k.squared - slack;
    return free > 0 && change(cell, k, p, beta, std::min(1.0, beta), free) <= free;
}

} // namespace

bool dominates(const CellMotion& cell, const PairInCell& k, const PairInCell& p, const ErrorContract& owed,
               double band) {
    const double slack = 16 * (k.distance + p.distance + k.move + p.move + band) * band;
    if (owed.yesNo()) return firesWith(cell, k, p, k.contactPair.contactDistance + owed.epsilon, slack);
    return staysNearer(cell, k, p,
                       k.contactPair.contactDistance - p.contactPair.contactDistance + owed.epsilon, slack);
}

double answerRank(const PairInCell& k, const ErrorContract& owed) {
    const double limit = k.contactPair.contactDistance + owed.epsilon;
    return owed.yesNo() ? k.squared - limit * limit : k.gap;
}

double rankNeeded(const PairInCell& p, const ErrorContract& owed) {
    if (!owed.yesNo()) return p.gap + owed.epsilon;
    return largestLambda *
           std::max(0.0, p.squared - p.contactPair.contactDistance * p.contactPair.contactDistance);
}

} // namespace tss
