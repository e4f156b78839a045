#include "bake/pipeline/Bake.h"

#include "bake/base/Parallel.h"
#include "bake/model/SourceHash.h"
#include "bake/pipeline/BakePair.h"
#include "bake/pipeline/BakeSkin.h"
#include "bake/pipeline/BakeTurns.h"
#include "bake/pipeline/CheckBake.h"
#include "bake/pipeline/SelectTests.h"

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <new>
#include <thread>

namespace tss {

void expectPaths(const SceneModel& scene, const std::vector<std::string>& paths, const std::string& file) {
    for (const std::string& path : paths)
        if (findPair(scene, path) < 0 && findSkin(scene, path) < 0)
            throw InputError(Where{file, "", path}, "no pair and no skin of this path in the scene");
}

bool isWanted(const BakeRequest& request, const std::string& path) {
    return request.pairs.empty() || std::ranges::find(request.pairs, path) != request.pairs.end();
}

namespace {

bool hasTable(const Pair& pair) {
    return pair.table || pair.proof;
}
bool hasTable(const SkinModel& skin) {
    return skin.table != nullptr;
}

template <class Item>
void addSettings(Item& item, const BakeRequest& request) {
    for (const auto& [key, text] : request.given) item.settings[key] = text;
}

/// The item is asked for, and stale() says of it with the settings given that its table does not fit, where
/// that matters.
template <class Item, class Stale>
bool isToBake(Item item, const BakeRequest& request, const Stale& stale) {
    if (!isWanted(request, item.path)) return false;
    if (!request.onlyMissing || !hasTable(item)) return true;
    addSettings(item, request);
    return !stale(item).empty();
}

/// Runs one bake and times it; an input error is told with the prim that it belongs to.
template <class Item, class Work>
PairReport timed(Item& item, const Work& work) {
    PairReport report;
    report.path = item.path;
    const Stopwatch watch;
    try {
        work(report);
    } catch (const InputError& error) {
        if (!error.where.path.empty()) throw;
        throw InputError(Where{error.where.file, error.where.pointer, item.path}, error.message);
    } catch (const std::bad_alloc&) {
        throw InputError(Where{"", "", item.path}, "not enough memory for this input");
    }
    report.seconds = watch.seconds();
    return report;
}

/// So many pairs and skins at most are in work at once, whatever the machine: each may take gigabytes.
constexpr std::size_t mostAtOnce = 4;

class Baker {
public:
    Baker(SceneModel& scene, const BakeRequest& request, const Progress& progress)
        : scene_(scene), request_(request), progress_(progress) {}

    std::vector<PairReport> run() {
        if (const auto refused = refusedByBake(scene_, request_); !refused.empty()) throw refused.front();
        paths_ = pathsToBake(scene_, request_);
        // Those that are never reached keep what was asked for.
        for (Pair& pair : scene_.pairs)
            if (isToBake(pair)) addSettings(pair, request_);
        for (SkinModel& skin : scene_.skins)
            if (isToBake(skin)) addSettings(skin, request_);
        const std::vector<std::size_t> items = order();
        const std::size_t atOnce =
            std::clamp<std::size_t>(items.size(), 1, std::min(threadCount(), mostAtOnce));
        BakeTurns turns(items, request_.until, atOnce);
        untold_ = items;
        {
            std::vector<std::jthread> others;
            for (std::size_t k = 1; k < atOnce; ++k) others.emplace_back([&] { work(turns); });
            work(turns);
        }
        tell(true);
        return std::move(reports_);
    }

private:
    /// One item in work, in one thread.
    struct Task {
        BakeTurns::Turn turn;
        bool late = false; ///< the turn was too short, and the work was told to stop
    };
    /// What came of an item.
    struct Outcome {
        PairReport report;
        std::exception_ptr error;
        bool ends = false; ///< the whole bake: the caller takes no such error
    };

    template <class Item>
    bool isToBake(const Item& item) const {
        return std::ranges::find(paths_, item.path) != paths_.end();
    }

    /// What is to be baked, in its order: numbers of pairs, then, counted on, of skins. Where time is short
    /// skins come first, for all that is seen of a body is its skin.
    std::vector<std::size_t> order() const {
        std::vector<std::size_t> pairs, skins;
        for (std::size_t k = 0; k < scene_.pairs.size(); ++k)
            if (isToBake(scene_.pairs[k])) pairs.push_back(k);
        for (std::size_t k = 0; k < scene_.skins.size(); ++k)
            if (isToBake(scene_.skins[k])) skins.push_back(scene_.pairs.size() + k);
        if (!request_.until.comes()) {
            pairs.insert(pairs.end(), skins.begin(), skins.end());
            return pairs;
        }
        pairs = pairsByWeight(scene_, pairs);
        skins.insert(skins.end(), pairs.begin(), pairs.end());
        return skins;
    }

    /// What each thread does: one item after the other.
    void work(BakeTurns& turns) {
        std::unique_lock lock(state_);
        for (;;) {
            const auto turn = interrupted() || failed_ ? std::nullopt : turns.next();
            if (!turn) {
                if (inWork_ == 0) break;
                ended_.wait(lock); // what is in work may be cut short, and come again
                continue;
            }
            ++inWork_;
            Task task{*turn};
            lock.unlock();
            const std::size_t pairs = scene_.pairs.size();
            turn->item < pairs ? one(scene_.pairs[turn->item], task)
                               : one(scene_.skins[turn->item - pairs], task);
            lock.lock();
            if (task.late) turns.cutShort(*turn);
            --inWork_;
            ended_.notify_all();
        }
    }

    bool interrupted() {
        const std::lock_guard lock(told_);
        over_ = over_ || (request_.interrupted && request_.interrupted());
        return over_;
    }

