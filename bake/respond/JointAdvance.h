#pragma once
#include "bake/respond/JointModel.h"

namespace tss {

/// Goes from q along `way` as far as every near pair provably stays above its threshold, at most to the end
/// (METHOD 5.2). A pair's gap cannot fall faster than its speed bound, nor its rate faster than its bound of
/// acceleration: the larger of the two steps is taken, up to 60 times. Thresholds of pairs rise with their
/// gaps up to model.off. Every pose passed is free when the near list is complete for this way.
/// The near pairs' gaps must be those at q; those that cannot close on the way are not looked at again.
/// Returns the share of the way that was gone; q is moved there, exactly to the end when it is 1.
/// Stops at a pair that comes nearer and is within a twentieth of model.off of its threshold.
double advance(const JointModel& model, const JointValues& way, JointValues& q, JointWorkspace& ws);

/// The bound of a pair's speed and acceleration along a way, one time unit for the whole of it.
void boundMotion(const JointModel& model, const JointValues& way, NearPair& near);

} // namespace tss
