#include "bake/base/Error.h"
#include "bake/base/Stopwatch.h"
#include "bake/check/VerifyPair.h"
#include "bake/check/VerifySkin.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/Command.h"
#include "bake/tool/DofSpec.h"
#include "bake/tool/Summary.h"
#include "bake/verify/Kernel.h"

#include <algorithm>
#include <fmt/format.h>
#include <sys/resource.h>

namespace tss::tool {

namespace {

/// The most memory that this process has held so far, MB.
double peakMemory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1000; // kilobytes, on Linux
}

/// Proves the rounding of the table's run-time kernel, with the instructions of every kind that this machine
/// has.
std::string kernelVerified(const Table& table, Json& json, const Progress& progress) {
    json["kernels"] = Json::array();
    const TriedPoses poses = posesToTry(table);
    for (const KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                      KernelTarget::Avx512, KernelTarget::Neon}) {
        if (!available(target)) continue;
        if (!report(progress, "kernels", 0)) return "stopped before all its kernels were looked at";
        PrepareOptions options;
        options.target = target;
        const PreparedTable prepared(table, options);
        const KernelVerdict kernel = verifyKernel(table, prepared, poses);
        json["kernels"].push_back({{"target", name(target)},
                                   {"form", name(prepared.form())},
                                   {"precision", name(prepared.precision())},
                                   {"band", prepared.signBand()},
                                   {"provenBand", kernel.early},
                                   {"provenGap", kernel.gapOff}});
        if (target == bestTarget()) json["kernel"] = json["kernels"].back();
        if (!kernel.proven) return fmt::format("its run-time kernel ({}): {}", name(target), kernel.reason);
    }
    return {};
}

BoundedShares boundedPart(const PairVerdict& verdict) {
    return boundedShares(verdict.meshes.exempt.shareA, verdict.meshes.exempt.shareB);
}

/// Proves a pair again; the figures go into `json`. Returns what does not hold, with the pose that breaks it.
std::string verified(const SceneModel& scene, const Pair& pair, Json& json, const Progress& progress) {
    const PairVerdict verdict = verifyPair(scene, pair, progress);
    json["spheresA"] = verdict.spheresA;
    json["spheresB"] = verdict.spheresB;
    json["cells"] = verdict.cells;
    json["band"] = verdict.band;
    json["notes"] = verdict.notes;
    json["boundedA"] = boundedPart(verdict).a;
    json["boundedB"] = boundedPart(verdict).b;
    json["exempt"] = {{"areaA", verdict.meshes.exempt.areaA},
                      {"areaB", verdict.meshes.exempt.areaB},
                      {"shareA", verdict.meshes.exempt.shareA},
                      {"shareB", verdict.meshes.exempt.shareB},
                      {"farthest", verdict.meshes.farthestExempt}};
    if (verdict.meshes.earlyBound) json["early"] = *verdict.meshes.earlyBound;
    if (verdict.reason.empty() && pair.table) return kernelVerified(*pair.table, json, progress);
    if (verdict.pose.empty()) return verdict.reason;
    json["pose"] = verdict.pose;
    const Motion motion = pairMotion(scene, pair);
    std::string pose;
    for (std::size_t k = 0; k < verdict.pose.size(); ++k)
        pose +=
            fmt::format("{}{:.9g}", k ? ", " : " at DOF values ", toUser(motion.dofs[k], verdict.pose[k]));
    return verdict.reason + pose;
}

/// The seconds that one pair or skin may take; 0: any.
class Budget {
public:
    explicit Budget(double seconds) : seconds_(seconds) {}

    double spent() const { return watch_.seconds(); }
    /// A Progress that asks to stop once the budget is spent. Must not be used after this object is gone.
    Progress within(Progress told) {
        return [this, told = std::move(told)](std::string_view step, double done) {
            stopped_ = stopped_ || (seconds_ > 0 && spent() >= seconds_);
            return report(told, step, done) && !stopped_;
        };
    }
    bool stopped() const { return stopped_; } ///< whether that Progress has asked to stop
    std::string ended() const { return fmt::format("not decided within {:.6g} s", seconds_); }

private:
    double seconds_;
    bool stopped_ = false;
    Stopwatch watch_;
};

