#pragma once
#include "bake/respond/JointModel.h"

namespace tss {

/// Conservative advancement (METHOD 5.2): moves q along q + t step, t up to 1, as far as every near pair
/// provably stays above its threshold. Each sub-step, at most 60, is the larger of the times that a bound on
/// the gap's rate and one on its second derivative allow. Thresholds rise with the gaps up to the contact
/// offset. Every pose passed is free if the near list is complete for this step. Gaps of near pairs must be
/// those at q. Returns t at the end; q is exactly q + step where that is 1. Stops at a pair that is closing
/// and within a twentieth of its contact offset of its threshold; groups of pairs that stopped it are marked
/// in ws.held.
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
