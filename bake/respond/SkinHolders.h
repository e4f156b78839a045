#pragma once
#include "bake/respond/SkinCarry.h"

namespace tss {

/// What carries skin, one for each frame and, where it takes one, one more for what holds still: how far each
/// vertex is from the bones of a frame (from its muscles, where it has none), and what belongs to it for
/// certain. Skin far or apart from every bone is a part of the body whose bones are not named. Beside one
/// moving bone alone it goes with that one, as a hand does with a forearm; beside others, or one that holds
/// still, it goes with what holds still, as a trunk does beside an arm. Where no bone holds still it stays,
/// unless it is the smaller end of one bone.
std::vector<SkinHolder> skinHolders(const SkinGround& ground, const SkinParameters& parameters,
                                    const std::vector<int>& frames);

} // namespace tss
