#pragma once
#include "bake/robot/ReadRobot.h"
#include "tests/robot/Robots.h"

inline std::string modelOf(const std::string& inside) {
    return "<mujoco model='arm'>\n" + inside + "\n</mujoco>\n";
}

inline std::string world(const std::string& inside) {
    return "<worldbody>" + inside + "</worldbody>";
}

inline std::string noOthers(const std::string& name) {
    throw tss::InputError("no file " + name);
}

inline tss::RobotScene made(const std::string& text, const tss::ReadOther& others = noOthers) {
    return tss::sceneOf(tss::readMjcf(text, "arm.xml", others), {}, noMeshes);
}

inline std::string refused(const std::string& text, const tss::ReadOther& others = noOthers) {
    return refusal([&] { made(text, others); });
}
