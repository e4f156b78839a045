#pragma once
#include "bake/motion/MotionFrame.h"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace tss {

/// What is known of a group in clusters from where it stood before: which tests had a gap of at most `range`
/// there. It spares asking the table again, and changes no answer.
struct KnownNear {
    static constexpr double nothing = -std::numeric_limits<double>::infinity();
    static constexpr std::uint32_t most = 128, bins = 16;
    std::vector<std::uint32_t>
        tests; ///< by the bins of their gaps, each as wide as the others, up to `range`
    std::array<std::uint32_t, bins> ends{}; ///< of the bins among the tests
    double range = nothing;
    double least = nothing; ///< gap of all tests of the table there
    Pose pose = Pose::Identity();
    double more = 0; ///< how much farther than needed is asked, so that there are neither many nor none

    /// Where it was last placed no test had a smaller gap than `clear`.
    double clear = nothing;
    DofValues values{}; ///< of its DOFs there
    MotionFrame frame;

    void forget() { range = least = clear = nothing; }
};

} // namespace tss
