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

/// Of so few pairs and skins none has a brief turn, and `tss bake --budget` cuts none short.
constexpr std::size_t fewToBake = 8;

/// What is baked next, and until when. Without a time limit each item has one turn without one. With one
/// there are rounds, for how long an item takes is not known beforehand: where more than eight wait, brief
/// turns of a hundredth of the time, for half of it at most, so that what is quick is done; then turns of a
/// quarter of the time that is left, or of a fair share where that is longer, twice as long after one that
/// was too short, in the order given, as far as the time goes; then all that is left. One that was cut short
/// has no further turn of less than twice the time. Where several are baked at once each has as much time as
/// all of them.
class BakeTurns {
public:
    struct Turn {
        std::size_t item;
        Deadline until;
        bool brief = false; ///< what is cut short has a longer one: there is nothing to be hasty about
        int round = 0;
        double seconds = 0; ///< until then; 0: no limit
    };

    /// atOnce: how many are baked at the same time.
    BakeTurns(const std::vector<std::size_t>& order, const Deadline& until, std::size_t atOnce = 1);

    /// Nothing: all had their turn, or the time is over or too short for those that wait.
    std::optional<Turn> next();

    /// This turn was too short.
    void cutShort(const Turn& turn);

private:
    struct Waiting {
        std::size_t item;
        double tried; ///< seconds that were too short
    };

    void beginRound();

    std::deque<Waiting> waiting_;
    std::vector<Waiting> cut_; ///< of this round
    int round_ = 0;
    double turn_ = infinity; ///< of this round, seconds
    Deadline briefUntil_;    ///< brief turns end
    const Deadline until_;
    const double atOnce_;
};

} // namespace tss
