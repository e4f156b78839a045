#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/geometry/Import.h"
#include "bake/model/AddPair.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/WriteLayer.h"
#include "bake/scene/WriteUsda.h"
#include "bake/tool/Command.h"

#include <filesystem>

namespace tss::tool {

namespace {

struct ConvertArguments {
    std::string input, output;
    bool binary = false, buffers = false;
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

void convert(const ConvertArguments& arguments, const Console& console) {
    const Layer layer =
        extension(arguments.input) == ".tss" ? readLayer(arguments.input) : meshLayer(arguments);
    const Encoding encoding = arguments.binary ? Encoding::Cbor : Encoding::Json;
    Json result = {{"input", arguments.input}, {"output", arguments.output}};
    if (extension(arguments.output) == ".usda")
        writeFileAtomically(arguments.output, writeUsda(layer));
    else if (extension(arguments.output) == ".tss" && arguments.buffers)
        result["buffer"] = saveWithBuffer(layer, arguments.output, encoding);
    else if (extension(arguments.output) == ".tss")
        saveLayer(layer, arguments.output, encoding);
    else
        throw InputError(Where{arguments.output, "", ""}, "expected a name that ends in .tss or .usda");
    console.say("wrote " + arguments.output);
    console.print(result);
}

} // namespace

void addConvert(CLI::App& app, Console& console) {
    CLI::App* command =
        addCommand(app, console, "convert", ".tss as JSON, binary .tss, .usda; meshes become a .tss");
    auto arguments = std::make_shared<ConvertArguments>();
    command->add_option("input", arguments->input, "a .tss, or any mesh that assimp reads")->required();
    command->add_option("output", arguments->output, "a .tss or .usda")->required();
    command->add_flag("--binary", arguments->binary, "write the binary twin of .tss (CBOR)");
    command->add_flag("--buffers", arguments->buffers, "big arrays of a .tss into a file beside it");
    command->add_option("--meters-per-unit", arguments->metersPerUnit, "of a mesh")->capture_default_str();
    command->callback([arguments, &console] { convert(*arguments, console); });
}

} // namespace tss::tool
