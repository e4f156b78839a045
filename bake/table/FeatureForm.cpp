#include "bake/table/FeatureForm.h"

#include "bake/table/RoundingBand.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tss {

namespace {

struct Interval {
    double low = 1, high = 1;
    Interval times(Interval o) const {
        const double p[] = {low * o.low, low * o.high, high * o.low, high * o.high};
        return {*std::min_element(p, p + 4), *std::max_element(p, p + 4)};
    }
    double magnitude() const { return std::max(std::abs(low), std::abs(high)); }
};

/// Values of a DOF's factor over its limits.
Interval factorRange(const DofFactor& factor, double half, int which) {
    if (which == 0) return {};
    if (!factor.turn) return which == 1 ? Interval{-half, half} : Interval{0, half * half};
    const double sine = half < 0.5 * std::numbers::pi ? std::sin(half) : 1;
    if (which == 1) return {-sine, sine};
    const double s = std::sin(0.5 * std::min(half, std::numbers::pi));
    return {0, 2 * s * s};
}

/// In extended precision where the machine has it: far axes leave none of their roundoffs in the weights.
using Real = long double;
using RealPoint = Eigen::Matrix<Real, 3, 1>;

/// T(q) for many points.
class Mover {
public:
    Mover(const Motion& motion, const std::vector<Real>& q)
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
    /// One DOF's, the last one's first.
    struct Step {
        bool slides;
        RealPoint axis, origin;
        Real value, sine, versine;
    };

