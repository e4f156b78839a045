#include "bake/pipeline/BakeTurns.h"

#include "bake/model/Kinematics.h"
#include "bake/pipeline/FirstLook.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tss {

std::vector<std::size_t> pairsByWeight(const SceneModel& scene, const std::vector<std::size_t>& wanted) {
    const std::vector<double> distances = distancesAtRest(scene);
    std::vector<std::size_t> order = wanted;
    std::ranges::stable_sort(order, {}, [&](std::size_t k) {
        const bool tied = tiesDirectly(scene, scene.pairs[k]);
        return std::tuple(!tied, tied ? 0 : distances[k]);
    });
    return order;
}

BakeTurns::BakeTurns(const std::vector<std::size_t>& order, const Deadline& until) : until_(until) {
    for (const std::size_t item : order) waiting_.push_back({item, 0});
}

std::optional<BakeTurns::Turn> BakeTurns::next() {
    while (!waiting_.empty() && !until_.over()) {
        const double share = until_.left() / std::sqrt(double(waiting_.size()));
        last_ = waiting_.front();
        waiting_.pop_front();
        if (share < 2 * last_.tried) continue;
        last_.tried = share;
        return Turn{last_.item, until_.comes() ? Deadline(share) : Deadline()};
    }
    return std::nullopt;
}

} // namespace tss
