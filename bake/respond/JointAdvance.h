#pragma once
#include "bake/respond/JointModel.h"

namespace tss {

/// Goes from q along `way` as far as every near pair provably stays above its threshold, at most to the end
/// (METHOD 5.2). A pair's gap cannot fall faster than its speed bound, nor its rate faster than its bound of
/// acceleration: the larger of the two steps is taken, up to 60 times. Thresholds of pairs rise with their
/// gaps up to their contact offset. Every pose passed is free when the near list is complete for this way.
/// The near pairs' gaps must be those at q; those that cannot close on the way are not looked at again.
/// Returns the share of the way that was gone; q is moved there, exactly to the end when it is 1.
/// Stops at a pair that comes nearer and is within a twentieth of its contact offset of its threshold; groups
/// of pairs that stopped it are marked in ws.held.
double advance(const JointModel& model, const DofValues& step, DofValues& q, ResponseRoom& ws);

/// How the whole way moves a point of A's frame, one time unit for all of it.
DofTwist twistOfStep(const JointModel::Group& group, const MotionFrame& frame, const DofValues& step);

/// Bounds of speeds and accelerations along one way, one time unit for the whole of it; what all pairs of a
/// group share is found once.
class MotionBounds {
public:
    /// Sets near.speed and near.acceleration. Quick where pairs come group by group, always with the same
    /// way.
    void bound(const JointModel& model, const DofValues& step, NearPair& near);

private:
    std::uint32_t group_ = ~0u;
    int count_ = 0;
    std::array<int, maxDofs> dofs_;
    DofValues change_, bend_; ///< per DOF of the group: of a unit of lever, speed and acceleration
};

} // namespace tss
