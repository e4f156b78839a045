#pragma once
#include "bake/respond/JointModel.h"

namespace tss {

/// Conservative advancement (METHOD 5.2): moves q along q + t step, t from 0 up to 1, as far as every near
/// pair provably stays above its threshold. ws: the near pairs, with their gaps at q; if they are complete
/// for this step, every pose passed is free.
///
/// Goes in at most 60 sub-steps. For each pair a bound of the gap's rate allows one time and a bound of its
/// second derivative another; the larger counts, and the smallest of all pairs is the sub-step. Thresholds
/// rise with the gaps, up to the contact offset. Stops at a pair that is closing and whose gap is less than a
/// twentieth of its contact offset above its threshold; the groups of such pairs are marked in ws.held.
/// Returns t at the end; q is exactly q + step where that is 1.
double advance(const JointModel& model, const DofValues& step, DofValues& q, ResponseBuffers& ws);

/// The twist of a group's body while its joint makes the whole step in unit time, in A's frame.
DofTwist twistOfStep(const JointModel::Group& group, const MotionFrame& frame, const DofValues& step);

/// Bounds of speed and acceleration of gaps during one step, made in unit time. What all pairs of a group
/// have in common is computed once.
class MotionBounds {
public:
    /// Sets near.speed and near.acceleration. All calls must have the same step; quick where the pairs of a
    /// group follow one another.
    void bound(const JointModel& model, const DofValues& step, NearPair& near);

private:
    std::uint32_t group_ = ~0u;
    int count_ = 0;
    std::array<int, maxDofs> dofs_;
    DofValues change_, bend_; ///< per DOF of the group: speed and acceleration bounds at a lever of 1
};

} // namespace tss
