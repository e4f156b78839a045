#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

/// Throws InputError with the prim's path where a joint, pair, muscle or skin names a body, joint or muscle
/// that the scene does not have. For scenes that a program makes in memory: those that were read have none
/// such.
void checkIndices(const SceneModel& scene);

} // namespace tss
