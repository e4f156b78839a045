#include "bake/scene/SceneFile.h"
#include "bake/tool/BakeTimes.h"
#include "bake/tool/Command.h"
#include "bake/tool/Summary.h"

namespace tss::tool {

void addInfo(CLI::App& app, Console& console) {
    CLI::App* command =
        addCommand(app, console, "info", "per pair: spheres, tests a step, bounds, bytes, bake time");
    auto file = std::make_shared<std::string>();
    command->add_option("scene", *file, "a scene, baked or not")->required();
    command->callback([file, &console] {
        Json result = summary(loadScene(*file));
        addTimes(result, readBakeTimes(*file));
        std::string text = describe(result);
        text.pop_back();
        console.say(text);
        console.print(result);
    });
}

} // namespace tss::tool
