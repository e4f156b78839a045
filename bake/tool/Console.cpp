#include "bake/tool/Command.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/geometry/Import.h"
#include "bake/model/SourceHash.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <unistd.h>

namespace tss::tool {

void Console::say(const std::string& text) const {
    if (!quiet) answer(text);
}

void Console::answer(const std::string& text) const {
    std::FILE* out = json ? stderr : stdout;
    fmt::print(out, "{}\n", text);
    std::fflush(out); // to a file too, in order with what goes to stderr: the next line may take an hour
}

void Console::print(const Json& result) const {
    // Names of files may be no UTF-8.
    if (json) fmt::print("{}\n", result.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Progress Console::progress() const {
    if (quiet || !isatty(STDERR_FILENO)) return {};
    return [last = std::make_shared<std::string>()](std::string_view step, double done) {
        constexpr int width = 30;
        const int filled = static_cast<int>(width * (done < 0 ? 0 : done > 1 ? 1 : done));
        const std::string line = fmt::format("\r{:<36.36} [{:=<{}}{:<{}}] {:3.0f} %", step, "", filled, "",
                                             width - filled, 100 * done);
        if (line == *last) return true;
        *last = line;
        fmt::print(stderr, "{}{}", line, done >= 1 ? "\r\033[K" : "");
        return true;
    };
}

std::string fileExtension(const std::string& file) {
    return std::filesystem::path(file).extension().string();
}

bool isMeshName(const std::string& file) {
    const auto meshes = {".obj", ".stl", ".ply", ".off", ".dae", ".fbx", ".gltf", ".glb", ".3ds"};
    return std::ranges::find(meshes, extensionOf(file)) != meshes.end();
}

void refuseOverwriting(const std::string& output, std::initializer_list<std::string> inputs) {
    for (const std::string& input : inputs) {
        std::error_code none;
        if (std::filesystem::equivalent(output, input, none))
            throw InputError(Where{output}, "is read here; expected another name for the output");
    }
}

void expectScene(const std::string& output) {
    if (!output.ends_with(".tss"))
        throw InputError(Where{output},
                         "is no name of a scene; expected one that ends in .tss, such as jaw.tss");
    expectWritable(output);
}

void expectText(const std::string& output) {
    const std::string extension = fileExtension(output);
    if (isMeshName(output) || extension == ".tss" || extension == ".usda" || extension == ".urdf" ||
        extension == ".xml")
        throw InputError(Where{output},
                         "is the name of a scene, a robot or a mesh; expected one such as out.csv");
    expectWritable(output);
}

const Pair& chooseFreshPair(const SceneModel& scene, const std::string& path, const std::string& file) {
    std::string known;
    for (const Pair& pair : scene.pairs) {
        if (pair.path == path || (path.empty() && scene.pairs.size() == 1)) {
            requireFresh(scene, pair, file);
            return pair;
        }
        known += (known.empty() ? "" : ", ") + pair.path;
    }
    if (known.empty())
        throw InputError(Where{file, "", path}, "expected a pair of rigid bodies, the scene has none");
    if (findSkin(scene, path) >= 0)
        throw InputError(Where{file, "", path}, "is a skin; expected a pair, one of: " + known);
    throw InputError(Where{file, "", path}, "no such pair; expected --pair with one of: " + known);
}

CLI::App* addCommand(CLI::App& app, Console& console, const std::string& name,
                     const std::string& description) {
    CLI::App* command = app.add_subcommand(name, description);
    command->add_flag("--json", console.json, "one JSON object on stdout, everything else on stderr");
    command->add_flag("--quiet", console.quiet, "nothing but errors and what was asked for");
    return command;
}

} // namespace tss::tool
