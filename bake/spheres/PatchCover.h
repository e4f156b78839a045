#pragma once
#include "bake/base/Progress.h"
#include "bake/spheres/Patches.h"

#include <cstdint>

namespace tss {

/// For some of the spheres offered the patches that each covers.
struct CoverSets {
    std::vector<std::uint32_t> spheres; ///< indices of the spheres kept
    std::vector<std::size_t> first;     ///< #kept + 1: where the patches of each begin in `patches`
    std::vector<std::uint32_t> patches; ///< rising within a sphere

    std::span<const std::uint32_t> of(std::size_t kept) const {
        return std::span(patches).subspan(first[kept], first[kept + 1] - first[kept]);
    }
};

/// candidates: one per patch, that covers it. Large ones come first, and those whose own patch `enough`
/// others kept cover are left out: this bounds the memory by about the number of patches times `enough`, for
/// whatever tolerance, and costs few spheres. Asked to stop, it returns none.
CoverSets coverSets(std::span<const Sphere> candidates, std::span<const Patch> patches,
                    const Progress& progress = {}, int enough = 24);

/// A small choice of spheres that covers every patch: lazy greedy by the number of patches gained (ties: the
/// one kept earlier), then the latest chosen are dropped where the others suffice (METHOD 1.3). Returns
/// indices of the candidates, rising.
std::vector<std::uint32_t> greedyCover(const CoverSets& sets, std::size_t patchCount);

} // namespace tss
