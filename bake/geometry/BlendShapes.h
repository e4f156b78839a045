#pragma once

struct aiScene;

namespace tss {

// Part of readMeshFile(), of builds with OSGTSS_IMPORT.

/// Puts the vertices of each mesh where its blend shapes take them as far as the file has these on, as
/// viewers show a glTF while nothing is played. Of glTF alone: assimp gives a single shape of FBX the weight
/// 1, whatever its file says.
void applyBlendShapes(aiScene& scene);

} // namespace tss
