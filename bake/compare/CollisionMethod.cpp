#include "bake/compare/CollisionMethod.h"

namespace tss::compare {

std::vector<PoseQuery> poseQueries(const Motion& motion, const std::vector<std::vector<double>>& values) {
    std::vector<PoseQuery> queries;
    queries.reserve(values.size());
    for (const auto& q : values) queries.push_back({q, pose(motion, q)});
    return queries;
}

} // namespace tss::compare
