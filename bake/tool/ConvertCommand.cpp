#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/geometry/Import.h"
#include "bake/model/AddPair.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/robot/PairEvidence.h"
#include "bake/robot/WritePairs.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/Transforms.h"
#include "bake/scene/WriteLayer.h"
#include "bake/scene/WriteUsda.h"
#include "bake/spheres/GenerateSpheres.h"
#include "bake/tool/Command.h"
#include "bake/tool/DofSpec.h"
#include "bake/tool/RobotInput.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <map>

namespace tss::tool {

namespace {

struct ConvertArguments {
    RobotFile robot; ///< of an input that is one
    std::string input, output;
    bool binary = false, buffers = false, filteredPairs = false;
    std::string unit = "1", tolerance;
    int maxSpheres = 0;
    std::vector<std::string> given; ///< options that stand on the command line
};

/// A scene of one body from a mesh file; of a glTF, a body a node.
Layer meshLayer(const ConvertArguments& arguments, std::vector<std::string>& notes) {
    SceneModel scene;
    scene.metersPerUnit = parseUnit(arguments.unit, "--meters-per-unit");
    const std::string stem = std::filesystem::path(arguments.input).stem().string();
    scene.defaultPrim = freePrimName(scene, stem);
    const auto add = [&](const std::string& name) -> Body& {
        Body& body = scene.bodies.emplace_back();
        body.path = "/" + scene.defaultPrim + "/" + freePrimName(scene, name);
        return body;
    };
    MeshFileNotes said;
    if (isGltf(arguments.input)) {
        for (ImportedNode& node : importNodes(arguments.input, &said)) {
            Body& body = add(node.name.empty() ? stem : node.name);
            const SplitXform place = tss::split({node.place, false});
            body.placement = place.placement;
            if (place.stretched)
                for (Vec3& v : node.mesh.vertices) v = place.stretch * v;
            if (place.stretch.determinant() < 0)
                for (Tri& t : node.mesh.triangles) std::swap(t[1], t[2]);
            body.mesh = std::move(node.mesh);
        }
    } else {
        TriangleMesh mesh = importMesh(arguments.input, &said);
        add(stem).mesh = std::move(mesh);
    }
    if (said.upAxis != '\0') scene.upAxis = said.upAxis;
    for (std::string& remark : remarks(arguments.input, said, scene.metersPerUnit))
        notes.push_back(std::move(remark));
    return layerOf(scene);
}

struct SpheresWritten {
    std::string text;
    std::size_t links = 0, spheres = 0;
    std::vector<std::string> notes;
};

/// collision_spheres as cuRobo's robot files have them: of each rigid body with a mesh, in its own frame, in
/// metres. The union of a link's spheres holds its whole surface, and they stick out of it by what its
/// comment says, both proven. Throws InputError for a mesh that cannot be filled so closely.
SpheresWritten curoboSpheresOf(const SceneModel& scene, const SphereOptions& options) {
    SpheresWritten written;
    written.text = "# Spheres of each link, in its frame and in metres. They hold the whole surface of its "
                   "mesh, proven.\n"
                   "collision_spheres:\n";
    const double metre = scene.metersPerUnit;
    constexpr double rounding = 1e-12; // of a product and of the digits written
    for (const Body& body : scene.bodies) {
        if (!body.rigid || body.mesh.empty()) continue;
        const std::string name = originalName(body);
        const SphereFit fit = fitSpheres(body.mesh, options);
        if (!std::isfinite(fit.protrusion) || fit.coverage > 0)
            throw InputError(Where{"", "", body.path}, "its mesh cannot be covered by spheres with a bound");
        if (!fit.note.empty()) written.notes.push_back(name + ": " + fit.note);
        written.text += fmt::format("  {}: # {}, out of the link by at most {:.4g} mm{}\n", inQuotes(name),
                                    counted(fit.spheres.size(), "sphere"), 1000 * metre * fit.protrusion,
                                    fit.hollow ? "; taken for its surface alone" : "");
        for (const Sphere& sphere : fit.spheres) {
            const Vec3 centre = metre * sphere.centre;
            const double radius = metre * sphere.radius, slack = rounding * (radius + centre.norm());
            written.text += fmt::format("    - \"center\": [{}, {}, {}]\n      \"radius\": {}\n", centre.x(),
                                        centre.y(), centre.z(), radius + slack);
        }
        ++written.links;
        written.spheres += fit.spheres.size();
    }
    if (written.links == 0) throw InputError("expected a rigid body with a mesh, found none");
    return written;
}

/// Spheres of each body for cuRobo.
void writeSpheresOf(const ConvertArguments& arguments, const Console& console) {
    if (fileExtension(arguments.input) != ".tss")
        throw InputError(Where{arguments.input}, "expected a scene, whose bodies get spheres");
    const SceneModel scene = loadScene(arguments.input);
    SphereOptions options;
    options.tolerance =
        parseLength(arguments.tolerance.empty() ? "1cm" : arguments.tolerance, scene.metersPerUnit);
    if (!(options.tolerance > 0)) throw InputError("--tolerance: expected a length above 0");
    options.maxSpheres = arguments.maxSpheres;
    const SpheresWritten written = inFile(arguments.input, [&] { return curoboSpheresOf(scene, options); });
    writeFileAtomically(arguments.output, written.text);
    for (const std::string& note : written.notes) console.say("note: " + note);
    console.say(fmt::format("wrote {}: {} of {}", arguments.output, counted(written.spheres, "sphere"),
                            counted(written.links, "link")));
    console.print({{"input", arguments.input},
                   {"output", arguments.output},
                   {"links", written.links},
                   {"spheres", written.spheres}});
}

/// What a planner or a simulator need not test, from the proofs of a baked scene.
void writePairsOf(const ConvertArguments& arguments, const Console& console) {
    if (fileExtension(arguments.input) != ".tss")
        throw InputError(Where{arguments.input}, "expected a baked scene, whose proofs are written");
    const SceneModel scene = loadScene(arguments.input);
    const auto evidence = inFile(arguments.input, [&] { return evidenceOf(scene); });
    const std::string source = std::filesystem::path(arguments.input).filename().string();
    const PairsWritten written = fileExtension(arguments.output) == ".srdf"
                                     ? srdfOf(scene, evidence, source)
                                     : mjcfExcludesOf(scene, evidence, source);
    writeFileAtomically(arguments.output, written.text);
    console.say(fmt::format("wrote {}: {} proven never to meet, {} adjacent, {} fixed and overlapping; left "
                            "on: {} that meet, {} open",
                            arguments.output, written.never, written.adjacent, written.always, written.meets,
                            written.open));
    console.print({{"input", arguments.input},
                   {"output", arguments.output},
                   {"never", written.never},
                   {"adjacent", written.adjacent},
                   {"always", written.always},
                   {"meets", written.meets},
                   {"open", written.open}});
}

Layer inputLayer(const ConvertArguments& arguments, std::vector<std::string>& notes) {
    if (isUsd(arguments.input) || isRobot(arguments.input)) {
        RobotFile file = arguments.robot;
        file.input = arguments.input;
        const RobotScene made = readRobotScene(file);
        notes = made.notes;
        return layerOf(made.scene);
    }
    if (fileExtension(arguments.input) != ".tss") return meshLayer(arguments, notes);
    if (!arguments.filteredPairs) return readLayer(arguments.input);
    const SceneModel scene = loadScene(arguments.input);
    return inFile(arguments.input, [&] { return withFilteredPairs(scene, evidenceOf(scene)); });
}

/// Throws for options that do nothing with these files.
void refuseIdleOptions(const ConvertArguments& arguments) {
    const std::string from = fileExtension(arguments.input), to = fileExtension(arguments.output);
    const bool usd = isUsd(arguments.input), robot = from != ".tss" && !usd && isRobot(arguments.input),
               mesh = from != ".tss" && !usd && !robot, spheres = to == ".yml" || to == ".yaml";
    struct Use {
        bool applies;
        const char* what;
    };
    const std::map<std::string, Use> uses = {
        {"--binary", {to == ".tss", "for a .tss to write"}},
        {"--buffers", {to == ".tss", "for a .tss to write"}},
        {"--filtered-pairs",
         {from == ".tss" && (to == ".tss" || to == ".usda"), "for a baked .tss to write as .usda or .tss"}},
        {"--meters-per-unit", {mesh, "for a mesh to read"}},
        {"--package", {robot, "for a robot's file to read"}},
        {"--srdf", {robot, "for a robot's file to read"}},
        {"--tolerance", {spheres, "for spheres to write, .yml"}},
        {"--max-spheres", {spheres, "for spheres to write, .yml"}}};
    for (const std::string& option : arguments.given)
        if (const auto use = uses.find(option); use != uses.end() && !use->second.applies)
            throw CLI::ValidationError(option,
                                       std::string("is ") + use->second.what + "; it does nothing here");
}

void convert(const ConvertArguments& arguments, const Console& console) {
    refuseIdleOptions(arguments);
    refuseOverwriting(arguments.output, {arguments.input});
    expectWritable(arguments.output);
    const std::string to = fileExtension(arguments.output);
    if (to == ".yml" || to == ".yaml") return writeSpheresOf(arguments, console);
    if (to == ".srdf" || to == ".xml") return writePairsOf(arguments, console);
    std::vector<std::string> notes;
    const Layer layer = inputLayer(arguments, notes);
    for (const std::string& note : notes) console.say("note: " + note);
    const Encoding encoding = arguments.binary ? Encoding::Cbor : Encoding::Json;
    Json result = {{"input", arguments.input}, {"output", arguments.output}, {"notes", notes}};
    if (to == ".usda")
        writeFileAtomically(arguments.output, writeUsda(layer));
    else if (to != ".tss")
        throw InputError(Where{arguments.output},
                         "expected a name that ends in .tss, .usda, .srdf, .xml or .yml");
    else if (arguments.buffers)
        result["buffer"] = saveWithBuffer(layer, arguments.output, encoding);
    else
        saveLayer(layer, arguments.output, encoding);
    console.say("wrote " + arguments.output);
    console.print(result);
}

} // namespace

void addConvert(CLI::App& app, Console& console) {
    CLI::App* command = addCommand(
        app, console, "convert",
        ".tss as JSON, binary .tss, .usda; proofs as SRDF or MJCF; robots and meshes become a scene");
    auto arguments = std::make_shared<ConvertArguments>();
    command
        ->add_option("input", arguments->input,
                     "a .tss, a .usda, a robot's URDF or MJCF, or any mesh that assimp reads")
        ->required();
    command
        ->add_option("output", arguments->output,
                     "a .tss or .usda; of a baked scene also an .srdf, or an .xml of MuJoCo's <exclude>s: "
                     "the pairs that are proven never to meet, and those that are joined; or a .yml of "
                     "cuRobo's collision spheres")
        ->required();
    command->add_flag("--binary", arguments->binary, "write the binary twin of .tss (CBOR)");
    command->add_flag("--buffers", arguments->buffers, "big arrays of a .tss into a file beside it");
    command->add_flag(
        "--filtered-pairs", arguments->filteredPairs,
        "of a baked scene: PhysicsFilteredPairsAPI for the pairs that are proven never to meet");
    addRobotFileOptions(*command, arguments->robot);
    command->add_option("--meters-per-unit", arguments->unit, "of a mesh: metres, or a length such as 1mm")
        ->capture_default_str();
    command->add_option("--tolerance", arguments->tolerance,
                        "of a .yml: how far a sphere may stick out of its link (1cm)");
    command
        ->add_option("--max-spheres", arguments->maxSpheres,
                     "of a .yml: at most so many a link, as close as that goes")
        ->check(CLI::Range(1, std::numeric_limits<int>::max()));
    command->callback([arguments, command, &console] {
        for (const CLI::Option* option : command->get_options())
            if (option->count() > 0) arguments->given.push_back(option->get_name());
        convert(*arguments, console);
    });
}

} // namespace tss::tool
