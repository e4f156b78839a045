#pragma once
#include "bake/model/SceneModel.h"

#include <array>
#include <memory>

namespace tss {

class MuscleDeformer;
struct SkinParameters;
struct SkinRig;

/// From the scene's skin to what the run time and the search work with. Shared by baking, `tss play` and the
/// node kit.

/// A muscle of the scene in its surface's frame; one between two bones knows where it lies on them.
Muscle muscleOf(const SceneModel& scene, const MuscleModel& model);

/// What is below a skin, in the order of underSkin(), moved into the skin's frame as modelled; a body that
/// only the skin's weights name has no surface. Throws InputError that names the prim.
std::vector<std::shared_ptr<const MuscleDeformer>> skinMuscles(const SceneModel& scene,
                                                               const SkinModel& skin);

/// How the scene says that the skin behaves; the rest at its defaults. farTurns: takes the paths of joints
/// that turn its bones by more than half a turn from rest, beyond which skin between them goes the other way
/// round.
SkinParameters skinParameters(const SceneModel& scene, const SkinModel& skin,
                              std::vector<std::string>* farTurns = nullptr);

/// The lowest and the highest value that a DOF takes when it is moved alone to find out what it does: its
/// limits. Joints that are in no pair may have none: a turn then goes half way round from rest to either
/// side, and a slide stays at rest. Radians or scene units.
std::array<double, 2> swingEnds(const Dof& dof);

/// All of it: the rig for SkinResponse. Without a table the skin is carried by what is below it and not kept
/// out of it. Throws InputError when the table does not fit.
std::shared_ptr<const SkinRig> skinRig(const SceneModel& scene, const SkinModel& skin);

/// One activation of each of underSkin() at a time code, 0 for a bone.
std::vector<double> skinActivations(const SceneModel& scene, const SkinModel& skin, double timeCode);

/// What SkinResponse::update wants as poses: the motion since rest of the bone of each of underSkin(), in the
/// skin's frame. placements: body to world now, one per body of the scene. Empty when there is no bone.
std::vector<Pose> skinPoses(const SceneModel& scene, const SkinModel& skin, std::span<const Pose> placements);

} // namespace tss
