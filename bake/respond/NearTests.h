#pragma once
#include "bake/respond/JointModel.h"

namespace tss {

/// What rounding may do to lengths compared here, as a share of them.
inline constexpr double hair = 1e-7;

/// How the pairs of a group may come nearer on one way.
struct Closing {
    double most = 0; ///< of the speed bounds of all pairs
    double bend = 0; ///< half of the largest bound of acceleration
};
Closing closingOf(const JointModel::Group& group, const DofValues& step);

/// The fastest that the gap of any pair of a group in clusters changes where it stands, moved by `whole`.
double fastestRate(const JointModel::Group& group, const MotionFrame& frame, const DofTwist& whole);

/// A pair that stays farther apart than this cannot matter.
inline double keptFrom(const JointModel::Group& group) {
    return 2 * group.contactOffset;
}

/// Whether, by what is known of a group in clusters, none of its pairs can matter on the straight way from q
/// to q + step. The group need not be placed.
bool stillClear(const JointModel& model, std::size_t group, const DofValues& q, const DofValues& step,
                const ResponseRoom& ws);

/// The tests of such a group that may be within the margin where it is placed, at q; some of them once more
/// than `enough` are. Good until the next of these calls.
std::span<const std::uint32_t> testsNear(const JointModel& model, std::size_t group, const DofValues& q,
                                         double margin, std::uint32_t enough, ResponseRoom& ws);

} // namespace tss
