#include "bake/verify/KernelProofs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tss::verify {

namespace {

/// Whatever a DOF's polynomial in its factors 1, first, second is off by at three values, it is off anywhere
/// in the limits by no more than this times as much.
constexpr double betweenNodes = 7;

/// Range of a DOF's factor about the middle of its limits: 1, sin d, 1 - cos d; or 1, d, d^2.
std::pair<Real, Real> factorRange(const Dof& dof, int which) {
    const Real half = (Real(dof.upper) - Real(dof.lower)) / 2;
    if (which == 0) return {1, 1};
    if (dof.kind == DofKind::Translation)
        return which == 1 ? std::pair(-half, half) : std::pair(Real(0), half * half);
    const Real quarter = std::numbers::pi_v<Real> / 2;
    if (which == 1) {
        const Real most = half < quarter ? std::sin(half) : Real(1);
        return {-most, most};
    }
    return {0, half < 2 * quarter ? 1 - std::cos(half) : Real(2)};
}

/// Which of the 3^#DOFs products of factors a feature is.
std::size_t productOf(const FeatureForm::Feature& feature, std::size_t dofs) {
    std::size_t index = 0;
    for (std::size_t k = dofs; k-- > 0;) index = 3 * index + feature.factor[k];
    return index;
}

/// Squared distances of all tests as polynomials of the products of factors, by their values at three poses a
/// DOF. #tests by 3^#DOFs.
/// farthest: the largest of the values, one per test.
std::vector<std::vector<Real>> exactProducts(const Motion& motion, const std::vector<Exact>& tests,
                                             std::vector<Real>& farthest) {
    const std::size_t dofs = motion.dofCount();
    std::size_t count = 1;
    for (std::size_t k = 0; k < dofs; ++k) count *= 3;
    std::vector<Real> middle, node;
    for (const Dof& dof : motion.dofs) {
        const Real half = (Real(dof.upper) - Real(dof.lower)) / 2;
        middle.push_back(dof.lower + 0.5 * (dof.upper - dof.lower)); // as the factors have it, in double
        node.push_back(dof.kind == DofKind::Rotation ? std::min<Real>(half, 1.25) : half);
    }
    std::vector<std::vector<Real>> weights(tests.size(), std::vector<Real>(count));
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<Real> q;
        for (std::size_t k = 0, rest = i; k < dofs; ++k, rest /= 3)
            q.push_back(middle[k] + (rest % 3 == 0 ? Real(0) : rest % 3 == 1 ? node[k] : -node[k]));
        const ExactPose pose = exactPose(motion, q);
        for (std::size_t p = 0; p < tests.size(); ++p)
            weights[p][i] = (pose.at(tests[p].b) - tests[p].a.cast<Real>()).squaredNorm();
    }
    for (const std::vector<Real>& w : weights) farthest.push_back(*std::max_element(w.begin(), w.end()));
    for (std::size_t k = 0, stride = 1; k < dofs; ++k, stride *= 3) {
        const bool turn = motion.dofs[k].kind == DofKind::Rotation;
        const Real first = turn ? std::sin(node[k]) : node[k];
        const Real halfSine = std::sin(node[k] / 2);
        const Real second = turn ? 2 * halfSine * halfSine : node[k] * node[k];
        for (std::size_t i = 0; i < count; ++i) {
            if (i / stride % 3 != 0) continue;
            for (std::vector<Real>& w : weights) {
                Real &v0 = w[i], &v1 = w[i + stride], &v2 = w[i + 2 * stride];
                const Real odd = v1 - v2, even = v1 + v2 - 2 * v0;
                v1 = first > 0 ? odd / (2 * first) : 0;
                v2 = second > 0 ? even / (2 * second) : 0;
            }
        }
    }
    return weights;
}

} // namespace

