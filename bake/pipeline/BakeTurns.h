#pragma once
#include "bake/base/Stopwatch.h"
#include "bake/model/SceneModel.h"

#include <deque>
#include <optional>
#include <vector>

namespace tss {

/// The pairs `wanted`, those that matter most first: those that a joint ties directly, then the others, the
/// nearest at rest first. Numbers in scene.pairs.
std::vector<std::size_t> pairsByWeight(const SceneModel& scene, const std::vector<std::size_t>& wanted);

/// What is baked next, and until when. Each item may take the time that is left divided by the root of how
/// many wait, so that neither a few long ones take all of it nor many of medium length are all cut short. One
/// that is cut short waits behind the others for a turn of at least twice the time. Without a time limit each
/// has one turn without one.
class BakeTurns {
public:
    struct Turn {
        std::size_t item;
        Deadline until;
    };

    BakeTurns(const std::vector<std::size_t>& order, const Deadline& until);

    /// Nothing: all had their turn, or the time is over, or too short for those that wait.
    std::optional<Turn> next();

    /// The turn that next() gave last was too short.
    void cutShort() { waiting_.push_back(last_); }

private:
    struct Waiting {
        std::size_t item;
        double tried; ///< seconds that were too short
    };

    std::deque<Waiting> waiting_;
    Waiting last_{};
    const Deadline until_;
};

} // namespace tss
