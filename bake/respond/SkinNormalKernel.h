#pragma once
#include "bake/base/Lists.h"
#include "bake/table/KernelTarget.h"

namespace tss {

/// What normals are asked of.
struct SkinNormalQuestion {
    const Lists<std::uint32_t>& rings; ///< skinRings()
    const float* places = nullptr;     ///< four for each vertex, x, y, z and one without meaning, aligned;
                                       ///< as many for one more where the vertices are odd
    float outward = 1;                 ///< -1: normals the other way
};

/// Fills unit normals of pairs first to last - 1, three floats for each vertex, and writes one float beyond
/// them. Returns whether all have one: those of vertices whose triangles have no area are 0. The same bits
/// whatever the target.
using SkinNormalKernel = bool (*)(const SkinNormalQuestion& question, std::size_t first, std::size_t last,
                                  float* normals);

/// The kernel of a target that is available.
SkinNormalKernel skinNormalKernel(KernelTarget target);

} // namespace tss
