#pragma once
#include "bake/model/SceneModel.h"
#include "bake/tool/Command.h"

namespace tss::tool {

/// The scene's own motion: the DOF values of all joints, one row a time code; joints in file order, DOFs in
/// the joint's order. What is not driven rests.
std::vector<std::vector<double>> drivenSteps(const SceneModel& scene);

/// Plays the scene's own motion and adds to each baked skin of a summary how deep it is then at most in what
/// is below it, beyond its depth at rest ("residual", scene units, over "residualSteps" steps). Nothing where
/// nothing moves.
void addResiduals(Json& summary, const SceneModel& scene);

} // namespace tss::tool
