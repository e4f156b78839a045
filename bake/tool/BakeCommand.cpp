#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/base/Words.h"
#include "bake/check/EarlyContact.h"
#include "bake/pipeline/Bake.h"
#include "bake/pipeline/BakeTurns.h"
#include "bake/pipeline/CheckBake.h"
#include "bake/scene/AllPairs.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/FreeingAdvice.h"
#include "bake/tool/KeptParts.h"
#include "bake/tool/SceneMotion.h"
#include "bake/tool/Summary.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss::tool {

namespace {

struct BakeArguments {
    std::string input, output;
    BakeRequest request;
    int threads = 0;
    std::optional<double> budget; ///< seconds
    bool inscribed = false, keep = false, allPairs = false, pairsOnly = false, again = false, finer = false;
};

/// Adds the pairs of all bodies to the scene and says which; also what cannot be a pair.
Json addPairs(SceneModel& scene, const Console& console) {
    const AllPairs found = addAllPairs(scene);
    std::vector<std::string> notes;
    for (const AllPairs::Unmade& unmade : found.unmade) notes.push_back(unmade.note);
    for (const std::string& note : notes) console.say("no pair: " + note);
    console.say(
        fmt::format("{} added, {} in the scene", counted(found.added.size(), "pair"), scene.pairs.size()));
    return {{"added", found.added}, {"notes", notes}};
}

/// How many pairs never collide, overlap at rest, need a table of another kind.
std::string tally(const Json& pairs) {
    std::size_t never = 0, atRest = 0, others = 0, little = 0;
    for (const Json& pair : pairs) {
        if (!pair["baked"].get<bool>()) continue;
        if (!pair["restRegion"].is_null() || pair.value("overlapAtRest", 0) > 0) {
            ++atRest;
            little += !pair["boundedA"].is_null() && (pair["boundedA"] < 0.5 || pair["boundedB"] < 0.5);
        } else {
            ++(pair["neverCollides"].get<bool>() ? never : others);
        }
    }
    const std::string most =
        little ? fmt::format(" ({} with bounds for less than half of a body)", little) : "";
    return fmt::format("never collide: {}; {} overlap at rest{}, {} may meet\n", counted(never, "pair"),
                       atRest, most, others);
}

/// A tolerance so fine for the size of a body is mostly one in another unit, and takes hours.
void remarkTolerance(const SceneModel& scene, const BakeOptions& options, const Console& console) {
    constexpr double fine = 2e-5; // of a body's diagonal
    const double size = largestDiagonal(scene);
    if (options.tolerance && *options.tolerance < fine * size)
        console.say(fmt::format(
            "note: a tolerance of {} on a body of {} takes very many spheres; is the scene's unit {} m long?",
            lengthText(*options.tolerance, scene.metersPerUnit), lengthText(size, scene.metersPerUnit),
            scene.metersPerUnit));
}

/// Where some pairs and skins have tables that fit already: the paths of the others, which the bake goes on
/// with.
std::optional<std::vector<std::string>> missingOnly(const SceneModel& scene, const BakeArguments& arguments,
                                                    const Console& console) {
    if (arguments.again || !arguments.request.pairs.empty()) return std::nullopt;
    BakeRequest request = arguments.request;
    request.onlyMissing = true;
    const std::vector<std::string> missing = pathsToBake(scene, request);
    const std::size_t all = scene.pairs.size() + scene.skins.size(), there = all - missing.size();
    // Of what is all baked only what is too coarse is baked again by --finer.
    if (there == 0 || (missing.empty() && !arguments.finer)) return std::nullopt;
    console.say(
        missing.empty()
            ? fmt::format("all {} baked already: again those too coarse for their joint (--again: all)", all)
            : fmt::format("{} of {} baked already: going on with the others (--again: all)", there, all));
    return missing;
}

/// Throws for options that have no effect with the other settings of any pair or skin that is to be baked.
void refuseUnused(const SceneModel& scene, const BakeRequest& request) {
    const auto serves = [&](const auto& items, const auto& used) {
        return std::ranges::any_of(items, [&](const auto& item) {
            return isWanted(request, item.path) &&
                   used(optionsFor(item.settings, request.given, scene.metersPerUnit));
        });
    };
    const auto growth = [](const BakeOptions& o) { return o.spheres == SphereMethod::Growth; };
    const auto samples = [](const BakeOptions& o) {
        return o.search == SearchMethod::Sampled || o.reduce == ReduceMethod::Minimal;
    };
    if (request.given.contains("growth") && !serves(scene.pairs, growth) && !serves(scene.skins, growth))
        throw CLI::ValidationError("--growth", "does something with --spheres growth alone");
    if (request.given.contains("samples") && !serves(scene.pairs, samples))
        throw CLI::ValidationError("--samples",
                                   "does something with --search sampled or --reduce minimal alone");
}

void printError(const std::string& file, const InputError& error) {
    fmt::print(stderr, "tss: {} (<{}>): {}\n", file, error.where.path, error.message);
}

/// Prints all but the first of the things that bake() refuses; the first is what it throws.
void tellOtherRefusals(const SceneModel& scene, const BakeArguments& arguments) {
    const std::vector<InputError> refused = refusedByBake(scene, arguments.request);
    for (std::size_t k = 1; k < refused.size(); ++k) printError(arguments.input, refused[k]);
}

/// Says why, what is kept, and how to go on.
void endIncomplete(const BakeArguments& arguments, const KeptParts& parts, const std::string& written,
                   Console& console) {
    console.exitCode = parts.signal() ? 128 + parts.signal() : 1; // as shells have it
    if (written.empty() && !parts.failures().empty())
        return inFile(arguments.input, [&] { throw parts.failures().front(); });
    Json failures = Json::array();
    for (const InputError& error : parts.failures()) {
        failures.push_back({{"path", error.where.path}, {"message", error.message}});
        printError(arguments.input, error);
    }
    console.print({{"complete", false},
                   {"output", written},
                   {"missing", parts.missing()},
                   {"failures", failures},
                   {"notes", parts.notes()}});
    if (parts.signal()) fmt::print(stderr, "tss: interrupted\n");
    const bool late = arguments.request.until.comes() && parts.missing().size() > parts.failures().size();
    double budget = arguments.budget.value_or(0);
    if (late) fmt::print(stderr, "tss: the budget of {:g} s ended first\n", budget);
    if (late && !parts.bakedAny()) {
        budget *= 2;
        fmt::print(stderr,
                   "tss: nothing was baked in that time: expected a longer one, --budget {:g} or more\n",
                   budget);
    }
    const std::vector<std::string>& missing = parts.missing();
    constexpr std::size_t most = 8; // that are named; --json names all
    fmt::print(stderr, "tss: not baked: {}\n", firstOf(missing, most));
    if (!written.empty())
        fmt::print(stderr, "tss: what is done is in {}; go on with\n  tss bake {} -o {}{}\n", written,
                   shellWord(written), shellWord(arguments.output),
                   late ? fmt::format(" --budget {:g}", budget) : "");
}

/// Whether a joint has little room to move: the meshes touch at most poses, or at rest and at more than a
/// tenth of the others.
bool hasNoRoom(const Json& pair) {
    const Json early = pair.value("earlyContact", Json());
    if (early.is_null()) return false;
    if (!early["close"].get<bool>()) return early["touching"].get<bool>();
    return early["stuck"].get<bool>() || early["held"].get<bool>() ||
           10 * early["freePoses"].get<int>() < 9 * early["poses"].get<int>();
}

/// Bakes the pairs again whose spheres stick out too far for the clearance of their joint, each with the
/// tolerance that leaves most of it. Returns their paths.
std::vector<std::string> bakeFiner(SceneModel& scene, const BakeRequest& request, KeptParts& parts,
                                   const Console& console) {
    std::vector<std::string> again;
    for (const Pair& pair : scene.pairs) {
        if (!parts.complete() || request.until.over()) break;
        if (!isWanted(request, pair.path)) continue;
        const std::optional<EarlyContact> early = measureEarlyContact(scene, pair);
        if (!early || !early->coarse() || early->tolerance <= 0) continue;
        console.say(fmt::format("{}: contact reported at {:.0f} % of the poses where nothing touches: again, "
                                "with a tolerance of {}",
                                pair.path, 100 * early->share,
                                lengthText(early->tolerance, scene.metersPerUnit)));
        BakeRequest finer = request;
        finer.pairs = {pair.path};
        finer.onlyMissing = false;
        finer.given["tolerance"] = fmt::format("{}", early->tolerance);
        finer.given.erase("max-spheres");
        again.push_back(pair.path);
        parts.run(finer);
    }
    return again;
}

/// A summary with only the pairs and skins of these paths.
Json only(Json summary, const std::vector<std::string>& paths) {
    for (const char* kind : {"pairs", "skins"}) {
        Json kept = Json::array();
        for (Json& item : summary[kind])
            if (std::ranges::find(paths, item["path"].get<std::string>()) != paths.end())
                kept.push_back(std::move(item));
        summary[kind] = std::move(kept);
    }
    return summary;
}

/// Few pairs and skins are all wanted: each is baked to its end, and the budget is that of its search for
/// tests. Of many it is the time of the whole bake.
void setBudget(const SceneModel& scene, BakeArguments& arguments) {
    if (!arguments.budget) return;
    BakeRequest& request = arguments.request;
    const std::size_t count =
        request.pairs.empty() ? scene.pairs.size() + scene.skins.size() : request.pairs.size();
    if (*arguments.budget == 0 || count <= fewToBake)
        request.given["budget"] = fmt::format("{}", *arguments.budget);
    else
        request.until = Deadline(*arguments.budget);
}

void runBake(BakeArguments& arguments, Console& console) {
    if (arguments.inscribed) arguments.request.given["conservative"] = "false";
    if (arguments.keep) arguments.request.given["keep-spheres"] = "true";
    const ThreadLimit limit(arguments.threads);
    expectScene(arguments.output);
    if (arguments.pairsOnly && !(arguments.request.given.empty() && arguments.request.pairs.empty()))
        throw CLI::ValidationError("--pairs-only", "bakes nothing: settings and --pair do nothing beside it");
    SceneModel scene = loadScene(arguments.input);
    // Outside of inFile(): what is wrong with the options is no fault of the file.
    remarkTolerance(scene, optionsFor({}, arguments.request.given, scene.metersPerUnit), console);
    const Json pairs = arguments.allPairs ? addPairs(scene, console) : Json();
    setBudget(scene, arguments);
    refuseUnused(scene, arguments.request);
    KeptParts parts(scene, arguments.input, arguments.output, readBakeTimes(arguments.input), console);
    std::optional<std::vector<std::string>> now; // what is baked, where it is not all
    if (!arguments.pairsOnly) {
        now = missingOnly(scene, arguments, console);
        arguments.request.onlyMissing = now.has_value();
        tellOtherRefusals(scene, arguments);
        inFile(arguments.input, [&] {
            parts.run(arguments.request);
            if (!arguments.finer) return;
            for (const std::string& path : bakeFiner(scene, arguments.request, parts, console))
                if (now) now->push_back(path);
        });
    }
    const std::string written = parts.write();
    if (!parts.complete()) return endIncomplete(arguments, parts, written, console);

    Json result = summary(scene);
    addTimes(result, parts.times());
    if (!arguments.pairsOnly) addResiduals(result, scene);
    result["output"] = arguments.output;
    result["notes"] = parts.notes();
    if (arguments.allPairs) result["allPairs"] = pairs;
    const std::vector<std::string>& baked = now ? *now : arguments.request.pairs; // empty: all
    const std::string told = arguments.pairsOnly   ? "none is baked yet\n"
                             : now && now->empty() ? "nothing was baked\n"
                             : arguments.allPairs  ? describe(result) + tally(result["pairs"])
                                                   : describe(baked.empty() ? result : only(result, baked));
    console.say(told + "wrote " + arguments.output);
    const auto stuck = static_cast<std::size_t>(std::ranges::count_if(result["pairs"], hasNoRoom));
    for (std::size_t k = 0; k < scene.pairs.size() && !arguments.request.until.over(); ++k)
        if (hasNoRoom(result["pairs"][k]))
            result["pairs"][k]["freeingMoves"] = adviseMoves(scene, scene.pairs[k], stuck, console);
    console.print(result);
}

} // namespace

