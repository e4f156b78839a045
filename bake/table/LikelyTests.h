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

/// A greedy cover of the poses by at most `most` of these deepest tests: first the test that touches at the
/// largest number of poses, then again and again the one that touches at most of the poses not yet covered.
/// Asked before all others, these end most queries at poses that touch; they change no answer.
std::vector<std::uint32_t> likelyTests(std::span<const TablePair> pairs,
                                       const std::vector<TouchingPose>& poses, std::size_t most);

} // namespace tss
