// The reader of USD: any bytes are a stage whose scene can be saved and read, or an InputError.
#include "bake/base/Error.h"
#include "bake/robot/RobotScene.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/WriteLayer.h"
#include "bake/scene/WriteUsda.h"
#include "bake/usd/Stage.h"
#include "bake/usd/UsdRobot.h"

#include <cstdlib>
#include <iostream>
#include <memory>

using namespace tss;

namespace {

void require(bool holds, const char* what) {
    if (holds) return;
    std::cerr << what << '\n';
    std::abort();
}

/// The bytes themselves under another name, and a layer that leads to both.
OpenUsd filesOf(const std::string& text) {
    return [&text](const std::string& name) {
        if (name == "a.usda") return UsdFile{name, text, ""};
        if (name == "outside.usda") throw InputError("lies outside");
        if (name != "b.usda") return UsdFile{"", "", "no such file"};
        return UsdFile{
            name,
            "#usda 1.0\n( subLayers = [@a.usda@] )\nclass \"B\" ( references = @b.usda@</B/C> ) { def "
            "Cube \"C\" ( prepend apiSchemas = [\"PhysicsRigidBodyAPI\"] ) {} }",
            ""};
    };
}

void checkOurs(const UsdStage& stage) {
    const SceneModel scene = readScene(stage.layer, "fuzz");
    const std::string text = writeUsda(stage.layer);
    const UsdStage again = readStage(text, "fuzz", filesOf(text));
    require(again.ours, "a scene of ours is none any more");
    const SceneModel same = readScene(again.layer, "fuzz");
    require(same.bodies.size() == scene.bodies.size(), "bodies are lost");
    require(same.joints.size() == scene.joints.size(), "joints are lost");
    require(same.pairs.size() == scene.pairs.size(), "pairs are lost");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        UsdStage stage = readStage(text, "fuzz", filesOf(text));
        if (stage.ours) {
            checkOurs(stage);
            return 0;
        }
        const FindMesh none = [](const std::string& name) -> std::string {
            throw InputError("no mesh " + name);
        };
        const RobotScene made = sceneOf(robotOf(std::move(stage), "fuzz"), {}, none);
        const SceneModel again = readScene(std::make_shared<const Layer>(layerOf(made.scene)), "fuzz");
        require(again.bodies.size() == made.scene.bodies.size(), "bodies are lost");
        require(again.joints.size() == made.scene.joints.size(), "joints are lost");
        require(again.pairs.size() == made.scene.pairs.size(), "pairs are lost");
    } catch (const InputError&) {
    }
    return 0;
}
