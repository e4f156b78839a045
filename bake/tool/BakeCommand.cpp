#include "bake/Bake.h"
#include "bake/base/Parallel.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/BakeTimes.h"
#include "bake/tool/Command.h"
#include "bake/tool/Summary.h"

namespace tss::tool {

namespace {

struct BakeArguments {
    std::string input, output;
    BakeRequest request;
    int threads = 0;
    bool inscribed = false, keep = false;
};

void runBake(BakeArguments& arguments, const Console& console) {
    if (arguments.inscribed) arguments.request.given["conservative"] = "false";
    if (arguments.keep) arguments.request.given["keep-spheres"] = "true";
    const ThreadLimit limit(arguments.threads);
    SceneModel scene = loadScene(arguments.input);
    const std::vector<PairReport> reports = bake(scene, arguments.request, console.progress());
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
    console.say(describe(result) + "wrote " + arguments.output);
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
        ->expected(1);
    const std::pair<const char*, const char*> settings[] = {
        {"spheres", "medial (default), growth or surface"},
        {"tolerance", "how far the spheres may stick out of the meshes"},
        {"epsilon", "gap that the table may add to that of all spheres; 0 (default): lossless"},
        {"depth", "the gap too is right down to this depth; 0 (default): yes or no only"},
        {"max-spheres", "at most so many spheres a body: the best tolerance for them"},
        {"reduce", "cover (default), cooccurrence, minimal or none"},
        {"search", "certified (default) or sampled"},
        {"samples", "poses explored by --search sampled"},
        {"at-rest", "spheres that overlap at rest: offset (default), ignore or collide"},
        {"budget", "seconds for each pair's cover"}};
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
