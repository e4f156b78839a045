#pragma once
#include "bake/respond/JointAdvance.h"

namespace tss {

/// Moves q from a pose stopped by contact along the contact towards the goal (METHOD 5.4), by sequential
/// quadratic programming: each round finds the nearest pose to the goal under linearised gaps, limits and
/// planes, and advance() guards the move to it. At most 20 rounds, and 40 more limited to farMove while the
/// goal is far; ends where four rounds gain next to nothing. The weighted distance to the goal never grows.
/// The result is a local optimum: a concave obstacle may hold the joint although there is a nearer pose
/// around it. Afterwards ws.near holds the pairs near q.
void slide(const JointModel& model, const DofValues& goal, DofValues& q, ResponseBuffers& ws);

/// Moves a joint out of collision by short steps (METHOD 5.6). All pairs have one common threshold, the
/// smallest level (levelOf()) of all, which each step raises; where not all pairs can be raised that far at
/// once, by less. Returns the smallest level at q afterwards; > 0: out of collision.
double pushOut(const JointModel& model, DofValues& q, ResponseBuffers& ws);

} // namespace tss
