#pragma once
#include "bake/model/SceneModel.h"
#include "bake/respond/JointStatus.h"
#include "bake/respond/SkinFollowing.h"

#include <memory>

namespace tss {

struct SkinCosts;

/// A scene in motion: the joints kept out of collision, the skins deformed, as the node kit does it, step by
/// step.
class Player {
public:
    /// warnings: pairs that cannot be served. Throws InputError for a skin whose table does not fit, and for
    /// indices beyond the scene's bodies, joints and muscles.
    /// Keeps a reference to the scene.
    Player(const SceneModel& scene, std::vector<std::string>& warnings);
    Player(SceneModel&& scene, std::vector<std::string>& warnings) = delete;
    Player(Player&&) noexcept;
    Player& operator=(Player&&) noexcept;
    ~Player();

    /// What came of one step.
    struct Step {
        std::vector<double> values;             ///< of all joints, in file order
        double gap = 0;                         ///< smallest of all tables at these values
        JointStatus status = JointStatus::Free; ///< the gravest of all
        std::vector<double> residualDepths;     ///< one per skin: how deep its vertices are in the muscles'
                                                ///< surfaces beyond their depth at rest, scene units
        std::vector<double> pushed; ///< one per skin: how far contacts move it, at most, from where muscles
                                    ///< and bones carry it, scene units
        double jointSeconds = 0;    ///< of this thread's processor time, for all joints
        std::vector<double> skinSeconds; ///< the same, one per skin: for its update alone
    };
    /// How truly each skin follows its bones after the last step.
    std::vector<SkinFollowing> following() const;

    /// asked: one value a DOF of all joints, in file order; one that is no finite number leaves its DOF where
    /// it is. Throws InputError for another number of values.
    Step step(const std::vector<double>& asked, double timeCode);

    /// From now on each step adds what the parts of the skins' updates cost: one per skin of the scene, which
    /// must outlive this. That makes the updates themselves a tenth slower.
    void charge(std::vector<SkinCosts>& costs);

    /// Every body's vertices in the world after the last step, skins and muscles deformed.
    std::vector<TriangleMesh> worldMeshes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace tss
