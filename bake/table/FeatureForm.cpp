#include "bake/table/FeatureProducts.h"
#include "bake/table/RoundingBand.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

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

/// Moves the features' zero to their mean over the contact poses. ranges, sharedRanges: of the uncentred
/// ones.
void centre(FeatureForm& form, const std::vector<FeatureRange>& ranges,
            const std::vector<FeatureRange>& sharedRanges, std::span<const std::vector<double>> contacts) {
    double u[FeatureForm::maxDofs][3] = {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
    const auto settle = [&](FeatureForm::Feature& f, const FeatureRange& range) {
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

/// The products that became features of a form: their columns and ranges, and the ranges of the shared ones.
struct KeptColumns {
    std::vector<Eigen::Index> columns;
    std::vector<FeatureRange> ranges, sharedRanges;
};

/// Adds features and shared features to the form, those that weigh most first. What contributes no more than
/// rounding is left out, and counted in `dropped`.
KeptColumns keepColumns(FeatureForm& form, const FeatureProducts& all) {
    constexpr double rounding = 1e-14;                  // of the largest contribution to a squared distance
    std::vector<std::pair<double, Eigen::Index>> order; // most that it contributes to any pair, column
    double scale = form.constants.cwiseAbs().maxCoeff();
    for (Eigen::Index k = 1; k < all.weights.cols(); ++k) {
        const double most = all.weights.col(k).cwiseAbs().maxCoeff() * all.ranges[std::size_t(k)].magnitude();
        order.push_back({most, k});
        scale = std::max(scale, most);
    }
    std::sort(order.begin(), order.end(),
              [](auto& x, auto& y) { return x.first != y.first ? x.first > y.first : x.second < y.second; });
    KeptColumns kept;
    for (const auto& [most, k] : order) {
        const auto column = all.weights.col(k);
        const FeatureRange& range = all.ranges[std::size_t(k)];
        if (most <= rounding * scale) {
            form.dropped += column.cwiseAbs() * range.magnitude();
            continue;
        }
        const double mean = column.mean();
        const double spread = (column.array() - mean).abs().maxCoeff();
        if (column.size() > 1 && spread * range.magnitude() <= rounding * scale) {
            form.sharedFeatures.push_back(all.features[std::size_t(k)]);
            form.sharedWeights.push_back(mean);
            kept.sharedRanges.push_back(range);
            form.dropped.array() += (column.array() - mean).abs() * range.magnitude();
            continue;
        }
        kept.columns.push_back(k);
        form.features.push_back(all.features[std::size_t(k)]);
        kept.ranges.push_back(range);
    }
    return kept;
}

/// Counts in `dropped` what rounds of the constants, which are sums in double and lose the squared contact
/// distance.
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

/// How much each feature, and what is shared, may contribute to the squared distance of a pair.
std::vector<double> contributions(const FeatureForm& form, Eigen::Index pair) {
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
    const std::vector<double> c = contributions(*this, pair);
    const double error = sumError(u, constant, c, 0);
    return sumError(u, constant, c, 4 * error) + dropped(pair) + rangeError(u, pair);
}

double FeatureForm::squareError(double u, Eigen::Index pair, double distance) const {
    return sumError(u, constants(pair), contributions(*this, pair), distance * distance) + dropped(pair) +
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
    const FeatureProducts all = featureProducts(motion, pairs, form.factors);
    form.constants = all.weights.col(0);
    form.dropped = all.off;
    if (pairs.empty()) return form;

    const KeptColumns kept = keepColumns(form, all);
    if (static_cast<int>(kept.columns.size()) > FeatureForm::maxFeatures) return std::nullopt;
    form.weights.resize(form.constants.size(), Eigen::Index(kept.columns.size()));
    for (std::size_t k = 0; k < kept.columns.size(); ++k)
        form.weights.col(Eigen::Index(k)) = all.weights.col(kept.columns[k]);
    centre(form, kept.ranges, kept.sharedRanges, contacts);
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
