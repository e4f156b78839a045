#pragma once
#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"
#include "bake/robot/RobotScene.h"

#include <catch2/catch.hpp>
#include <functional>
#include <string>

/// What the work throws; empty when nothing.
inline std::string refusal(const std::function<void()>& work) {
    try {
        work();
    } catch (const tss::InputError& error) {
        return error.what();
    }
    return "";
}

inline std::string noMeshes(const std::string& name) {
    throw tss::InputError("no mesh " + name + " in this test");
}

inline const tss::Body& bodyCalled(const tss::SceneModel& scene, const std::string& name) {
    const int body = tss::findBody(scene, "/" + scene.defaultPrim + "/" + name);
    REQUIRE(body >= 0);
    return scene.bodies[body];
}

inline const tss::Joint& jointCalled(const tss::SceneModel& scene, const std::string& name) {
    for (const tss::Joint& joint : scene.joints)
        if (joint.path == "/" + scene.defaultPrim + "/" + name) return joint;
    FAIL("no joint " << name);
    return scene.joints.front();
}

inline bool hasNote(const std::vector<std::string>& notes, const std::string& words) {
    for (const std::string& note : notes)
        if (note.find(words) != std::string::npos) return true;
    return false;
}
