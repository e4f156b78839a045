#pragma once
#include "bake/model/SceneModel.h"

#include <string>

namespace tss::tool {

/// Gives a scene the motion of a CSV file in place of its own. The first line names the columns: `time`
/// (seconds) or `step` (time codes), or neither, then a row is a time code; a joint by its name, JOINT:DOF
/// where it has several, in degrees or units of its value; a muscle by its name, its activation. Without a
/// line of names: every DOF in the order of the joints, then every muscle. What has no column rests. Throws
/// InputError with the file: other names, times that do not rise.
void applyMotion(SceneModel& scene, const std::string& file);

} // namespace tss::tool
