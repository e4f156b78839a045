#pragma once
#include "bake/table/DofFactors.h"

namespace tss {

/// T(q) between origins of one's choice, as a few multiply-adds: each DOF is an affine map that is linear in
/// its two factors. 3 by 4, row-major, rotation first.
class PoseRecipe {
public:
    using Matrix = std::array<double, 12>;

    PoseRecipe() = default;
    /// x in B about originB -> T(q) x in A about originA.
    PoseRecipe(const Motion& motion, const Vec3& originA, const Vec3& originB);

    /// q: one value per DOF, finite. out: 12 numbers. Allocates nothing.
    void evaluate(const double* q, double* out) const;

    struct Step {
        Matrix constant, first, second; ///< constant + first factor * first + second factor * second
        DofFactor factor;
        bool path = false;
        Pose before = Pose::Identity(), after = Pose::Identity(); ///< of a path
        Dof dof;                                                  ///< of a path
    };
    /// There are DOFs, and none is a path.
    bool affine() const;
    /// One per DOF; T(q) is their product.
    const std::vector<Step>& steps() const { return steps_; }

private:
    std::vector<Step> steps_;
    Matrix fixed_{}; ///< of a motion without DOFs
};

} // namespace tss
