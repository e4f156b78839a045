#pragma once
#include "bake/model/SceneModel.h"

#include <optional>
#include <span>

namespace tss {

/// The ways that joints make from body to body. Joints that are not enabled make none; the world, -1, counts
/// as a body that joints may share.
class JointWays {
public:
    explicit JointWays(const std::vector<Joint>& joints);
    /// Indices of the joints that lead from one body to another, in this order; empty when none do, nothing
    /// when there is more than one way.
    std::optional<std::vector<int>> chain(int bodyA, int bodyB) const;

private:
    struct Step {
        int joint, body;
    };

    // A forest of the bodies, the world first: where from each body the way up leads, and how far it is.
    std::vector<Step> above_;
    std::vector<int> depth_;
    std::vector<bool> only_; ///< by joint: nothing else leads from one side of it to the other
};

/// One chain() of the ways of these joints.
std::optional<std::vector<int>> findChain(const std::vector<Joint>& joints, int bodyA, int bodyB);

/// A degree of freedom of a scene: the joint, and which of its own.
struct JointDof {
    int joint = -1;
    std::size_t dof = 0;
};

/// Of each joint the place of its first value among those of all joints in file order; behind the last how
/// many there are.
std::vector<std::size_t> firstValues(const SceneModel& scene);

/// One value per DOF, joints in file order, DOFs in the joint's order: where they rest.
std::vector<double> restValues(const SceneModel& scene);

/// The same at a time code, as the joints are driven; what is not driven rests.
std::vector<double> drivenValues(const SceneModel& scene, double timeCode);

/// Whether the joint's motion says where a DOF of it is.
bool isDriven(const Joint& joint, std::size_t dof);

/// Which of the joints' DOFs each DOF of pairMotion() is: those of a joint that is crossed from body1 to
/// body0 come in reverse order.
std::vector<JointDof> pairDofs(const SceneModel& scene, const Pair& pair);

/// Of each body the joint that moves it, as its body1; -1: none does, it stays as modelled. A body that is
/// body1 of several joints goes with the first of them in file order, and a joint that leads back to its own
/// body0 moves nothing.
std::vector<int> movers(const SceneModel& scene);

/// Of each body the one that it never moves against, through joints without DOFs, nearest to the root: two
/// bodies of which that is the same move as one. -1: those that stand in the world.
std::vector<int> rigidRoots(const SceneModel& scene);

/// A bone and the other bodies that never move against it and are no muscle's surface and no skin.
std::vector<int> movingAsOne(const SceneModel& scene, int bone);

/// Throws InputError where a pair's bodies do not stand as its chain of joints says when these have their
/// values: a joint of it is not the one that moves its body1. movers: those of the scene.
void requireMoved(const SceneModel& scene, const Pair& pair, const std::vector<int>& movers);

/// Where each body stands (body to world) when the joints have these values, in the order of restValues().
std::vector<Pose> posedBodies(const SceneModel& scene, std::span<const double> values);

/// body1 to body0 of one joint: frame0 * D1...Dd * frame1^-1.
Pose jointPose(const Joint& joint, std::span<const double> values);

/// One joint ties the two bodies of a pair, of several DOFs too: what its chain goes over has no mesh.
bool tiesDirectly(const SceneModel& scene, const Pair& pair);

} // namespace tss
