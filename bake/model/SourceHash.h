#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

/// The hash of each body's mesh, empty until it was needed: for many pairs of one scene, whose meshes stay as
/// they are meanwhile.
using MeshHashes = std::vector<std::string>;

/// What a pair's table depends on, as the SHA-256 of five parts (the first 32 digits of each, with -
/// between): the meshes of A and of B, the frames and axes of the joints, their limits, the settings. Meshes
/// and frames count as the floats that a file holds. Drives, placements and colours do not count.
std::string sourceHash(const SceneModel& scene, const Pair& pair, MeshHashes* meshes = nullptr);

/// The same for a skin: its mesh; its muscles' meshes where they stand; their fibres and forms; their
/// activation and the travel; the settings. Compliances do not count: they change how the skin moves, not
/// what it can meet.
std::string sourceHash(const SceneModel& scene, const SkinModel& skin);

/// Why the table or proof of a pair or skin does not fit the scene any more, in words: "the mesh of
/// /Jaw/Skull and the limits have changed since its table was baked". Empty when it fits, and when there is
/// none.
std::string staleness(const SceneModel& scene, const Pair& pair, MeshHashes* meshes = nullptr);
std::string staleness(const SceneModel& scene, const SkinModel& skin);

/// Throws InputError where the table of the pair is stale; of a scene, naming the first pair or skin.
void requireFresh(const SceneModel& scene, const Pair& pair, const std::string& fileName);
void requireFresh(const SceneModel& scene, const std::string& fileName);

} // namespace tss
