#include "bake/scene/SceneFile.h"
#include "bake/tool/Summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tss::tool {

void addInfo(CLI::App& app, Console& console) {
    CLI::App* command =
        addCommand(app, console, "info", "per pair: spheres, tests a step, bounds, bytes, bake time");
    auto file = std::make_shared<std::string>();
    command->add_option("scene", *file, "a scene, baked or not")->required();
    auto paths = std::make_shared<bool>(false);
    command->add_flag("--paths", *paths, "only the prim paths of the pairs and skins, one a line");
    command->callback([file, paths, &console] {
        if (*paths) {
            const SceneModel scene = loadScene(*file);
            std::vector<std::string> all;
            for (const Pair& pair : scene.pairs) all.push_back(pair.path);
            for (const SkinModel& skin : scene.skins) all.push_back(skin.path);
            if (!console.json && !all.empty()) console.answer(fmt::format("{}", fmt::join(all, "\n")));
            console.print({{"paths", all}});
            return;
        }
        Json result = summary(loadScene(*file));
        addTimes(result, readBakeTimes(*file));
        std::string text = describe(result);
        text.pop_back();
        if (!console.json) console.answer(text);
        console.print(result);
    });
}

} // namespace tss::tool
