#pragma once
#include "bake/respond/JointAdvance.h"

namespace tss {

/// From a pose that is held by contact on towards the goal along the contact (METHOD 5.4): the nearest pose
/// under linearised gaps, limits and couplings, each move guarded by `advance`, at most 20 rounds, and 40
/// more of moves of farMove while the goal is farther; it ends where four rounds gain nothing to speak of. q
/// comes never farther from the goal in the weighted metric. The result is a local optimum: a bay of the
/// obstacle keeps the joint although there may be a nearer pose around it. Leaves in ws.near what is near at
/// q.
void slide(const JointModel& model, const DofValues& goal, DofValues& q, ResponseRoom& ws);

/// Leads a joint out of collision by the shortest moves (METHOD 5.6): one common threshold, the deepest gap,
/// which each move raises (above contact a share of what each table keeps, levelOf()); demands are shortened
/// where they cannot all be met. Returns the smallest level at q then; > 0: it is out.
double pushOut(const JointModel& model, DofValues& q, ResponseRoom& ws);

} // namespace tss
