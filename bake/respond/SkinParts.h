#pragma once
#include "bake/respond/SkinHolders.h"

namespace tss {

/// Gives the parts of a skin whose bones are not named to what they go with, see skinHolders(), and each bone
/// what is its own for certain. Returns the holders, and one more for what holds still where no bone does.
/// moved: #swings of #holders.
std::vector<SkinHolder> holdParts(const SkinGround& ground, std::vector<FrameHolder> holders,
                                  std::vector<std::vector<char>> moved);

} // namespace tss