    Eigen::Matrix<Real, 3, 3> turn_;
    RealPoint shift_;
    std::vector<Step> steps_;
};

/// All products of factors, their weights in every pair, found from 3 poses a DOF: d^2 is linear in each
/// DOF's (1, first, second) with the others held.
struct Products {
    std::vector<FeatureForm::Feature> features;
    std::vector<Interval> ranges;
    Eigen::MatrixXd weights; ///< #pairs by #features, the first of them the constant
    Eigen::VectorXd off;     ///< #pairs: by how much all of them together may be off
};

/// How far the squared distances at the poses are off, and what that makes of the sum of all products
/// anywhere in the limits: a DOF's three weights, 1, (v+ - v-) / 2 first and (v+ + v- - 2 v) / 2 second, gain
/// no more than 7 times as much together, their factors being no more than 1.003 and 2.15 times those of the
/// poses.
Eigen::VectorXd makingErrors(const Motion& motion, std::span<const TablePair> pairs,
                             const Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>& squares) {
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

Products allProducts(const Motion& motion, std::span<const TablePair> pairs,
                     const std::vector<DofFactor>& factors) {
    const int d = static_cast<int>(motion.dofCount());
    int count = 1;
    for (int k = 0; k < d; ++k) count *= 3;
    std::vector<double> half, node;
    for (int k = 0; k < d; ++k) {
        half.push_back(0.5 * (motion.dofs[k].upper - motion.dofs[k].lower));
        node.push_back(factors[k].turn ? std::min(half[k], 1.5) : half[k]);
    }
    Products all;
    Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> weights(static_cast<Eigen::Index>(pairs.size()),
                                                                count);
    for (int i = 0; i < count; ++i) {
        std::vector<Real> q;
        FeatureForm::Feature feature;
        Interval range;
        for (int k = 0, rest = i; k < d; ++k, rest /= 3) {
            const int which = rest % 3;
            q.push_back(Real(factors[k].middle) + (which == 0 ? 0 : which == 1 ? node[k] : -node[k]));
            feature.factor[k] = static_cast<std::uint8_t>(which);
            range = range.times(factorRange(factors[k], half[k], which));
        }
        all.features.push_back(feature);
        all.ranges.push_back(range);
        const Mover moved(motion, q);
        for (std::size_t p = 0; p < pairs.size(); ++p)
            weights(Eigen::Index(p), i) = (moved * pairs[p].b - pairs[p].a.cast<Real>()).squaredNorm();
    }
    all.off = makingErrors(motion, pairs, weights);
    // Values at (0, +, -) become weights of (1, first, second), one DOF after the other.
    for (int k = 0, stride = 1; k < d; ++k, stride *= 3) {
        const Real step = node[k], halfSine = std::sin(step / 2);
        const Real first = factors[k].turn ? std::sin(step) : step;
        const Real second = factors[k].turn ? 2 * halfSine * halfSine : step * step;
        for (int i = 0; i < count; ++i) {
            if (i / stride % 3 != 0) continue;
            auto v0 = weights.col(i), v1 = weights.col(i + stride), v2 = weights.col(i + 2 * stride);
            const Eigen::Matrix<Real, Eigen::Dynamic, 1> odd = v1 - v2, even = v1 + v2 - 2 * v0;
            if (node[k] > 0) {
                v1 = odd / (2 * first);
                v2 = even / (2 * second);
            } else {
                v1.setZero();
                v2.setZero();
            }
        }
    }
    all.weights = weights.cast<double>();
    return all;
}

/// The value of a product of factors of D DOFs.
template <std::size_t D>
double product(const FeatureForm::Feature& feature, const double (*u)[3]) {
    if constexpr (D == 0) return 1;
    double value = u[0][feature.factor[0]];
    for (std::size_t k = 1; k < D; ++k) value *= u[k][feature.factor[k]];
    return value;
}

void factorsAt(const std::vector<DofFactor>& factors, const double* q, double (*u)[3]) {
    for (std::size_t k = 0; k < factors.size(); ++k) {
        u[k][0] = 1;
        factors[k].evaluate(q[k], u[k][1], u[k][2]);
    }
}

/// Moves the features' zero to their mean over the contact poses.
void centre(FeatureForm& form, const std::vector<Interval>& ranges, const std::vector<Interval>& sharedRanges,
            std::span<const std::vector<double>> contacts) {
    double u[FeatureForm::maxDofs][3] = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
    const auto settle = [&](FeatureForm::Feature& f, const Interval& range) {
        double sum = 0;
        for (const std::vector<double>& q : contacts) {
            factorsAt(form.factors, q.data(), u);
            sum += product<FeatureForm::maxDofs>(f, u);
        }
        f.centre = contacts.empty() ? 0 : std::clamp(sum / double(contacts.size()), range.low, range.high);
        f.range = std::max(range.high - f.centre, f.centre - range.low);
    };
    for (std::size_t k = 0; k < form.features.size(); ++k) {
        settle(form.features[k], ranges[k]);
        form.constants += form.weights.col(Eigen::Index(k)) * form.features[k].centre;
    }
    for (std::size_t k = 0; k < form.sharedFeatures.size(); ++k) {
        settle(form.sharedFeatures[k], sharedRanges[k]);
        form.constants.array() += form.sharedWeights[k] * form.sharedFeatures[k].centre;
    }
}

/// The constants are sums in double, and lose the squared contact distance.
void addConstantErrors(FeatureForm& form, std::span<const TablePair> pairs) {
    for (Eigen::Index p = 0; p < form.constants.size(); ++p) {
        double sum = std::abs(form.constants[p]) +
                     pairs[std::size_t(p)].contactDistance * pairs[std::size_t(p)].contactDistance;
        for (std::size_t k = 0; k < form.features.size(); ++k)
            sum += 2 * std::abs(form.weights(p, Eigen::Index(k)) * form.features[k].centre);
        for (std::size_t k = 0; k < form.sharedFeatures.size(); ++k)
            sum += 2 * std::abs(form.sharedWeights[k] * form.sharedFeatures[k].centre);
        const double terms = double(form.features.size() + form.sharedFeatures.size() + 4);
        form.dropped[p] += doubleRoundoff * terms * sum;
    }
}

std::vector<double> products(const FeatureForm& form, Eigen::Index pair) {
    std::vector<double> c;
    for (Eigen::Index k = 0; k < form.weights.cols(); ++k)
        c.push_back(std::abs(form.weights(pair, k)) * form.features[std::size_t(k)].range);
    if (!form.sharedFeatures.empty()) c.push_back(form.sharedRange());
    return c;
}

} // namespace

double FeatureForm::sharedRange() const {
    double range = 0;
    for (std::size_t k = 0; k < sharedFeatures.size(); ++k)
        range += std::abs(sharedWeights[k]) * sharedFeatures[k].range;
    return range;
}

template <class T>
void FeatureForm::evaluate(const double* q, T* out) const {
    double u[maxDofs][3];
    factorsAt(factors, q, u);
    // Numbers of DOFs are few: a loop of known length for each.
    const auto fill = [&]<std::size_t D>(std::integral_constant<std::size_t, D>) {
        double shared = 0;
        for (std::size_t k = 0; k < sharedFeatures.size(); ++k)
            shared += sharedWeights[k] * (product<D>(sharedFeatures[k], u) - sharedFeatures[k].centre);
        *out = static_cast<T>(-shared);
        T* value = out;
        for (const Feature& feature : features)
            *++value = static_cast<T>(product<D>(feature, u) - feature.centre);
    };
    switch (factors.size()) {
    case 0:
        return fill(std::integral_constant<std::size_t, 0>());
    case 1:
        return fill(std::integral_constant<std::size_t, 1>());
    case 2:
        return fill(std::integral_constant<std::size_t, 2>());
    default:
        return fill(std::integral_constant<std::size_t, 3>());
    }
}
template void FeatureForm::evaluate(const double*, float*) const;
template void FeatureForm::evaluate(const double*, double*) const;

double FeatureForm::rangeError(double u, Eigen::Index pair) const {
    double factors = weights.row(pair).cwiseAbs().sum();
    for (const Feature& feature : features) factors += feature.range;
    return tss::rangeError(u, double(features.size() + 2), factors);
}

double FeatureForm::signError(double u, Eigen::Index pair, double contactDistance) const {
    const double constant = constants(pair) - contactDistance * std::abs(contactDistance);
    const std::vector<double> c = products(*this, pair);
    const double error = sumError(u, constant, c, 0);
    return sumError(u, constant, c, 4 * error) + dropped(pair) + rangeError(u, pair);
}

double FeatureForm::squareError(double u, Eigen::Index pair, double distance) const {
    return sumError(u, constants(pair), products(*this, pair), distance * distance) + dropped(pair) +
           rangeError(u, pair);
}

std::optional<FeatureForm> makeFeatureForm(const Motion& motion, std::span<const TablePair> pairs,
                                           std::span<const std::vector<double>> contacts,
                                           std::uint64_t* multiplied) {
    constexpr std::size_t few = 1000;
    if (motion.dofCount() > FeatureForm::maxDofs) return std::nullopt;
    for (const Dof& dof : motion.dofs)
        if (dof.kind == DofKind::Path) return std::nullopt;
    // What has too many features for a few of the pairs has no fewer for all.
    if (pairs.size() > 10 * few) {
        std::vector<TablePair> some;
        for (std::size_t k = 0; k < few; ++k) some.push_back(pairs[k * pairs.size() / few]);
        if (!makeFeatureForm(motion, some, {}, multiplied)) return std::nullopt;
    }
    if (multiplied) *multiplied += pairs.size();
    FeatureForm form;
    for (const Dof& dof : motion.dofs) form.factors.push_back(dofFactor(dof));
    const Products all = allProducts(motion, pairs, form.factors);
    form.constants = all.weights.col(0);
    form.dropped = all.off;
    if (pairs.empty()) return form;

    // Columns by what they can contribute; those at the level of rounding are left out.
    std::vector<std::pair<double, Eigen::Index>> order;
    double scale = form.constants.cwiseAbs().maxCoeff();
    for (Eigen::Index k = 1; k < all.weights.cols(); ++k) {
        const double most = all.weights.col(k).cwiseAbs().maxCoeff() * all.ranges[std::size_t(k)].magnitude();
        order.push_back({most, k});
        scale = std::max(scale, most);
    }
    std::sort(order.begin(), order.end(),
              [](auto& x, auto& y) { return x.first != y.first ? x.first > y.first : x.second < y.second; });
    std::vector<Interval> ranges, sharedRanges;
    std::vector<Eigen::Index> columns;
    for (const auto& [most, k] : order) {
        const auto column = all.weights.col(k);
        const double largest = all.ranges[std::size_t(k)].magnitude();
        if (most <= 1e-14 * scale) {
            form.dropped += column.cwiseAbs() * largest;
            continue;
        }
        const double mean = column.mean();
        const double spread = (column.array() - mean).abs().maxCoeff();
        if (pairs.size() > 1 && spread * largest <= 1e-14 * scale) {
            form.sharedFeatures.push_back(all.features[std::size_t(k)]);
            form.sharedWeights.push_back(mean);
            sharedRanges.push_back(all.ranges[std::size_t(k)]);
            form.dropped.array() += (column.array() - mean).abs() * largest;
            continue;
        }
        columns.push_back(k);
        form.features.push_back(all.features[std::size_t(k)]);
        ranges.push_back(all.ranges[std::size_t(k)]);
    }
    if (static_cast<int>(columns.size()) > FeatureForm::maxFeatures) return std::nullopt;
    form.weights.resize(form.constants.size(), Eigen::Index(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k)
        form.weights.col(Eigen::Index(k)) = all.weights.col(columns[k]);
    centre(form, ranges, sharedRanges, contacts);
    addConstantErrors(form, pairs);
    return form;
}

double featureFormMismatch(const FeatureForm& form, const Motion& motion, std::span<const TablePair> pairs,
                           std::span<const std::vector<double>> poses) {
    double most = 0;
    Eigen::VectorXd values(Eigen::Index(form.features.size()) + 1);
    for (const std::vector<double>& q : poses) {
        form.evaluate(q.data(), values.data());
        const Eigen::VectorXd squares =
            (form.constants + form.weights * values.tail(values.size() - 1)).array() - values[0];
        const Pose at = pose(motion, q);
        for (std::size_t p = 0; p < pairs.size(); ++p)
            most = std::max(
                most, std::abs(squares(Eigen::Index(p)) - (at * pairs[p].b - pairs[p].a).squaredNorm()));
    }
    return most;
}

} // namespace tss
