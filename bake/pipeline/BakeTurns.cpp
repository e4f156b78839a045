#include "bake/pipeline/BakeTurns.h"

#include "bake/model/Kinematics.h"
#include "bake/pipeline/FirstLook.h"

#include <algorithm>
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

BakeTurns::BakeTurns(const std::vector<std::size_t>& order, const Deadline& until, std::size_t atOnce)
    : until_(until), atOnce_(double(atOnce)) {
    for (const std::size_t item : order) waiting_.push_back({item, 0});
    if (waiting_.size() <= fewToBake) ++round_; // no brief turns
    beginRound();
}

void BakeTurns::beginRound() {
    const double left = until_.left(), count = double(std::max<std::size_t>(waiting_.size(), 1));
    ++round_;
    turn_ = round_ == 1   ? atOnce_ * left / 100
            : round_ == 2 ? std::max(left / 4, std::min(left, atOnce_ * left / count))
                          : left;
    if (round_ == 1) briefUntil_ = Deadline(left / 2);
}

void BakeTurns::cutShort(const Turn& turn) {
    const Waiting again{turn.item, turn.seconds};
    if (turn.round < round_) return waiting_.push_back(again);
    cut_.push_back(again);
    if (round_ > 1) turn_ = 2 * turn.seconds;
}

std::optional<BakeTurns::Turn> BakeTurns::next() {
    while (!until_.over()) {
        if (waiting_.empty() || (round_ == 1 && briefUntil_.over())) {
            cut_.insert(cut_.end(), waiting_.begin(), waiting_.end()); // those that had no turn yet
            if (cut_.empty()) return std::nullopt;
            waiting_.assign(cut_.begin(), cut_.end());
            cut_.clear();
            beginRound();
        }
        const Waiting one = waiting_.front();
        waiting_.pop_front();
        if (!until_.comes()) return Turn{one.item, {}, false, round_, 0};
        const double seconds = std::min(turn_, until_.left());
        if (seconds < 2 * one.tried) continue;
        return Turn{one.item, Deadline(seconds), round_ == 1, round_, seconds};
    }
    return std::nullopt;
}

} // namespace tss
