#pragma once
#include "bake/model/SceneModel.h"

#include <span>

namespace tss {

/// A degree of freedom of a scene: the joint, and which of its own.
struct JointDof {
    int joint = -1;
    std::size_t dof = 0;
};

/// #joints + 1: the index of each joint's first value where the values of all joints stand in one list, in
/// file order; then the length of that list.
std::vector<std::size_t> firstValues(const SceneModel& scene);

/// One value per DOF, joints in file order, DOFs in the joint's order: where they rest.
std::vector<double> restValues(const SceneModel& scene);

/// The same at a time code: driven DOFs where their drives have them, all others at rest.
std::vector<double> drivenValues(const SceneModel& scene, double timeCode);

/// Whether a DOF of the joint has a drive.
bool isDriven(const Joint& joint, std::size_t dof);

/// Which of the joints' DOFs each DOF of pairMotion() is: those of a joint that is crossed from body1 to
/// body0 come in reverse order.
std::vector<JointDof> pairDofs(const SceneModel& scene, const Pair& pair);

/// #bodies: the joint that moves each body, which is its body1; -1: none does, the body stays as modelled. Of
/// several joints with the same body1 the first in file order moves it. A joint that would close a cycle
/// moves nothing.
std::vector<int> movers(const SceneModel& scene);

/// #bodies: the topmost body that each is rigidly connected to, by joints without DOFs. Bodies with the same
/// one move as one. -1: fixed in the world.
std::vector<int> rigidRoots(const SceneModel& scene);

/// Of each body whether it is soft: the surface of a muscle, or a skin.
std::vector<bool> softBodies(const SceneModel& scene);

/// A bone and the other bodies that never move against it and are not soft.
std::vector<int> movingAsOne(const SceneModel& scene, int bone);

/// Throws InputError where a joint of the pair's chain is not the one that moves its body1, so that
/// posedBodies() places the bodies otherwise than the chain does. movers: movers() of the scene.
void requireMoved(const SceneModel& scene, const Pair& pair, const std::vector<int>& movers);

/// Where each body stands (body to world) when the joints have these values, in the order of restValues().
std::vector<Pose> posedBodies(const SceneModel& scene, std::span<const double> values);

/// body1 to body0 of one joint: frame0 * D1...Dd * frame1^-1.
Pose jointPose(const Joint& joint, std::span<const double> values);

/// Whether the bodies between the two of a pair have no mesh: its chain is one joint of several DOFs.
bool tiesDirectly(const SceneModel& scene, const Pair& pair);

} // namespace tss
