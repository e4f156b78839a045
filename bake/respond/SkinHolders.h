#pragma once
#include "bake/respond/SkinCarry.h"

namespace tss {

/// What carries skin, one for each frame and, where it takes one, one more for what holds still: how far each
/// vertex is from the bones of a frame (from its muscles, where it has none), and what belongs to it for
/// certain. Skin far or apart from every bone is a part of the body whose bones are not named. Where it lies
/// beyond a bone that moves, as a hand does beyond a forearm, it goes on from that one; a trunk on both sides
/// of a vertebra is parted; else, as a trunk beside an arm, it goes with what holds still. Where no bone
/// holds still it stays, unless it is the smaller end of one bone.
std::vector<SkinHolder> skinHolders(const SkinGround& ground, const SkinParameters& parameters,
                                    const std::vector<int>& frames);

} // namespace tss
