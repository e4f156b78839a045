#include "bake/scene/ValidateScene.h"

#include "bake/base/AtomicFile.h"
#include "bake/model/SourceHash.h"
#include "bake/scene/PrimIndex.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/Schema.h"

namespace tss {

namespace {

/// Stale tables, and what `more` finds.
void addFaults(const SceneModel& scene, Problems& problems,
               const std::function<std::vector<InputError>(const SceneModel&)>& more) {
    const PrimIndex index(*scene.layer, problems);
    const auto add = [&](const std::string& path, const std::string& why) {
        const int entry = index.find(path);
        if (!why.empty()) problems.add(entry < 0 ? Place{"", path} : index.entries[entry].place, why);
    };
    MeshHashes meshes;
    for (const Pair& pair : scene.pairs) add(pair.path, staleness(scene, pair, &meshes));
    for (const SkinModel& skin : scene.skins) add(skin.path, staleness(scene, skin));
    if (!more) return;
    for (const InputError& error : more(scene)) add(error.where.path, error.message);
}

std::vector<LocatedError> located(const std::vector<InputError>& errors, std::string_view text) {
    if (errors.empty()) return {}; // then the text need not be gone through again
    std::vector<std::string> pointers;
    pointers.reserve(errors.size());
    for (const InputError& error : errors) pointers.push_back(error.where.pointer);
    std::vector<TextPosition> positions(errors.size());
    if (!text.empty() && !looksLikeCbor(text)) positions = locateJson(text, pointers);
    std::vector<LocatedError> all;
    for (std::size_t i = 0; i < errors.size(); ++i) all.emplace_back(errors[i], positions[i]);
    return all;
}

} // namespace

std::vector<LocatedError>
validateScene(const std::string& file, std::vector<LocatedError>* warnings,
              const std::function<std::vector<InputError>(const SceneModel&)>& more) {
    Problems problems(file, Problems::Mode::Collect);
    std::string text;
    try {
        text = readWholeFile(file);
        const auto layer = std::make_shared<const Layer>(parseLayer(text, file, problems));
        remarkTypos(*layer, problems);
        const SceneModel scene = readScene(layer, problems);
        if (problems.empty()) addFaults(scene, problems, more);
    } catch (const LocatedError& error) { // the text itself cannot be read on
        return {error};
    } catch (const InputError& error) {
        problems.errors.push_back(error);
    }
    if (warnings) *warnings = located(problems.warnings, text);
    return located(problems.errors, text);
}

} // namespace tss