void addBake(CLI::App& app, Console& console) {
    CLI::App* command = addCommand(app, console, "bake", "makes the tables of a scene");
    auto arguments = std::make_shared<BakeArguments>();
    command->add_option("scene", arguments->input, "the scene to bake")->required();
    command->add_option("-o,--output", arguments->output, "the scene with its tables")->required();
    command
        ->add_option("--pair", arguments->request.pairs,
                     "prim path of a pair or a skin; repeat; default: all")
        ->allow_extra_args(false);
    CLI::Option* allPairs = command->add_flag(
        "--all-pairs", arguments->allPairs,
        "first make pairs of all bodies that joints link, neighbours and over chains of joints");
    command
        ->add_flag("--pairs-only", arguments->pairsOnly, "write the scene with those pairs and bake none yet")
        ->needs(allPairs);
    for (const BakeOption& option : bakeOptions()) {
        if (option.about.empty()) continue;
        command->add_option_function<std::string>(
            std::string("--") + option.name,
            [arguments, key = std::string(option.name)](const std::string& text) {
                arguments->request.given[key] = text;
            },
            option.about);
    }
    command
        ->add_option(
            "--budget", arguments->budget,
            "seconds, of up to eight pairs and skins for each to find its few tests, making its spheres "
            "not counted; of more that all of the bake may take: what matters most comes first, "
            "neighbours and what is near at rest; what is not reached is named. Where the few tests of "
            "a pair are not found, and always over more than six degrees of freedom, all tests that may "
            "touch are kept. 0: no limit. Default: about a minute of one core for the search of each "
            "pair")
        ->check(CLI::NonNegativeNumber);
    command->add_flag(
        "--no-conservative", arguments->inscribed,
        "inscribed spheres: nothing early where nothing stands inside the other, misses stated");
    command->add_flag("--keep-spheres", arguments->keep,
                      "store all generated spheres, not only the used ones");
    command->add_flag("--finer", arguments->finer,
                      "bake a pair whose spheres are too coarse for its joint's clearance again, with the "
                      "tolerance that info proposes");
    command->add_flag(
        "--again", arguments->again,
        "where some are baked already bake these too; a scene that is all baked is baked again anyway");
    command->add_option("--threads", arguments->threads, "worker threads (default: one a core)")
        ->check(CLI::Range(1, 1024));
    command->footer("Where not all can be baked, or Ctrl-C comes, what is done is in BAKED.incomplete.tss, "
                    "and baking that\n"
                    "goes on with what is missing.\n"
                    "Example:\n  tss bake jaw.tss -o jaw_baked.tss --tolerance 0.2mm\n" +
                    app.get_footer());
    command->callback([arguments, &console] { runBake(*arguments, console); });
}

} // namespace tss::tool
