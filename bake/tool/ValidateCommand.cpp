#include "bake/scene/SceneFile.h"
#include "bake/scene/SourceHash.h"
#include "bake/tool/Command.h"

#include <fmt/format.h>

namespace tss::tool {

namespace {

Json place(const InputError& error) {
    return {{"message", error.message},
            {"file", error.where.file},
            {"pointer", error.where.pointer},
            {"path", error.where.path}};
}

void validate(const std::string& file, Console& console) {
    std::vector<InputError> warnings;
    std::vector<InputError> errors = validateScene(file, &warnings);
    if (errors.empty()) {
        const SceneModel scene = loadScene(file);
        for (const Pair& pair : scene.pairs)
            if (const std::string why = staleness(scene, pair); !why.empty())
                errors.emplace_back(Where{file, "", pair.path}, why);
        for (const SkinModel& skin : scene.skins)
            if (const std::string why = staleness(scene, skin); !why.empty())
                errors.emplace_back(Where{file, "", skin.path}, why);
    }
    Json result = {
        {"file", file}, {"valid", errors.empty()}, {"errors", Json::array()}, {"warnings", Json::array()}};
    for (const InputError& warning : warnings) {
        console.say(fmt::format("warning: {}", warning.what()));
        result["warnings"].push_back(place(warning));
    }
    for (const InputError& error : errors) {
        fmt::print(stderr, "{}\n", error.what());
        result["errors"].push_back(place(error));
    }
    console.say(errors.empty() ? file + ": good" : fmt::format("{}: {} things wrong", file, errors.size()));
    console.print(result);
    console.exitCode = errors.empty() ? 0 : 1;
}

} // namespace

void addValidate(CLI::App& app, Console& console) {
    CLI::App* command = addCommand(app, console, "validate", "everything wrong with a scene file");
    auto file = std::make_shared<std::string>();
    command->add_option("scene", *file, "the scene file")->required();
    command->callback([file, &console] { validate(*file, console); });
}

} // namespace tss::tool
