#pragma once
#include "bake/respond/SkinCarry.h"

namespace tss {

/// What carries skin, one for each frame and, where it takes one, one more for what holds still: how far each
/// vertex is from the bones of a frame (from its muscles, where it has none), and what belongs to it for
/// certain. Skin far or apart from every bone is a part of the body whose bones are not named: it goes with
/// what holds still where such a bone is beside it, as a trunk does beside an arm; else, where no bone holds
/// still, it stays, unless it is the smaller end of one bone, as a hand is of a forearm.
std::vector<SkinHolder> skinHolders(const SkinGround& ground, const SkinParameters& parameters,
                                    const std::vector<int>& frames);

} // namespace tss
