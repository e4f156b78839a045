#pragma once
#include "bake/model/SceneModel.h"
#include "bake/tool/Command.h"

#include <string>

namespace tss::tool {

/// Gives a scene the motion of a CSV file in place of its own. The first line names the columns: `time`
/// (seconds) or `step` (time codes), or neither, then a row is a time code; a joint by its name, JOINT:DOF
/// where it has several, in degrees or units of its value; a muscle by its name, its activation. Without a
/// line of names: every DOF in the order of the joints, then every muscle. What has no column rests. Throws
/// InputError with the file: other names, times that do not rise.
void applyMotion(SceneModel& scene, const std::string& file);

/// The scene's own motion: the DOF values of all joints, one row a time code; joints in file order, DOFs in
/// the joint's order. What is not driven rests.
std::vector<std::vector<double>> drivenSteps(const SceneModel& scene);

/// Plays the scene's own motion and adds to each baked skin of a summary how deep it is then at most in what
/// is below it, beyond its depth at rest ("residual", scene units, over "residualSteps" steps). Nothing where
/// nothing moves.
void addResiduals(Json& summary, const SceneModel& scene);

} // namespace tss::tool
