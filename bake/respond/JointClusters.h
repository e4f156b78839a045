#pragma once
#include "bake/respond/JointModel.h"

namespace tss {

/// Appends to the near list the pairs of clustered groups whose gap can fall to their threshold on the
/// straight way from q to q + step, unless they are listed already: with their gap at q, the threshold that
/// cull() gives, and no gradient. The cost is proportional to how many are near. All other pairs of these
/// groups keep a gap above their contact offset all the way.
///
/// On the way a gap falls by no more than the sum of the speed bounds, and by no more than its rate at q and
/// half the bound of its acceleration (METHOD 5.1). First the whole group is tested by these bounds and what
/// the cache knows of its last pose; then the table is searched within the larger bound of all pairs; then
/// each pair found is tested by its own bounds. Returns false where it stopped, the list incomplete, because
/// more than `most` pairs are near or far more had to be tested.
bool listOnStep(const JointModel& model, const DofValues& q, const DofValues& step, ResponseBuffers& ws,
                std::size_t most = ~std::size_t(0));

/// Smallest gap of all pairs of one clustered group, by branch and bound over its clusters.
double smallestGap(const JointModel& model, std::size_t group, const Pose& pose);

} // namespace tss
