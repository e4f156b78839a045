#pragma once
#include "bake/respond/SkinHolders.h"

#include <optional>

namespace tss {

/// Gives the parts of a skin whose bones are not named to what they go with, see skinHolders(), and each bone
/// what is its own for certain. Returns what holds still where no bone does.
std::optional<SkinHolder> holdParts(const SkinGround& ground, std::vector<FrameHolder>& holders);

} // namespace tss
