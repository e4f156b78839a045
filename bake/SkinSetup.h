#pragma once
#include "bake/model/SceneModel.h"
#include "bake/respond/SkinRig.h"

namespace tss {

/// From the scene's skin to what the run time and the search work with. Shared by baking, `tss play` and the
/// node kit.

/// The muscles of a skin in the order of skin.muscles, moved into the skin's frame as modelled. Throws
/// InputError that names the muscle's prim.
std::vector<std::shared_ptr<const MuscleDeformer>> skinMuscles(const SceneModel& scene,
                                                               const SkinModel& skin);

/// How the scene says that the skin behaves; the rest at its defaults.
SkinParameters skinParameters(const SceneModel& scene, const SkinModel& skin);

/// All of it: the rig for SkinResponse. Throws InputError when the skin has no table or one that does not
/// fit.
std::shared_ptr<const SkinRig> skinRig(const SceneModel& scene, const SkinModel& skin);

/// One activation a muscle of the skin at a time code.
std::vector<double> skinActivations(const SceneModel& scene, const SkinModel& skin, double timeCode);

/// What SkinResponse::update wants as poses: the motion of each muscle's bone since rest, in the skin's
/// frame. placements: body to world now, one a body of the scene. Empty when no muscle rides on a bone.
std::vector<Pose> skinPoses(const SceneModel& scene, const SkinModel& skin, std::span<const Pose> placements);

} // namespace tss
