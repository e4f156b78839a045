#include "bake/tool/UsdInput.h"

#include "bake/base/Error.h"
#include "bake/scene/ReadScene.h"
#ifdef OSGTSS_HAVE_USDA
#include "bake/usd/Stage.h"
#include "bake/usd/UsdRobot.h"
#endif

#include <filesystem>

namespace tss::tool {

bool isUsd(const std::string& file) {
    const std::string extension = std::filesystem::path(file).extension().string();
    return extension == ".usda" || extension == ".usd" || extension == ".usdc" || extension == ".usdz";
}

#ifdef OSGTSS_HAVE_USDA

namespace {

RobotScene sceneOfOurs(const UsdStage& stage, const std::string& file) {
    RobotScene made;
    made.notes = stage.notes;
    try {
        made.scene = readScene(stage.layer, file);
    } catch (const InputError& error) { // a JSON pointer says nothing of a text that is none
        throw InputError(Where{error.where.file, "", error.where.path}, error.message);
    }
    for (const Body& body : made.scene.bodies) made.links.push_back({body.path, 1, false});
    return made;
}

} // namespace

RobotScene readUsdScene(const std::string& file, const Packages& packages, const RobotSceneRequest& request) {
    std::vector<std::string> folders;
    for (const auto& [name, folder] : packages)
        if (!folder.empty()) folders.push_back(folder);
    const OpenUsd open = besideUsd(file, folders);
    const std::string name = std::filesystem::path(file).filename().string();
    const UsdFile first = inFile(file, [&] { return open(name); });
    if (!first.missing.empty()) throw InputError(Where{file, "", ""}, first.missing);
    UsdStage stage = readStage(first.text, file, open);
    if (stage.ours) return sceneOfOurs(stage, file);
    const FindMesh none = [](const std::string& name) -> std::string { return name; };
    return sceneOf(robotOf(std::move(stage), file), request, none);
}

#else

RobotScene readUsdScene(const std::string& file, const Packages&, const RobotSceneRequest&) {
    throw InputError(Where{file, "", ""}, "this build reads no USD (OSGTSS_USDA is off)");
}

#endif

} // namespace tss::tool