/// What is claimed of a pair, in a few words.
std::string claims(const Pair& pair, double metersPerUnit) {
    if (pair.proof)
        return fmt::format("the meshes stay more than {} apart",
                           lengthText(pair.proof->clearance, metersPerUnit));
    std::string text;
    const Table& table = *pair.table;
    if (table.boundMiss)
        text += *table.boundMiss > 0
                    ? fmt::format("no contact of the meshes missed once a test is {} deep", // as counted
                                  lengthText(*table.boundMiss, metersPerUnit))
                    : std::string("no contact of the meshes missed");
    if (table.boundEarly)
        text += fmt::format("{}reported no earlier than {} apart", text.empty() ? "" : ", ",
                            lengthText(*table.boundEarly, metersPerUnit));
    return text.empty() ? "nothing is claimed" : text;
}

const RestRegion& exemptParts(const Pair& pair) {
    return pair.proof ? pair.proof->restRegion : pair.table->restRegion;
}

/// Of how much of the two bodies the claims hold, then the claims.
std::string holding(const Pair& pair, const Json& json, double metersPerUnit) {
    const BoundedShares bounded{json["boundedA"].get<double>(), json["boundedB"].get<double>()};
    if (bounded.none()) return "nothing is proven: all of A and of B is exempt";
    if (exemptParts(pair).empty()) return "holds at every pose: " + claims(pair, metersPerUnit);
    return "holds for " + boundedText(bounded) + " at every pose: " + claims(pair, metersPerUnit);
}

/// Says what came of a pair or skin: `good` and the notes, or why it does not hold. Returns whether it does.
bool tell(const std::string& file, const std::string& path, const std::string& why, const std::string& good,
          const std::vector<std::string>& notes, const Console& console) {
    if (!why.empty()) {
        fmt::print(stderr, "{} (<{}>): {}\n", file, path, why);
        return false;
    }
    console.say(fmt::format("{}: {}", path, good));
    for (const std::string& note : notes) console.say("  " + note);
    return true;
}

/// Reports one pair; whether it holds.
bool verifyOne(const std::string& file, const SceneModel& scene, const Pair& pair, Json& result,
               Console& console, Budget budget) {
    Json json = {{"path", pair.path}};
    const Progress progress = budget.within(console.progress());
    std::string why = inFile(file, [&] { return verified(scene, pair, json, progress); });
    const double seconds = budget.spent();
    // A counterexample decides, even one found after the budget was spent.
    const bool decided = why.empty() || !budget.stopped() || json.contains("pose");
    if (!decided) why = budget.ended();
    json["holds"] = why.empty();
    json["decided"] = decided;
    json["reason"] = why;
    json["seconds"] = seconds;
    json["peakMegabytes"] = peakMemory();
    std::string good;
    if (why.empty())
        good =
            fmt::format("{} ({} cells, rounding band {}, {:.3g} s, {:.3g} MB)",
                        holding(pair, json, scene.metersPerUnit), json["cells"].dump(),
                        lengthText(json["band"].get<double>(), scene.metersPerUnit), seconds, peakMemory());
    result["pairs"].push_back(json);
    return tell(file, pair.path, why, good, json["notes"], console);
}

/// Looks at one skin again; whether nothing was found.
bool verifyOne(const std::string& file, const SceneModel& scene, const SkinModel& skin, Json& result,
               Console& console, Budget budget) {
    SkinVerdict verdict;
    std::string thrown = inFile(file, [&] {
        verdict = verifySkin(scene, skin, budget.within(console.progress()));
        return verdict.reason;
    });
    if (!thrown.empty() && budget.stopped()) thrown = budget.ended();
    result["skins"].push_back({{"path", skin.path},
                               {"checked", thrown.empty()},
                               {"proven", false},
                               {"reason", thrown},
                               {"notes", verdict.notes},
                               {"states", verdict.states},
                               {"late", verdict.late},
                               {"lateAtRest", verdict.lateAtRest}});
    return tell(file, skin.path, thrown, "checked, not proven", verdict.notes, console);
}

