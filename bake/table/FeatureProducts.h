#pragma once
#include "bake/table/FeatureForm.h"

#include <algorithm>
#include <cmath>

namespace tss {

/// The values that a feature takes over the limits.
struct FeatureRange {
    double low = 1, high = 1;

    FeatureRange times(FeatureRange o) const {
        const double p[] = {low * o.low, low * o.high, high * o.low, high * o.high};
        return {*std::min_element(p, p + 4), *std::max_element(p, p + 4)};
    }
    double magnitude() const { return std::max(std::abs(low), std::abs(high)); }
};

/// All products of one factor a DOF, 3^d of them, and what they weigh in the squared distance of each pair.
struct FeatureProducts {
    std::vector<FeatureForm::Feature> features;
    std::vector<FeatureRange> ranges;
    Eigen::MatrixXd weights; ///< #pairs by #features, the first of them the constant
    Eigen::VectorXd off;     ///< #pairs: by how much all of them together may be off
};

/// For turns and slides only. factors: one per DOF, see dofFactor().
FeatureProducts featureProducts(const Motion& motion, std::span<const TablePair> pairs,
                                const std::vector<DofFactor>& factors);

} // namespace tss
