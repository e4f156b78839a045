#include "bake/pipeline/CheckBake.h"
#include "bake/scene/ValidateScene.h"
#include "bake/tool/Command.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace tss::tool {

namespace {

Json place(const LocatedError& error) {
    Json place = {{"message", error.message},
                  {"file", error.where.file},
                  {"pointer", error.where.pointer},
                  {"path", error.where.path}};
    if (error.position.line > 0) {
        place["line"] = error.position.line;
        place["column"] = error.position.column;
    }
    return place;
}

void validate(const std::string& file, Console& console) {
    std::vector<LocatedError> warnings;
    // A table that fits its meshes needs none to be made.
    const std::vector<LocatedError> errors = validateScene(file, &warnings, [](const SceneModel& scene) {
        BakeRequest request;
        request.onlyMissing = true;
        std::vector<InputError> refused = refusedByBake(scene, request);
        std::ranges::copy(unplayableMuscles(scene), std::back_inserter(refused));
        return refused;
    });
    Json result = {
        {"file", file}, {"valid", errors.empty()}, {"errors", Json::array()}, {"warnings", Json::array()}};
    for (const LocatedError& warning : warnings) {
        console.say(fmt::format("warning: {}", warning.text()));
        result["warnings"].push_back(place(warning));
    }
    for (const LocatedError& error : errors) {
        fmt::print(stderr, "{}\n", error.text());
        result["errors"].push_back(place(error));
    }
    console.say(errors.empty() ? file + ": good"
                               : fmt::format("{}: {} wrong", file, counted(errors.size(), "thing")));
    console.print(result);
    console.exitCode = errors.empty() ? 0 : 1;
}

} // namespace

void addValidate(CLI::App& app, Console& console) {
    CLI::App* command = addCommand(app, console, "validate",
                                   "everything wrong with a scene file, and what bake would refuse of it");
    auto file = std::make_shared<std::string>();
    command->add_option("scene", *file, "the scene file")->required();
    command->callback([file, &console] { validate(*file, console); });
}

} // namespace tss::tool
