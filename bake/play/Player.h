#pragma once
#include "bake/model/SceneModel.h"
#include "bake/play/JointPlan.h"
#include "bake/respond/SkinFollowing.h"
#include "bake/respond/SkinResponse.h"

namespace tss {

/// A scene in motion: the joints kept out of collision, the skins deformed, as the node kit does it, step by
/// step.
class Player {
public:
    /// warnings: pairs that cannot be served. Throws InputError for a skin whose table does not fit.
    Player(const SceneModel& scene, std::vector<std::string>& warnings);

    /// What came of one step.
    struct Step {
        std::vector<double> values;             ///< of all joints, in file order
        double gap = 0;                         ///< smallest of all tables at these values
        JointStatus status = JointStatus::Free; ///< the gravest of all
        std::vector<double> residualDepths;     ///< one a skin: how deep its vertices are in the muscles'
                                                ///< surfaces beyond their depth at rest, scene units
        double jointSeconds = 0;                ///< of this thread's processor time, for all joints
        std::vector<double> skinSeconds;        ///< the same, one a skin: for its update alone
    };
    /// How truly each skin follows its bones after the last step.
    std::vector<SkinFollowing> following() const;

    Step step(const std::vector<double>& asked, double timeCode);

    /// Every body's vertices in the world after the last step, skins and muscles deformed.
    std::vector<TriangleMesh> worldMeshes() const;

private:
    struct Skin {
        int index = 0; ///< of the scene
        std::vector<std::shared_ptr<const MuscleDeformer>> muscles;
        SkinResponse response;
        std::vector<double> activations;
        std::vector<Pose> poses;        ///< of the muscles' bones since rest; empty: none moves
        std::vector<double> restDepths; ///< one a touched vertex
        SkinFollowMeasure follow;
    };

    std::vector<double> clamped(const std::vector<double>& asked) const;
    /// Of the bone at a muscle's insertion against that at its origin, since rest.
    static Pose farOf(const Skin& skin, std::size_t m);
    std::vector<double> depths(const Skin& skin, std::span<const Vec3> positions) const;

    const SceneModel& scene_;
    std::shared_ptr<const JointPlan> plan_;
    std::vector<JointWorkspace> workspaces_;
    std::vector<std::size_t> places_; ///< of each value of the plan, among all joints' values
    std::vector<double> values_;
    std::vector<Skin> skins_;
};

} // namespace tss
