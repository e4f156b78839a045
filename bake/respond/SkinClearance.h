#pragma once
#include "bake/respond/SkinScene.h"

namespace tss {

/// Run-time length: a row that touched nothing is not queried again before its vertex has moved by this much,
/// so that penetration up to this depth may be missed: 0.03 mm on a head. With a tenth of it a dog's head
/// takes a fifth longer.
constexpr float unseen = 1e-4f;

/// Offset from a row's anchor to its vertex in the current scene, in the body's frame. For a skin vertex
/// before a bone, whose anchor never moves in that frame, the vertex itself.
Eigen::Vector3f anchorOffset(const SkinRig& rig, const SkinScene& scene, const SkinRow& row);

/// The current position, in the skin's frame, of a row's vertex that is tested against the skin.
Eigen::Vector3f vertexPlace(const SkinScene& scene, const SkinRow& row);

/// How far such a vertex is from the nearest of the planes of its start triangles, run-time length.
float heightOverStarts(const SkinRig& rig, const SkinScene& scene, const SkinRow& row);

/// Where the clearances of a row's starts at rest are in SkinRig::clearances.
std::size_t clearancesAtRest(const SkinRig& rig, const SkinRow& row);

/// Sets the offsets of a row's clearances, one per start, by the current scene.
void measureOffsets(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, SkinClearance* starts);

/// Whether the two sides of a row may touch, judged by how far the vertex has moved against each start
/// triangle since all else but its muscle's activation was at rest (SkinClearance): parts of the skin that
/// turn meet it elsewhere than at the anchor.
bool mayTouch(const SkinRig& rig, const SkinScene& scene, const SkinRow& row);

} // namespace tss
