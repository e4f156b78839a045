#include "bake/base/Error.h"
#include "bake/model/SourceHash.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/Summary.h"

namespace tss::tool {

namespace {

/// Takes over the result of each pair or skin that `part` has and `scene` has not.
template <class Item>
void take(std::vector<Item>& into, const std::vector<Item>& from, const std::string& file) {
    if (into.size() != from.size()) throw InputError(Where{file}, "expected a part of the same scene");
    for (std::size_t k = 0; k < into.size(); ++k) {
        if (into[k].path != from[k].path)
            throw InputError(Where{file, "", from[k].path},
                             "expected a part of the same scene, with " + into[k].path);
        if (from[k].sourceHash.empty()) continue;
        if (!into[k].sourceHash.empty() && into[k].sourceHash != from[k].sourceHash)
            throw InputError(Where{file, "", from[k].path},
                             "was baked from something else than in the other parts");
        into[k] = from[k];
    }
}

/// What a part has made of its own scene is to be good for this one: its joints, limits and meshes are the
/// same.
template <class Item>
void expectFit(const SceneModel& scene, const std::vector<Item>& items, const SceneModel& part,
               const std::vector<Item>& its, const std::string& file) {
    for (std::size_t k = 0; k < items.size(); ++k) {
        if (its[k].sourceHash.empty() || !staleness(part, its[k]).empty()) continue;
        if (const std::string stale = staleness(scene, items[k]); !stale.empty())
            throw InputError(Where{file, "", its[k].path}, "was baked from another scene: " + stale);
    }
}

} // namespace

void addMerge(CLI::App& app, Console& console) {
    CLI::App* command = addCommand(app, console, "merge", "parts of one scene baked apart into one");
    auto parts = std::make_shared<std::vector<std::string>>();
    auto output = std::make_shared<std::string>();
    command->add_option("parts", *parts, "the same scene with different pairs baked")->required();
    command->add_option("-o,--output", *output, "the scene with all tables")->required();
    command->callback([parts, output, &console] {
        expectScene(*output);
        SceneModel scene = loadScene(parts->front());
        BakeTimes times = readBakeTimes(parts->front());
        for (std::size_t k = 1; k < parts->size(); ++k) {
            const SceneModel part = loadScene((*parts)[k]);
            take(scene.pairs, part.pairs, (*parts)[k]);
            take(scene.skins, part.skins, (*parts)[k]);
            expectFit(scene, scene.pairs, part, part.pairs, (*parts)[k]);
            expectFit(scene, scene.skins, part, part.skins, (*parts)[k]);
            times.merge(readBakeTimes((*parts)[k]));
        }
        saveScene(scene, *output);
        writeBakeTimes(*output, times);
        console.say("merged " + counted(parts->size(), "part") + " into " + *output);
        console.print({{"output", *output}, {"parts", parts->size()}});
    });
}

} // namespace tss::tool
