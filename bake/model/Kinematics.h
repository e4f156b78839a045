#pragma once
#include "bake/model/SceneModel.h"

#include <span>

namespace tss {

/// Where each body stands (body to world) when the joints have these values: one value a DOF, joints in file
/// order, DOFs in the joint's order. Bodies that no enabled joint moves stay as modelled; where joints close
/// a loop, the first joint in file order that reaches a body places it.
std::vector<Pose> posedBodies(const SceneModel& scene, std::span<const double> values);

/// body1 to body0 of one joint: frame0 * D1...Dd * frame1^-1.
Pose jointPose(const Joint& joint, std::span<const double> values);

} // namespace tss