    /// Tells of the progress of one task at a time: of several at once nobody could make sense. of: null: of
    /// what serves any.
    bool reported(const Task* of, std::string_view step, double done) {
        const std::lock_guard lock(told_);
        if (shown_ == nullptr) shown_ = of;
        if (of == nullptr || shown_ == of) goesOn_ = report(progress_, step, done);
        return goesOn_;
    }

    void hide(const Task& task) {
        const std::lock_guard lock(told_);
        if (shown_ == &task) shown_ = nullptr;
    }

    Progress progressOf(Task& task) {
        return [this, &task](std::string_view step, double done) {
            task.late = task.late || task.turn.until.over();
            return !task.late && !interrupted() && reported(&task, step, done);
        };
    }

    void bakeOne(Pair& pair, Task& task, PairReport& report) {
        BakeOptions options = optionsFor(scene_, pair);
        options.kept = kept_;
        options.effort = request_.effort;
        options.mostLooks = static_cast<std::uint64_t>(request_.effort * double(options.mostLooks));
        options.mostPatches = static_cast<std::size_t>(request_.effort * double(options.mostPatches));
        if (!task.turn.brief) options.until = task.turn.until;
        try {
            bakePair(scene_, pair, options, report, progressOf(task));
        } catch (const BudgetEnded&) {
            if (!task.turn.until.comes()) throw;
            task.late = true;
        }
    }

    void bakeOne(SkinModel& skin, Task& task, PairReport& report) {
        bakeSkin(scene_, skin, optionsFor(skin.settings, {}, scene_.metersPerUnit), report, progressOf(task));
    }

    /// Bakes one item; leaves it as it was where that does not come to its end.
    template <class Item>
    void one(Item& item, Task& task) {
        Item baked = item;
        Outcome outcome;
        bool broken = false; // by what is no fault of the input, whether or not there was time for more
        try {
            outcome.report = timed(baked, [&](PairReport& report) { bakeOne(baked, task, report); });
        } catch (const InputError&) {
            outcome.error = std::current_exception();
            outcome.ends = !request_.failed;
        } catch (...) {
            outcome.error = std::current_exception();
            outcome.ends = broken = true;
        }
        const bool left = task.late || interrupted();
        const std::lock_guard lock(state_);
        hide(task);
        if (left && !broken) return;
        failed_ = failed_ || outcome.ends;
        if (!outcome.error) store(baked, item);
        outcomes_.emplace(task.turn.item, std::move(outcome));
        tell(false);
    }

    /// No more than this, for the rest is read by those in work.
    static void store(const Pair& baked, Pair& pair) {
        pair.table = baked.table;
        pair.proof = baked.proof;
        pair.sourceHash = baked.sourceHash;
    }
    static void store(const SkinModel& baked, SkinModel& skin) {
        skin.table = baked.table;
        skin.sourceHash = baked.sourceHash;
    }

    /// Tells the caller what came of items: without a time limit in their order, whichever was done first.
    /// all: at the end; throws the first error that ends the bake.
    void tell(bool all) {
        const bool inOrder = !request_.until.comes() && !all;
        for (auto next = untold_.begin(); next != untold_.end();) {
            const auto known = outcomes_.find(*next);
            if (known == outcomes_.end() || (known->second.ends && !all)) {
                if (inOrder) return;
                ++next;
                continue;
            }
            const Outcome outcome = std::move(known->second);
            outcomes_.erase(known);
            next = untold_.erase(next);
            if (outcome.ends) std::rethrow_exception(outcome.error);
            const std::lock_guard lock(told_);
            if (outcome.error) {
                try {
                    std::rethrow_exception(outcome.error);
                } catch (const InputError& error) {
                    request_.failed(error);
                }
            } else {
                reports_.push_back(outcome.report);
                if (request_.done) request_.done(outcome.report);
            }
        }
    }

    SceneModel& scene_;
    const BakeRequest& request_;
    const Progress& progress_;
    std::vector<std::string> paths_; ///< of what is baked

    std::mutex state_;                        ///< of the items of the scene and what follows
    std::condition_variable ended_;           ///< a task has ended
    std::size_t inWork_ = 0;                  ///< tasks
    bool failed_ = false;                     ///< with an error that ends the bake
    std::vector<std::size_t> untold_;         ///< items of which the caller was not told yet, in their order
    std::map<std::size_t, Outcome> outcomes_; ///< of items, those not told yet
    std::vector<PairReport> reports_;

    std::mutex told_;             ///< of all that the caller is asked and told, and what follows; locked last
    const Task* shown_ = nullptr; ///< of which progress is told
    bool goesOn_ = true;          ///< what was answered last
    bool over_ = false;
    const std::shared_ptr<WholeFits> kept_ =
        std::make_shared<WholeFits>([this](std::string_view step, double done) {
            return !request_.until.over() && !interrupted() && reported(nullptr, step, done);
        });
};

} // namespace

std::vector<std::string> pathsToBake(const SceneModel& scene, const BakeRequest& request) {
    std::vector<std::string> paths;
    MeshHashes meshes;
    const auto stalePair = [&](const Pair& pair) { return staleness(scene, pair, &meshes); };
    const auto staleSkin = [&](const SkinModel& skin) { return staleness(scene, skin); };
    for (const Pair& pair : scene.pairs)
        if (isToBake(pair, request, stalePair)) paths.push_back(pair.path);
    for (const SkinModel& skin : scene.skins)
        if (isToBake(skin, request, staleSkin)) paths.push_back(skin.path);
    return paths;
}

std::vector<PairReport> bake(SceneModel& scene, const BakeRequest& request, const Progress& progress) {
    expectPaths(scene, request.pairs);
    return Baker(scene, request, progress).run();
}

} // namespace tss
