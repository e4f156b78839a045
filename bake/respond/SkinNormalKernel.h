#pragma once
#include "bake/base/Lists.h"
#include "bake/table/KernelTarget.h"

namespace tss {

/// Fills unit normals of pairs of vertices first to last - 1, three floats for each vertex, and writes one
/// float beyond them. rings: skinRings(). places: four floats for each vertex, x, y, z and one without
/// meaning, aligned; as many for one more where the vertices are odd. outward: -1: normals the other way.
/// Returns whether all have one: those of vertices whose triangles have no area are 0. The same bits whatever
/// the target.
using SkinNormalKernel = bool (*)(const Lists<std::uint32_t>& rings, const float* places, float outward,
                                  std::size_t first, std::size_t last, float* normals);

/// The kernel of a target that is available.
SkinNormalKernel skinNormalKernel(KernelTarget target);

} // namespace tss
