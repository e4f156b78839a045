#pragma once
#include "bake/table/FeatureForm.h"
#include "bake/table/PoseRecipe.h"

namespace tss {

/// How the values of the DOFs become what a query reads of a pose (FeatureForm::evaluate,
/// PoseRecipe::evaluate), laid out for vectors of four doubles.
struct PosePlan {
    static constexpr std::size_t lanes = 4;
    static constexpr std::size_t room = (maxDofs + lanes - 1) / lanes * lanes;

    /// Four features of a fold. factor: per DOF and feature two halves of a number of 64 bits, 0 and 1 for
    /// the first factor, 2 and 3 for the second, 4 and 5 for 1.
    struct alignas(32) Products {
        std::int32_t factor[FeatureForm::maxDofs][2 * lanes];
        double centre[lanes];
        double weight[lanes]; ///< of a shared feature; those beyond the last weigh 0
    };

    /// One DOF's matrix: constant + first factor * first + second factor * second. 3 by 4, row-major.
    struct alignas(32) Step {
        PoseRecipe::Matrix constant, first, second;
    };

    alignas(32) double middle[room] = {};     ///< of the limits, per DOF
    alignas(32) std::int64_t turn[room] = {}; ///< all bits where the DOF turns
    bool turns = false;                       ///< any does
    std::size_t dofs = 0;
    std::size_t featureCount = 0;
    std::vector<Products> features, shared; ///< of a fold
    std::vector<Step> steps;                ///< of the direct transform, one per DOF

    PosePlan() = default;
    explicit PosePlan(const FeatureForm& form);
    /// The recipe must be free of paths and have at least one DOF.
    explicit PosePlan(const PoseRecipe& recipe);

private:
    void take(std::span<const DofFactor> factors);
};

} // namespace tss
