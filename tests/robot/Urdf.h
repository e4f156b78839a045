#pragma once
// URDF texts for tests: links, joints and robots of few words.
#include "bake/robot/ReadRobot.h"
#include "tests/robot/Robots.h"

namespace urdf {

using namespace tss;

const std::string box = "<collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision>";

inline std::string aLink(const std::string& name, const std::string& inside = box) {
    return "<link name='" + name + "'>" + inside + "</link>\n";
}

inline std::string aJoint(const std::string& name, const std::string& type, const std::string& parent,
                          const std::string& child, const std::string& inside) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" +
           child + "'/>" + inside + "</joint>\n";
}

inline std::string robotOf(const std::string& inside) {
    return "<?xml version='1.0'?>\n<robot name='arm'>\n" + inside + "</robot>\n";
}

const std::string limits = "<limit lower='-1' upper='2' effort='1' velocity='1'/>";

inline RobotScene madeOfUrdf(const std::string& text, const RobotSceneRequest& request = {}) {
    const FindMesh find = [](const std::string& name) { return name == "lost.stl" ? name : noMeshes(name); };
    return sceneOf(readUrdf(text, "arm.urdf"), request, find);
}

inline std::string refusedUrdf(const std::string& text) {
    return refusal([&] { madeOfUrdf(text); });
}

} // namespace urdf