/// How many pairs hold, and of how many of these parts are exempt.
std::string tally(const Json& pairs) {
    const auto count = [&](const auto& is) { return std::ranges::count_if(pairs, is); };
    const auto holds = [](const Json& pair) { return pair["holds"].get<bool>(); };
    const auto ofAll = [](const Json& pair) { return pair["boundedA"] == 1 && pair["boundedB"] == 1; };
    std::string text =
        fmt::format("{}: {} hold, {} do not, {} not decided", counted(pairs.size(), "pair"), count(holds),
                    count([&](const Json& pair) { return pair["decided"].get<bool>() && !holds(pair); }),
                    count([](const Json& pair) { return !pair["decided"].get<bool>(); }));
    if (const auto parts = count([&](const Json& pair) { return holds(pair) && !ofAll(pair); }))
        text += fmt::format("; {} of those that hold for a part of the surfaces alone", parts);
    return text;
}

/// Whether each pair holds, for more than nothing.
bool allProven(const Json& pairs) {
    return !pairs.empty() && std::ranges::all_of(pairs, [](const Json& pair) {
        return pair["holds"].get<bool>() && (pair["boundedA"] > 0 || pair["boundedB"] > 0);
    });
}

void verify(const std::string& file, double budget, Console& console) {
    const SceneModel scene = loadScene(file);
    Json result = {{"file", file}, {"pairs", Json::array()}, {"skins", Json::array()}};
    int bad = 0;
    for (const Pair& pair : scene.pairs) {
        if (!pair.table && !pair.proof) continue;
        bad += !verifyOne(file, scene, pair, result, console, Budget(budget));
    }
    for (const SkinModel& skin : scene.skins)
        if (skin.table) bad += !verifyOne(file, scene, skin, result, console, Budget(budget));
    if (result["pairs"].empty() && result["skins"].empty())
        throw InputError(Where{file}, "nothing to verify; expected a scene with a baked pair or skin");
    if (result["pairs"].size() > 1) console.say(tally(result["pairs"]));
    result["notBaked"] = scene.pairs.size() - result["pairs"].size();
    if (result["notBaked"] > 0)
        console.say(fmt::format("of {} more nothing is known: not baked yet",
                                counted(result["notBaked"].get<std::size_t>(), "pair")));
    if (result["pairs"].empty())
        console.say(fmt::format("nothing is proven: {} looked at, and no pair of rigid bodies has a table",
                                counted(result["skins"].size(), "skin")));
    result["holds"] = bad == 0;
    result["proven"] = bad == 0 && allProven(result["pairs"]);
    console.print(result);
    console.exitCode = bad == 0 ? 0 : 1;
}

} // namespace

void addVerify(CLI::App& app, Console& console) {
    CLI::App* command =
        addCommand(app, console, "verify", "proves the stored bounds again, with code of its own");
    auto file = std::make_shared<std::string>();
    auto budget = std::make_shared<double>(0);
    command->add_option("scene", *file, "a baked scene")->required();
    command
        ->add_option(
            "--budget", *budget,
            "seconds a pair or skin, after which it is not decided; 0 (default): as long as it takes")
        ->check(CLI::NonNegativeNumber);
    command->footer(
        "Proven from the file and the meshes alone, at every pose of the limits: that some test "
        "reports where the\n"
        "meshes meet (miss); that where a test reports they are as near as stated (early); that "
        "meshes said to\n"
        "never collide stay as far apart as stated; that each kind of run-time kernel that this "
        "machine has rounds\n"
        "within its band; that no stored sphere sticks out farther than is said of its body. "
        "Counts, the least number\n"
        "of tests and what is said of spheres that the file does not hold are not proven, and "
        "refused where the table\n"
        "contradicts them. A gap that a table states down to a depth is proven against spheres "
        "made again from the\n"
        "meshes. Of the tables of skins nothing is proven: what can be told of them at rest and "
        "of each muscle by\n"
        "itself is checked, and one that says it is certified is refused.\n"
        "Where parts overlap at rest, their contact with each other is exempt: what holds is then said of so "
        "much of\n"
        "each surface (boundedA, boundedB with --json).\n"
        "Exits with 0 where all hold, with 1 where one does not or is not decided.\n" +
        app.get_footer());
    command->callback([file, budget, &console] { verify(*file, *budget, console); });
}

} // namespace tss::tool
