#pragma once
#include "bake/spheres/Patches.h"

#include <cstdint>

namespace tss {

/// For every sphere the patches that it covers.
struct CoverSets {
    std::vector<std::size_t> first;     ///< #spheres + 1: where its patches begin in `patches`
    std::vector<std::uint32_t> patches; ///< rising within a sphere

    std::span<const std::uint32_t> of(std::size_t sphere) const {
        return std::span(patches).subspan(first[sphere], first[sphere + 1] - first[sphere]);
    }
};

CoverSets coverSets(std::span<const Sphere> spheres, std::span<const Patch> patches);

/// A small choice of spheres that covers every patch that all of them together cover: lazy greedy by the
/// number of patches gained (ties: the lower index), then the latest chosen are dropped where the others
/// suffice (METHOD 1.3). Returns indices, rising. weights: what a patch counts, all 1 when empty.
std::vector<std::uint32_t> greedyCover(const CoverSets& sets, std::size_t patchCount);

} // namespace tss
