// The readers of robots: any bytes are a robot whose scene can be saved and read, or an InputError.
#include "bake/base/Error.h"
#include "bake/robot/ReadRobot.h"
#include "bake/robot/RobotScene.h"
#include "bake/scene/Layer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"

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

/// A file that may be included, and includes itself.
std::string other(const std::string& name) {
    if (name != "b.xml") throw InputError("no file " + name);
    return "<mujoco><body name='b'><geom size='1'/><joint range='0 1'/></body><include "
           "file='b.xml'/></mujoco>";
}

Robot read(const std::string& text) {
#ifdef OSGTSS_FUZZ_MJCF
    return readMjcf(text, "fuzz", other);
#else
    Robot robot = readUrdf(text, "fuzz");
    readSrdf(robot, text, "fuzz");
    static_cast<void>(other);
    return robot;
#endif
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const Robot robot = read(std::string(reinterpret_cast<const char*>(data), size));
        const FindMesh none = [](const std::string& name) -> std::string {
            throw InputError("no mesh " + name);
        };
        const RobotScene made = sceneOf(robot, {}, none);
        const SceneModel again = readScene(std::make_shared<const Layer>(layerOf(made.scene)), "fuzz");
        require(again.bodies.size() == made.scene.bodies.size(), "bodies are lost");
        require(again.joints.size() == made.scene.joints.size(), "joints are lost");
        require(again.pairs.size() == made.scene.pairs.size(), "pairs are lost");
    } catch (const InputError&) {
    }
    return 0;
}
