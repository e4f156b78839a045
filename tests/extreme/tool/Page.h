#pragma once
#include <cstdint>
#include <string>

namespace extreme {

struct PageOptions {
    long steps = 1000000;       ///< of the joint that is driven to and fro
    long frames = 1000000;      ///< of the skin, with rest and without
    std::uint64_t seeds = 1000; ///< random scenes
};

/// docs/STABILITY.md: every case, what was asked, what happens and the figure, all measured now.
std::string stabilityPage(const PageOptions& options);

} // namespace extreme
