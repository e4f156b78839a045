#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/geometry/Import.h"
#include "bake/model/AddPair.h"
#include "bake/robot/WritePairs.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/WriteLayer.h"
#include "bake/scene/WriteUsda.h"
#include "bake/tool/Command.h"

#include <filesystem>
#include <fmt/format.h>

namespace tss::tool {

namespace {

struct ConvertArguments {
    std::string input, output;
    bool binary = false, buffers = false, filteredPairs = false;
    double metersPerUnit = 1;
};

std::string extension(const std::string& file) {
    return std::filesystem::path(file).extension().string();
}

/// A scene of one body from a mesh file.
Layer meshLayer(const ConvertArguments& arguments) {
    SceneModel scene;
    scene.metersPerUnit = arguments.metersPerUnit;
    const std::string stem = std::filesystem::path(arguments.input).stem().string();
    scene.defaultPrim = freePrimName(scene, stem);
    Body body;
    body.path = "/" + scene.defaultPrim + "/" + freePrimName(scene, stem);
    body.mesh = importMesh(arguments.input);
    scene.bodies.push_back(body);
    return layerOf(scene);
}

/// What a planner or a simulator need not test, from the proofs of a baked scene.
void writePairsOf(const ConvertArguments& arguments, const Console& console) {
    if (extension(arguments.input) != ".tss")
        throw InputError(Where{arguments.input, "", ""}, "expected a baked scene, whose proofs are written");
    const SceneModel scene = loadScene(arguments.input);
    const auto evidence = inFile(arguments.input, [&] { return evidenceOf(scene); });
    const std::string source = std::filesystem::path(arguments.input).filename().string();
    const PairsWritten written = extension(arguments.output) == ".srdf"
                                     ? srdfOf(scene, evidence, source)
                                     : mjcfExcludesOf(scene, evidence, source);
    writeFileAtomically(arguments.output, written.text);
    console.say(fmt::format(
        "wrote {}: {} proven never to meet, {} adjacent, {} fixed and overlapping; left on: {} that "
        "meet, {} open",
        arguments.output, written.never, written.adjacent, written.always, written.meets, written.open));
    console.print({{"input", arguments.input},
                   {"output", arguments.output},
                   {"never", written.never},
                   {"adjacent", written.adjacent},
                   {"always", written.always},
                   {"meets", written.meets},
                   {"open", written.open}});
}

Layer inputLayer(const ConvertArguments& arguments) {
    if (extension(arguments.input) != ".tss") return meshLayer(arguments);
    if (!arguments.filteredPairs) return readLayer(arguments.input);
    const SceneModel scene = loadScene(arguments.input);
    return inFile(arguments.input, [&] { return withFilteredPairs(scene, evidenceOf(scene)); });
}

void convert(const ConvertArguments& arguments, const Console& console) {
    if (extension(arguments.output) == ".srdf" || extension(arguments.output) == ".xml")
        return writePairsOf(arguments, console);
    const Layer layer = inputLayer(arguments);
    const Encoding encoding = arguments.binary ? Encoding::Cbor : Encoding::Json;
    Json result = {{"input", arguments.input}, {"output", arguments.output}};
    if (extension(arguments.output) == ".usda")
        writeFileAtomically(arguments.output, writeUsda(layer));
    else if (extension(arguments.output) == ".tss" && arguments.buffers)
        result["buffer"] = saveWithBuffer(layer, arguments.output, encoding);
    else if (extension(arguments.output) == ".tss")
        saveLayer(layer, arguments.output, encoding);
    else
        throw InputError(Where{arguments.output, "", ""},
                         "expected a name that ends in .tss, .usda, .srdf or .xml");
    console.say("wrote " + arguments.output);
    console.print(result);
}

} // namespace

void addConvert(Options& app, Console& console) {
    Options* command =
        addCommand(app, console, "convert",
                   ".tss as JSON, binary .tss, .usda; proofs as SRDF or MJCF; meshes become a .tss");
    auto arguments = std::make_shared<ConvertArguments>();
    command->add_option("input", arguments->input, "a .tss, or any mesh that assimp reads")->required();
    command
        ->add_option(
            "output", arguments->output,
            "a .tss or .usda; of a baked scene also an .srdf, or an .xml of MuJoCo's <exclude>s: the pairs "
            "that are proven never to meet, and those that are joined")
        ->required();
    command->add_flag("--binary", arguments->binary, "write the binary twin of .tss (CBOR)");
    command->add_flag("--buffers", arguments->buffers, "big arrays of a .tss into a file beside it");
    command->add_flag(
        "--filtered-pairs", arguments->filteredPairs,
        "of a baked scene: PhysicsFilteredPairsAPI for the pairs that are proven never to meet");
    command->add_option("--meters-per-unit", arguments->metersPerUnit, "of a mesh")->capture_default_str();
    command->callback([arguments, &console] { convert(*arguments, console); });
}

} // namespace tss::tool
