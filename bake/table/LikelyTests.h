#pragma once
#include "bake/table/TablePairs.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tss {

/// Where a table touches, and its deepest test there.
struct TouchingPose {
    Pose pose;
    std::uint32_t test = 0;
};

/// At most `most` of these deepest tests, the one first that touches at most of the poses, then always the
/// one that touches at most of those where none before it does: asked before all others they end most
/// questions of poses that touch, and change no answer.
std::vector<std::uint32_t> likelyTests(std::span<const TablePair> pairs,
                                       const std::vector<TouchingPose>& poses, std::size_t most);

} // namespace tss
