#pragma once
#include "bake/model/SceneModel.h"

#include <string>

namespace osgTSS {

/// Why the table or proof of a pair does not fit a graph, in words; empty when it does. `found` is what the
/// graph holds now, joints[k] there the joint of the pair's k-th. Fits what has the same source hash; else
/// what has the same surfaces (to a part in 10^5 of their size, in any order of triangles), the same axes and
/// frames, and limits within those of the table: an optimized graph, or one that has moved since, is not
/// refused.
std::string whyUnfit(const tss::SceneModel& found, const std::vector<int>& joints,
                     const tss::SceneModel& model, const tss::Pair& pair);

/// Limits of a joint as it is now that reach beyond those that it was baked with, in words; empty when none
/// do.
std::string whyWider(const tss::Joint& now, const tss::Joint& baked);

} // namespace osgTSS
