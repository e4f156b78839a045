#include "bake/table/FeatureProducts.h"

#include "bake/table/RoundingBand.h"

#include <limits>
#include <numbers>

namespace tss {

namespace {

/// Values of a DOF's factor over its limits.
FeatureRange factorRange(const DofFactor& factor, double half, int which) {
    if (which == 0) return {};
    if (!factor.turn) return which == 1 ? FeatureRange{-half, half} : FeatureRange{0, half * half};
    const double sine = half < 0.5 * std::numbers::pi ? std::sin(half) : 1;
    if (which == 1) return {-sine, sine};
    const double s = std::sin(0.5 * std::min(half, std::numbers::pi));
    return {0, 2 * s * s};
}

/// In extended precision where the machine has it: far axes leave none of their roundoffs in the weights.
using Real = long double;
using RealPoint = Eigen::Matrix<Real, 3, 1>;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// T(q), of turns and slides, in extended precision.
class RealPose {
public:
    RealPose(const Motion& motion, const std::vector<Real>& q)
        : turn_(motion.base.linear().cast<Real>()), shift_(motion.base.translation().cast<Real>()) {
        for (std::size_t k = motion.dofCount(); k-- > 0;) {
            const Dof& dof = motion.dofs[k];
            const Real half = std::sin(q[k] / 2);
            steps_.push_back({dof.kind == DofKind::Translation, dof.axis.cast<Real>(),
                              dof.origin.cast<Real>(), q[k], std::sin(q[k]), 2 * half * half});
        }
    }

    RealPoint operator*(const Vec3& y) const {
        RealPoint x = turn_ * y.cast<Real>() + shift_;
        for (const Step& step : steps_) {
            if (step.slides) {
                x += step.value * step.axis;
                continue;
            }
            const RealPoint across = step.axis.cross(x - step.origin);
            x += step.sine * across + step.versine * step.axis.cross(across);
        }
        return x;
    }

private:
    /// One DOF's; the last one acts first.
    struct Step {
        bool slides;
        RealPoint axis, origin;
        Real value, sine, versine;
    };

    Eigen::Matrix<Real, 3, 3> turn_;
    RealPoint shift_;
    std::vector<Step> steps_;
};

/// For each pair a bound of the error of the sum of all products anywhere in the limits, which comes from the
/// rounding of the squared distances that the weights are made from (`squares`, #pairs by #poses). From the
/// values v, v+, v- at the three poses of a DOF its weights are v, (v+ - v-) / 2 over the first factor there
/// and (v+ + v- - 2 v) / 2 over the second. Over the limits the factors are at most 1.003 and 2.15 times as
/// large as at the poses, so that a DOF multiplies the error by at most 7.
Eigen::VectorXd makingErrors(const Motion& motion, std::span<const TablePair> pairs,
                             const RealMatrix& squares) {
    double farthest = 0;
    for (const TablePair& p : pairs) farthest = std::max({farthest, p.a.norm(), p.b.norm()});
    const double u = double(std::numeric_limits<Real>::epsilon()), off = poseError(motion, u, farthest);
    Eigen::VectorXd errors(static_cast<Eigen::Index>(pairs.size()));
    for (Eigen::Index p = 0; p < errors.size(); ++p) {
        const double most = double(squares.row(p).maxCoeff());
        errors[p] = std::pow(7.0, double(motion.dofCount())) *
                    ((2 * std::sqrt(most) + off) * off + 8 * double(motion.dofCount() + 1) * u * most);
    }
    return errors;
}

/// Values of d^2 where a DOF is at (middle, + node, - node) become the weights of its factors (1, first,
/// second), in place. Columns of the three lie `stride` apart.
void toWeights(RealMatrix& columns, const DofFactor& factor, double node, Eigen::Index stride) {
    const Real step = node, halfSine = std::sin(step / 2);
    const Real first = factor.turn ? std::sin(step) : step;
    const Real second = factor.turn ? 2 * halfSine * halfSine : step * step;
    for (Eigen::Index i = 0; i < columns.cols(); ++i) {
        if (i / stride % 3 != 0) continue;
        auto v0 = columns.col(i), v1 = columns.col(i + stride), v2 = columns.col(i + 2 * stride);
        if (!(node > 0)) {
            v1.setZero();
            v2.setZero();
            continue;
        }
        const Eigen::Matrix<Real, Eigen::Dynamic, 1> odd = v1 - v2, even = v1 + v2 - 2 * v0;
        v1 = odd / (2 * first);
        v2 = even / (2 * second);
    }
}

} // namespace

FeatureProducts featureProducts(const Motion& motion, std::span<const TablePair> pairs,
                                const std::vector<DofFactor>& factors) {
    const int d = static_cast<int>(motion.dofCount());
    int count = 1;
    for (int k = 0; k < d; ++k) count *= 3;
    std::vector<double> half, node;
    for (int k = 0; k < d; ++k) {
        half.push_back(0.5 * (motion.dofs[k].upper - motion.dofs[k].lower));
        node.push_back(factors[k].turn ? std::min(half[k], 1.5) : half[k]);
    }
    FeatureProducts all;
    // d^2 is linear in each DOF's (1, first, second) with the others held: its values at 3 poses a DOF tell
    // all weights.
    RealMatrix columns(static_cast<Eigen::Index>(pairs.size()), count);
    for (int i = 0; i < count; ++i) {
        std::vector<Real> q;
        FeatureForm::Feature feature;
        FeatureRange range;
        for (int k = 0, rest = i; k < d; ++k, rest /= 3) {
            const int which = rest % 3;
            q.push_back(Real(factors[k].middle) + (which == 0 ? 0 : which == 1 ? node[k] : -node[k]));
            feature.factor[k] = static_cast<std::uint8_t>(which);
            range = range.times(factorRange(factors[k], half[k], which));
        }
        all.features.push_back(feature);
        all.ranges.push_back(range);
        const RealPose moved(motion, q);
        for (std::size_t p = 0; p < pairs.size(); ++p)
            columns(Eigen::Index(p), i) = (moved * pairs[p].b - pairs[p].a.cast<Real>()).squaredNorm();
    }
    all.off = makingErrors(motion, pairs, columns);
    Eigen::Index stride = 1;
    for (int k = 0; k < d; ++k, stride *= 3) toWeights(columns, factors[k], node[k], stride);
    all.weights = columns.cast<double>();
    return all;
}

} // namespace tss
