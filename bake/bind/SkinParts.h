#pragma once
#include "bake/bind/SkinInfluences.h"
#include "bake/bind/SkinSides.h"

namespace tss {

/// Assigns the parts of a skin whose bones are not given to influences, see skinInfluences(), and to each
/// influence the vertices that certainly belong to it. Returns the influences, with one more that never moves
/// if no bone is at rest.
std::vector<SkinInfluence> assignParts(const SkinAnatomy& anatomy, std::vector<FrameInfluence> influences,
                                       std::vector<MovedGroup> groups);

} // namespace tss
