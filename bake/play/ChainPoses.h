#pragma once
#include "bake/model/SceneModel.h"
#include "bake/table/Kernels.h"
#include "bake/table/PoseLanes.h"
#include "bake/table/PosePlan.h"

#include <vector>

namespace tss {

/// Where the bodies of a scene stand against one another, for many pairs of them at once: sine and cosine of
/// each joint's values once, then one product a body, and one more a pair.
class ChainPoses {
public:
    using Matrix = PoseRecipe::Matrix; ///< 3 by 4, row-major, rotation first

    ChainPoses() = default;
    /// Of the bodies that the joints of these pairs link. pairs: indices into scene.pairs.
    ChainPoses(const SceneModel& scene, const std::vector<int>& pairs);

    /// All of the pair's joints are served. Not served are paths, and joints that close a loop.
    bool links(const Pair& pair) const;

    /// How far between() may be off at points of B no farther from B's origin than `farthest`, scene units;
    /// of a pair that is linked.
    double error(const Pair& pair, double farthest) const;

    /// values: one per DOF of all joints of the scene, in file order, finite. places: one per body, its frame
    /// to that of the body that its joints lead to in the end; of a body that no pair's joint links, nothing.
    void evaluate(const double* values, Matrix* places) const;

    /// The same of poseLanes configurations at once: values of each, places one per body.
    void evaluate(const double* const* values, BodyLanes* places) const;

    /// B to A, from their places.
    static void between(const Matrix& a, const Matrix& b, Matrix& out);

    /// Of a point of A's frame and one of B's.
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
        int parent = -1, body = -1;      ///< parent -1: one that stands at the origin
        std::vector<std::size_t> values; ///< of each DOF of the recipe, its place among all values
        PoseRecipe recipe;               ///< body to parent
        PosePlan plan;                   ///< the same; empty where nothing moves
    };
    void ownLanes(const Step& step, const double* const* values, PoseLanes& own) const;

    KernelSet kernels_ = makeKernels<double>(KernelTarget::Best);
    LaneKernels laneKernels_ = laneKernels(KernelTarget::Best);
    std::vector<Step> steps_;      ///< each parent before its children
    std::vector<bool> served_;     ///< per joint
    std::vector<Motion> toOrigin_; ///< per body: its motion against the origin's
};

} // namespace tss
