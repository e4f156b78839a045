#pragma once
#include "bake/respond/JointModel.h"

namespace tss {

/// Relative allowance for rounding where lengths are compared.
inline constexpr double lengthRounding = 1e-7;

/// How far the gaps of all pairs of a group can fall during one step, scene units.
struct ClosingBounds {
    double speed = 0;     ///< largest sum of speed bounds
    double curvature = 0; ///< half of the largest acceleration bound: on top of the rate at the start
};
ClosingBounds closingBounds(const JointModel::Group& group, const DofValues& step);

/// Bound of |rate| of all gaps of a clustered group at its pose, for the twist of a whole step.
double fastestRate(const JointModel::Group& group, const MotionFrame& frame, const DofTwist& whole);

/// A pair whose gap stays above this cannot become active.
inline double relevantGap(const JointModel::Group& group) {
    return 2 * group.contactOffset;
}

/// Whether the cache of a clustered group shows that none of its pairs can become active on the straight way
/// from q to q + step. The group need not be placed.
bool staysClear(const JointModel& model, std::size_t group, const DofValues& q, const DofValues& step,
                const ResponseBuffers& ws);

/// All tests of a clustered group whose gap is at most the margin at its pose (that of q), and perhaps
/// others; of more than `enough` only some. The span is valid until the next call.
std::span<const std::uint32_t> testsNear(const JointModel& model, std::size_t group, const DofValues& q,
                                         double margin, std::uint32_t enough, ResponseBuffers& ws);

} // namespace tss
