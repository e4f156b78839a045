#pragma once
#include "bake/respond/JointModel.h"

namespace tss {

/// Of the groups in clusters the pairs that can come to their threshold on the straight way from q to
/// q + way go into the near list, those that are in it already aside: with their gap at q, the threshold that
/// `cull` gives them, and no gradient. Work is in proportion to what is near. All other pairs of these groups
/// stay farther apart than their contact offset all the way.
///
/// In METHOD 5.1's terms: on the way a gap falls by no more than the sum of the speed bounds, nor by more
/// than its rate at q with half the bound of its acceleration. The first is asked of a whole group before
/// it is placed, with what was known of it where the joint stood before; the larger of both bounds of all its
/// pairs is the margin within which its table is asked; then each pair found is asked for itself.
/// Returns false where it stopped, the list incomplete, because more than `most` pairs are near, or too many
/// have to be asked for that.
bool listOnStep(const JointModel& model, const DofValues& q, const DofValues& step, ResponseRoom& ws,
                std::size_t most = ~std::size_t(0));

/// Smallest gap of the pairs of one group in clusters: of all of them, looking at few.
double smallestGap(const JointModel& model, std::size_t group, const Pose& pose);

} // namespace tss
