#pragma once
#include "bake/model/SceneModel.h"
#include "bake/scene/PrimWriter.h"

namespace tss {

void writeBodies(Layer& layer, const SceneModel& scene);
void writeJoints(Layer& layer, const SceneModel& scene);
/// The DOFs of a joint, its limits, couplings and desired motion; decides the type of its prim.
void writeDofs(PrimWriter& prim, const Joint& joint);
/// Marks the pair's joint, or makes the prim that names its two bodies.
void writePair(Layer& layer, const SceneModel& scene, const Pair& pair);
void writePairs(Layer& layer, const SceneModel& scene);
void writeMuscles(Layer& layer, const SceneModel& scene);
void writeSkins(Layer& layer, const SceneModel& scene);
/// The bake settings of a pair or a skin, in place of those that the prim had.
void writeSettings(Prim& prim, const BakeSettings& settings);

/// The spheres as a guide that viewers do not render: centres and diameters. Throws std::logic_error when one
/// is not exact in float: what was proven of a table holds for the numbers that are stored (see
/// roundToFloat()).
void writeSpheres(Layer& layer, const std::string& path, const SphereSet& spheres);

} // namespace tss
