#pragma once
#include "bake/model/SceneModel.h"
#include "bake/table/Kernels.h"
#include "bake/table/PoseLanes.h"
#include "bake/table/PosePlan.h"

#include <vector>

namespace tss {

/// The places of a scene's bodies, from which the poses of many pairs follow: each joint's transform is
/// calculated once, then one product gives the place of a body and one more the pose of a pair.
class ChainPoses {
public:
    using Matrix = PoseRecipe::Matrix; ///< 3 by 4, row-major, rotation first

    ChainPoses() = default;
    /// For the bodies that the joints of these pairs link. pairs: indices into scene.pairs.
    ChainPoses(const SceneModel& scene, const std::vector<int>& pairs);

    /// Whether all of the pair's joints are supported. Paths and joints that close a loop are not.
    bool links(const Pair& pair) const;

    /// A bound of the rounding error of between(), scene units, at points of B no farther from B's origin
    /// than `farthest`. The pair must be one for which links() is true.
    double error(const Pair& pair, double farthest) const;

    /// values: one per DOF of all joints of the scene, in file order, finite. places: one per body, from its
    /// frame to that of the root of its tree of joints; left as they are for bodies that no pair's joint
    /// links.
    void evaluate(const double* values, Matrix* places) const;

    /// The same for poseLanes configurations at once. values: one array for each; places: one per body.
    void evaluate(const double* const* values, BodyLanes* places) const;

    /// The transform from B's frame to A's, from the places of both.
    static void between(const Matrix& a, const Matrix& b, Matrix& out);

    /// Squared distance of a point of A's frame and one of B's, scene units squared.
    static double squaredDistance(const Matrix& a, const Vec3& inA, const Matrix& b, const Vec3& inB) {
        double sum = 0;
        for (int r = 0; r < 12; r += 4) {
            const double off = (b[r] * inB.x() + b[r + 1] * inB.y() + b[r + 2] * inB.z() + b[r + 3]) -
                               (a[r] * inA.x() + a[r + 1] * inA.y() + a[r + 2] * inA.z() + a[r + 3]);
            sum += off * off;
        }
        return sum;
    }

private:
    struct Step {
        int parent = -1, body = -1;      ///< parent -1: the root of a tree
        std::vector<std::size_t> values; ///< of each DOF of the recipe, its place among all values
        PoseRecipe recipe;               ///< body to parent
        PosePlan plan;                   ///< the same; empty where nothing moves
    };
    void ownLanes(const Step& step, const double* const* values, PoseLanes& own) const;

    KernelSet kernels_ = makeKernels<double>(KernelTarget::Best);
    LaneKernels laneKernels_ = laneKernels(KernelTarget::Best);
    std::vector<Step> steps_;      ///< each parent before its children
    std::vector<bool> served_;     ///< per joint
    std::vector<Motion> toOrigin_; ///< per body: its motion against the root
};

} // namespace tss
