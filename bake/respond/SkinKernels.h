#pragma once
#include "bake/respond/SkinWeave.h"
#include "bake/table/Kernels.h"

namespace tss {

/// What looks at every edge or triangle of a skin, for one kind of vectors. The same bits on all of them.
struct SkinKernels {
    /// Sets the bits, 64 a word, of the links that are beyond their limits.
    void (*links)(const SkinWeave&, const SkinPlace* places, std::uint64_t* beyond);
    /// And of the triangles that are turned over.
    void (*triangles)(const SkinWeave&, const SkinPlace* places, std::uint64_t* over);
    /// Adds the normal of each triangle, twice its area long, to its corners.
    void (*normals)(std::span<const Tri> triangles, const SkinPlace* places, SkinPlace* sums);
    /// What is 0 long stays so.
    void (*normalise)(const SkinPlace* sums, std::span<Vec3> normals);
};

/// target: must be available.
const SkinKernels& skinKernels(KernelTarget target = KernelTarget::Best);

} // namespace tss
