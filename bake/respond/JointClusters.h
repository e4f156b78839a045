#pragma once
#include "bake/respond/JointModel.h"

namespace tss {

/// Appends to the near list the pairs of clustered groups whose gap can fall to their threshold on the
/// straight way from q to q + step, unless they are listed already. Each gets its gap at q and the threshold
/// that cull() gives, but no gradient. All other pairs of these groups keep a gap above their contact offset
/// all the way. The cost is proportional to how many pairs are near.
///
/// Two bounds say how far a gap can fall on the way (METHOD 5.1): the sum of the speed bounds, and its rate
/// at q plus half the bound of its acceleration. They are used three times: for a whole group, with what the
/// cache knows of its last pose; for a search of its table, with bounds that hold for all its pairs; and for
/// each pair that is found, with its own. Returns false, with the list incomplete, where more than `most`
/// pairs are near or far more than that had to be tested.
bool listOnStep(const JointModel& model, const DofValues& q, const DofValues& step, ResponseBuffers& ws,
                std::size_t most = ~std::size_t(0));

/// Smallest gap of all pairs of one clustered group, by branch and bound over its clusters.
double smallestGap(const JointModel& model, std::size_t group, const Pose& pose);

} // namespace tss
