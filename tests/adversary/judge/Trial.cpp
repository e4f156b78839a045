#include "tests/adversary/judge/Trial.h"

#include "bake/base/Error.h"
#include "bake/pipeline/Bake.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/WriteLayer.h"
#include "bake/table/Query.h"
#include "tests/adversary/judge/Surfaces.h"
#include "tests/extreme/scenes/Builders.h"

#include <cmath>
#include <fmt/format.h>

namespace adversary {

using namespace tss;

namespace {

/// Says no when its time is over.
class Allowance {
public:
    explicit Allowance(double seconds) : until_(processorSeconds() + seconds) {}
    Progress progress() {
        return [this](std::string_view, double) {
            over_ = over_ || processorSeconds() > until_;
            return !over_;
        };
    }
    bool over() const { return over_; }

private:
    double until_;
    bool over_ = false;
};

const RestRegion& regionOf(const Pair& pair) {
    return pair.table ? pair.table->restRegion : pair.proof->restRegion;
}

/// What is wrong with the claim itself, whatever the poses.
void judgeClaim(const SceneModel& scene, const Pair& pair, Trial& trial) {
    const TriangleMesh &a = scene.bodies[pair.bodyA].mesh, &b = scene.bodies[pair.bodyB].mesh;
    const RestRegion& region = regionOf(pair);
    const Surfaces surfaces(a, b, region);
    trial.exemptShare = std::max(surfaces.exemptShareA(), surfaces.exemptShareB());
    const Motion motion = pairMotion(scene, pair);
    const Pose rest = pose(motion, restValues(motion));
    const auto setting = pair.settings.find("at-rest");
    if (!region.empty()) {
        if (setting != pair.settings.end() && setting->second == "collide")
            trial.troubles.push_back("an exception at rest though none was to be made");
        // What touches to the bit touches to a float's rounding when it is read.
        const double touching = 0x1p26 * surfaces.rounding(rest);
        const auto outside = [](const TriangleMesh& mesh, const Vec3& point) {
            return std::abs(MeshQuery(mesh).windingNumber(point)) < 0.5;
        };
        if (surfaces.distance(rest) > touching && !surfaces.fillingsNear(rest, touching) &&
            outside(a, rest * b.vertices.front()) &&
            outside(b, rest.inverse(Eigen::Isometry) * a.vertices.front()))
            trial.troubles.push_back(fmt::format(
                "an exception at rest though the meshes are {:.3g} apart there", surfaces.distance(rest)));
    }
    if (pair.proof) {
        if (!(pair.proof->clearance > 0)) trial.troubles.push_back("never collide, with no clearance");
        return;
    }
    trial.firesAtRest = query(*pair.table, restValues(motion)).hit();
    trial.tests = pair.table->testCount();
    trial.certified = pair.table->certified;
    trial.missUnknown = trial.certified && !pair.table->boundMiss;
}

void verify(const SceneModel& scene, const TrialOptions& options, Trial& trial) {
    Allowance allowance(options.verifySeconds);
    const double start = processorSeconds();
    try {
        trial.verifyRefusal = verifyPair(scene, scene.pairs[0], allowance.progress()).reason;
    } catch (const InputError& error) {
        trial.verifyRefusal = error.what();
    }
    trial.verifyTook = processorSeconds() - start;
    if (!allowance.over()) return;
    trial.stopped = true;
    trial.verifyRefusal.clear();
}

} // namespace

Findings attackPair(const SceneModel& scene, const Pair& pair, const AttackOptions& options) {
    const TriangleMesh &a = scene.bodies[pair.bodyA].mesh, &b = scene.bodies[pair.bodyB].mesh;
    const Motion motion = pairMotion(scene, pair);
    return pair.table ? attackTable(a, b, motion, *pair.table, options)
                      : attackProof(a, b, motion, *pair.proof, options);
}

Trial tryScene(SceneModel scene, const std::string& name, std::uint64_t seed, const TrialOptions& options) {
    Trial trial;
    trial.name = name;
    Allowance allowance(options.bakeSeconds);
    const double start = processorSeconds();
    try {
        bake(scene, {}, allowance.progress());
        trial.bakeTook = processorSeconds() - start;
        scene = extreme::readText(writeJson(layerOf(scene)), name); // what is claimed is what the file says
    } catch (const InputError& error) {
        trial.bakeTook = processorSeconds() - start;
        trial.refusal = error.what();
    }
    trial.stopped = allowance.over();
    if (!trial.refusal.empty()) return trial;
    const Pair& pair = scene.pairs[0];
    trial.proof = pair.proof != nullptr;
    judgeClaim(scene, pair, trial);
    // Stopped, a bake leaves what it has, which must be true all the same.
    if (!trial.stopped && (trial.proof || trial.certified)) verify(scene, options, trial);
    const double attacked = processorSeconds();
    trial.found = attackPair(scene, pair, {options.poses, seed, options.attackSeconds});
    trial.attackTook = processorSeconds() - attacked;
    if (trial.found.failed()) trial.troubles.push_back(trial.found.what);
    return trial;
}

Trial tryScene(std::uint64_t seed, const TrialOptions& options) {
    const NamedDraft drawn = drawScene(seed);
    Trial trial;
    try {
        trial = tryScene(sceneOf(drawn.draft, drawn.name), drawn.name, seed, options);
    } catch (const InputError& error) { // what no file can spell
        trial.name = drawn.name;
        trial.refusal = error.what();
    }
    if (drawn.draft.refused && trial.refusal.empty())
        trial.troubles.push_back("there is no pose, and yet it was baked");
    return trial;
}

void add(Tally& tally, const Trial& trial) {
    ++tally.scenes;
    tally.stopped += trial.stopped;
    tally.troubles += !trial.troubles.empty();
    tally.bakeTook += trial.bakeTook;
    tally.verifyTook += trial.verifyTook;
    tally.attackTook += trial.attackTook;
    if (!trial.refusal.empty()) {
        tally.refused += !trial.stopped;
        return;
    }
    tally.proofs += trial.proof;
    tally.tables += !trial.proof;
    tally.uncertified += !trial.proof && !trial.certified;
    tally.missUnknown += trial.missUnknown;
    tally.vacuous += trial.exemptShare > 0.9;
    tally.share += trial.exemptShare;
    tally.firesAtRest += trial.firesAtRest;
    tally.verifyRefused += !trial.verifyRefusal.empty();
    tally.verified += !trial.stopped && trial.verifyRefusal.empty();
    tally.poses += trial.found.poses;
    tally.contacts += trial.found.contacts;
    tally.missed += trial.found.missed;
    tally.early += trial.found.early;
    tally.kernel += trial.found.kernel;
    tally.doubts += trial.found.doubts;
}

namespace {

/// A refusal without its place and numbers.
std::string shortened(const std::string& refusal) {
    const std::size_t place = refusal.rfind(">)");
    std::string text = place == std::string::npos ? refusal : refusal.substr(place + 2);
    const std::size_t bare = text.find(">: ");
    if (bare != std::string::npos) text = text.substr(bare + 3);
    std::string out;
    bool number = false;
    for (const char c : text.substr(0, 160)) {
        const bool digit =
            std::isdigit(static_cast<unsigned char>(c)) || (number && (c == '.' || c == 'e' || c == '-'));
        if (digit && !number) out += '#';
        if (!digit) out += c;
        number = digit;
    }
    return out;
}

std::string row(const std::string& name, const Tally& t) {
    return fmt::format(
        "{:<12} {:>6} {:>6} {:>5} {:>6} {:>6} {:>5} {:>5} {:>5} {:>6} {:>5} {:>9} {:>9} {:>6} {:>6} "
        "{:>6} {:>6} {:>5} {:>8} {:>7.1f} {:>7.1f} {:>7.1f}\n",
        name, t.scenes, t.refused, t.stopped, t.proofs, t.tables, t.uncertified, t.missUnknown, t.vacuous,
        t.firesAtRest, t.verified, t.poses, t.contacts, t.missed, t.early, t.kernel, t.doubts, t.troubles,
        t.verifyRefused, t.bakeTook, t.verifyTook, t.attackTook);
}

} // namespace

void Tallies::add(const std::string& kind, const Trial& trial) {
    adversary::add(kinds_[kind], trial);
    adversary::add(all_, trial);
    if (!trial.refusal.empty() && !trial.stopped) ++refusals_[shortened(trial.refusal)];
    if (!trial.verifyRefusal.empty()) ++verifyRefusals_[shortened(trial.verifyRefusal)];
}

std::string Tallies::text() const {
    std::string text = fmt::format("{:<12} {:>6} {:>6} {:>5} {:>6} {:>6} {:>5} {:>5} {:>5} {:>6} {:>5} {:>9} "
                                   "{:>9} {:>6} {:>6} {:>6} {:>6} {:>5} "
                                   "{:>8} {:>7} {:>7} {:>7}\n",
                                   "kind", "scenes", "refus", "stop", "proofs", "tables", "uncrt", "miss?",
                                   ">90%", "atrest", "holds", "poses", "contacts", "missed", "early",
                                   "kernel", "doubts", "TRBL", "verifyno", "bake s", "verif s", "attck s");
    for (const auto& [kind, tally] : kinds_) text += row(kind, tally);
    text += row("all", all_);
    for (const auto& [what, times] : refusals_) text += fmt::format("  refused {} times: {}\n", times, what);
    for (const auto& [what, times] : verifyRefusals_)
        text += fmt::format("  verify {} times: {}\n", times, what);
    return text;
}

} // namespace adversary