FeatureFormErrors::FeatureFormErrors(const Table& table, const PreparedTable& prepared,
                                     const std::vector<Exact>& tests)
    : prepared_(prepared), fold_(*prepared.kernels().fold()),
      u_(prepared.precision() == KernelPrecision::Float ? 0x1p-24 : 0x1p-53),
      exact_(exactProducts(table.motion, tests, farthest_)) {
    const std::size_t dofs = table.motion.dofCount();
    rounding_ = poseRounding(table.motion, pathSize(table.motion, tests), double(realRoundoff));
    const std::size_t count = exact_.empty() ? 0 : exact_[0].size();
    for (std::size_t i = 0; i < count; ++i) {
        std::pair<Real, Real> range{1, 1};
        for (std::size_t k = 0, rest = i; k < dofs; ++k, rest /= 3) {
            const auto [low, high] = factorRange(table.motion.dofs[k], int(rest % 3));
            const Real p[] = {range.first * low, range.first * high, range.second * low, range.second * high};
            range = {*std::min_element(p, p + 4), *std::max_element(p, p + 4)};
        }
        ranges_.push_back(range);
    }
    for (const FeatureForm::Feature& f : fold_.features) columns_.push_back(productOf(f, dofs));
    for (const FeatureForm::Feature& f : fold_.sharedFeatures) sharedColumns_.push_back(productOf(f, dofs));
}

PairErrors FeatureFormErrors::of(std::size_t pair, const Exact& test) const {
    const StoredRow row(prepared_, prepared_.kernels().rows(), pair);
    std::vector<Real> left = exact_[pair]; // the exact weights less what is stored
    Real constant = left[0];               // the exact constant where features count from their centres
    std::vector<double> products;          // |w_k| max |feature_k|
    Real away = 0;                         // what the differences of weights amount to at most
    // Features are made in double from factors good to a few units in the last place.
    constexpr Real make = 16 * 0x1p-53L;
    Real making = 0;
    const auto use = [&](const FeatureForm::Feature& f, std::size_t column, double weight) {
        const Real centre = f.centre;
        const Real range = std::max(ranges_[column].second - centre, centre - ranges_[column].first);
        constant += left[column] * centre;
        away += std::abs(left[column] - weight) * range;
        making += make * std::abs(Real(weight)) * (range + 2 * std::abs(centre) + 1e-300L);
        left[column] = 0;
        return double(std::abs(Real(weight)) * range);
    };
    for (std::size_t k = 0; k < columns_.size(); ++k)
        products.push_back(use(fold_.features[k], columns_[k], row[k + 1]));
    double shared = 0;
    for (std::size_t k = 0; k < sharedColumns_.size(); ++k)
        shared += use(fold_.sharedFeatures[k], sharedColumns_[k], fold_.sharedWeights[k]);
    for (std::size_t i = 1; i < left.size(); ++i)
        away += std::abs(left[i]) * std::max(std::abs(ranges_[i].first), std::abs(ranges_[i].second));
    // Rounding of the extended precision itself.
    for (std::size_t i = 0; i < exact_[pair].size(); ++i)
        away += 0x1p-60L * std::abs(exact_[pair][i]) *
                std::max(std::abs(ranges_[i].first), std::abs(ranges_[i].second));
    const double distance = std::sqrt(double(farthest_[pair]));
    away +=
        Real(std::pow(betweenNodes, double(prepared_.dofCount()))) * (2 * distance + rounding_) * rounding_;

    const Real contactDistance2 = Real(test.contactDistance) * std::abs(Real(test.contactDistance));
    const double off = double(Real(row[0]) - (constant - contactDistance2)); // the widening, less than 0
    const double fixed = double((away + making) * (1 + 1e-9L));
    double sum = rounding(row[0], products, shared, 0);
    sum = rounding(row[0], products, shared, 2 * (sum + std::abs(off) + fixed));
    const double farthest = test.contactDistance + prepared_.kernels().margin();
    const double whole = std::abs(double(Real(row.fromEnd(3)) - constant)) + fixed +
                         rounding(row.fromEnd(3), products, shared, farthest * farthest);
    return {{off - fixed - sum, off + fixed + sum}, whole};
}

/// Rounding of constant + sum of products, compared with the shared term, where the exact result is at
/// most `result`: each feature rounds once, each product once, each sum once; no partial sum is larger
/// than what was added before, nor than the result and what is still to come.
double FeatureFormErrors::rounding(double constant, const std::vector<double>& products, double shared,
                                   double result) const {
    double after = shared;
    for (double p : products) after += p;
    double error = 0, before = std::abs(constant);
    for (double p : products) {
        before += p;
        after -= p;
        error += 2 * p + std::min(before, result + after);
    }
    error += 2 * shared + std::min(before + shared, result);
    return u_ * error * (1 + 1e-6);
}

} // namespace tss::verify
