#include "bake/pipeline/Bake.h"

#include "bake/base/Stopwatch.h"
#include "bake/model/SourceHash.h"
#include "bake/pipeline/BakePair.h"
#include "bake/pipeline/BakeSkin.h"
#include "bake/pipeline/BakeTurns.h"
#include "bake/pipeline/CheckBake.h"
#include "bake/pipeline/SelectTests.h"

#include <algorithm>
#include <new>

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

class Baker {
public:
    Baker(SceneModel& scene, const BakeRequest& request, const Progress& progress)
        : scene_(scene), request_(request), outer_(progress),
          progress_([&](std::string_view step, double done) {
              late_ = late_ || turn_.over();
              return !late_ && !interrupted() && report(progress, step, done);
          }) {}

    std::vector<PairReport> run() {
        if (const auto refused = refusedByBake(scene_, request_); !refused.empty()) throw refused.front();
        paths_ = pathsToBake(scene_, request_);
        // Those that are never reached keep what was asked for.
        for (Pair& pair : scene_.pairs)
            if (isToBake(pair)) addSettings(pair, request_);
        for (SkinModel& skin : scene_.skins)
            if (isToBake(skin)) addSettings(skin, request_);
        bakeInTurns();
        return std::move(reports_);
    }

private:
    bool interrupted() {
        over_ = over_ || (request_.interrupted && request_.interrupted());
        return over_;
    }

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

    void bakeInTurns() {
        BakeTurns turns(order(), request_.until);
        while (!interrupted()) {
            const std::optional<BakeTurns::Turn> turn = turns.next();
            if (!turn) break;
            turn_ = turn->until;
            brief_ = turn->brief;
            const auto bakeIt = [&](auto& item) {
                one(item, [&](PairReport& report) { bakeOne(item, report); });
            };
            const std::size_t pairs = scene_.pairs.size();
            turn->item < pairs ? bakeIt(scene_.pairs[turn->item]) : bakeIt(scene_.skins[turn->item - pairs]);
            if (late_) turns.cutShort();
        }
    }

    void bakeOne(Pair& pair, PairReport& report) {
        BakeOptions options = optionsFor(scene_, pair);
        options.kept = kept_;
        options.effort = request_.effort;
        options.mostLooks = static_cast<std::uint64_t>(request_.effort * double(options.mostLooks));
        options.mostPatches = static_cast<std::size_t>(request_.effort * double(options.mostPatches));
        if (!brief_) options.until = turn_;
        try {
            bakePair(scene_, pair, options, report, progress_);
        } catch (const BudgetEnded&) {
            if (!turn_.comes()) throw;
            late_ = true;
        }
    }

    void bakeOne(SkinModel& skin, PairReport& report) {
        bakeSkin(scene_, skin, optionsFor(skin.settings, {}, scene_.metersPerUnit), report, progress_);
    }

    /// Bakes one item; leaves it as it was where that does not come to its end.
    template <class Item, class Work>
    void one(Item& item, const Work& work) {
        const Item before = item;
        late_ = false;
        try {
            const PairReport report = timed(item, work);
            if (!late_ && !interrupted()) {
                reports_.push_back(report);
                if (request_.done) request_.done(report);
                return;
            }
        } catch (const InputError& error) {
            if (!late_ && !interrupted()) {
                if (!request_.failed) throw;
                request_.failed(error);
            }
        }
        item = before;
    }

    SceneModel& scene_;
    const BakeRequest& request_;
    const Progress& outer_; ///< of the caller
    bool over_ = false;
    Deadline turn_;      ///< by which the one in work is to be done
    bool brief_ = false; ///< it has a longer turn where that is not enough
    bool late_ = false;  ///< it was not, and was told to stop
    const Progress progress_;
    const std::shared_ptr<WholeFits> kept_ =
        std::make_shared<WholeFits>([this](std::string_view step, double done) {
            return !request_.until.over() && !interrupted() && report(outer_, step, done);
        });
    std::vector<std::string> paths_; ///< of what is baked
    std::vector<PairReport> reports_;
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
