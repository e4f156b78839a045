#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/pipeline/Bake.h"
#include "bake/scene/AllPairs.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/BakeTimes.h"
#include "bake/tool/Command.h"
#include "bake/tool/Summary.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss::tool {

namespace {

struct BakeArguments {
    std::string input, output;
    BakeRequest request;
    int threads = 0;
    bool inscribed = false, keep = false, allPairs = false, pairsOnly = false;
};

/// Adds the pairs of all bodies to the scene and says which; also what cannot be a pair.
Json addPairs(SceneModel& scene, const Console& console) {
    const AllPairs found = addAllPairs(scene);
    for (const std::string& note : found.notes) console.say("no pair: " + note);
    console.say(
        fmt::format("{} added, {} in the scene", counted(found.added.size(), "pair"), scene.pairs.size()));
    return {{"added", found.added}, {"notes", found.notes}};
}

/// How many pairs never collide, overlap at rest, need a table of another kind.
std::string tally(const Json& pairs) {
    std::size_t never = 0, atRest = 0, others = 0;
    for (const Json& pair : pairs) {
        if (!pair["baked"].get<bool>()) continue;
        if (pair["neverCollides"].get<bool>())
            ++never;
        else if (!pair["restRegion"].is_null() || pair["overlapAtRest"].get<int>() > 0)
            ++atRest;
        else
            ++others;
    }
    return fmt::format("never collide: {}; {} of bodies that overlap at rest, {}\n", counted(never, "pair"),
                       counted(atRest, "table"), counted(others, "other table"));
}

/// A tolerance so fine for the size of a body is mostly one in another unit, and takes hours.
void remarkTolerance(const SceneModel& scene, const BakeOptions& options, const Console& console) {
    constexpr double fine = 2e-5; // of a body's diagonal
    double size = 0;
    for (const Body& body : scene.bodies)
        if (!body.mesh.vertices.empty()) size = std::max(size, bounds(body.mesh).diagonal().norm());
    if (options.tolerance && *options.tolerance < fine * size)
        console.say(
            fmt::format("note: a tolerance of {} on a body of {} takes very many spheres; is the scene's "
                        "unit {} m long?",
                        lengthText(*options.tolerance, scene.metersPerUnit),
                        lengthText(size, scene.metersPerUnit), scene.metersPerUnit));
}

void runBake(BakeArguments& arguments, const Console& console) {
    if (arguments.inscribed) arguments.request.given["conservative"] = "false";
    if (arguments.keep) arguments.request.given["keep-spheres"] = "true";
    const ThreadLimit limit(arguments.threads);
    expectFolder(arguments.output);
    SceneModel scene = loadScene(arguments.input);
    // What is wrong with them is no fault of the file.
    remarkTolerance(scene, optionsFor({}, arguments.request.given, scene.metersPerUnit), console);
    const Json pairs = arguments.allPairs ? addPairs(scene, console) : Json();
    std::vector<PairReport> reports;
    if (!arguments.pairsOnly)
        reports = inFile(arguments.input, [&] { return bake(scene, arguments.request, console.progress()); });
    saveScene(scene, arguments.output);

    BakeTimes times = readBakeTimes(arguments.input);
    Json notes = Json::object();
    for (const PairReport& report : reports) {
        times[report.path] = report.seconds;
        for (const std::string& note : report.notes) {
            console.say(report.path + ": " + note);
            notes[report.path].push_back(note);
        }
    }
    writeBakeTimes(arguments.output, times);
    Json result = summary(scene);
    addTimes(result, times);
    result["output"] = arguments.output;
    result["notes"] = notes;
    if (arguments.allPairs) result["allPairs"] = pairs;
    console.say(describe(result) + (arguments.allPairs ? tally(result["pairs"]) : "") + "wrote " +
                arguments.output);
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
    const std::pair<const char*, const char*> settings[] = {
        {"spheres", "medial (default), shrinking, growth or surface"},
        {"growth",
         "START,STEP,END,MAXRADIUS of --spheres growth: fractions of the bounding diagonal (default "
         "0.01,0.01,0.101,0.02) or lengths"},
        {"tolerance",
         "how far the spheres may stick out of the meshes (default: 1/500 of the smaller body's diagonal)"},
        {"epsilon", "gap that the table may add to that of all spheres; 0 (default): lossless"},
        {"depth", "the gap too is right down to this depth; 0 (default): yes or no only"},
        {"max-spheres", "at most so many spheres a body: the best tolerance for them"},
        {"reduce", "cover (default), cooccurrence, minimal or none"},
        {"search", "certified (default) or sampled"},
        {"samples", "poses explored by --search sampled"},
        {"at-rest", "the region in which the meshes overlap at rest: offset (default), ignore or collide"},
        {"budget", "seconds to find the few tests of each pair; making its spheres does not count"}};
    for (const auto& [name, description] : settings)
        command->add_option_function<std::string>(
            std::string("--") + name,
            [arguments, key = std::string(name)](const std::string& text) {
                arguments->request.given[key] = text;
            },
            description);
    command->add_flag("--no-conservative", arguments->inscribed,
                      "inscribed spheres: nothing early, misses stated");
    command->add_flag("--keep-spheres", arguments->keep,
                      "store all generated spheres, not only the used ones");
    command->add_option("--threads", arguments->threads, "worker threads (default: one a core)")
        ->check(CLI::Range(1, 1024));
    command->footer("Example:\n  tss bake jaw.tss -o jaw_baked.tss --tolerance 0.2mm");
    command->callback([arguments, &console] { runBake(*arguments, console); });
}

} // namespace tss::tool
