#pragma once
#include "bake/usd/Stage.h"
#include "bake/usd/UsdRobot.h"
#include "tests/robot/Robots.h"

#include <map>

/// Files of a stage, by name; the first one is "root.usda".
using Files = std::map<std::string, std::string>;

inline tss::OpenUsd openIn(const Files& files) {
    return [files](const std::string& name) {
        const auto found = files.find(name);
        if (found == files.end()) return tss::UsdFile{"", "", "no such file"};
        return tss::UsdFile{name, found->second, ""};
    };
}

inline tss::UsdStage stageOf(const Files& files) {
    return tss::readStage(files.at("root.usda"), "root.usda", openIn(files));
}

/// A stage of one file, its first line left away.
inline tss::UsdStage stageOf(const std::string& body) {
    return stageOf(Files{{"root.usda", "#usda 1.0\n" + body}});
}

inline tss::RobotScene robotScene(const std::string& body) {
    const tss::UsdStage stage = stageOf(body);
    const tss::FindMesh none = [](const std::string& name) -> std::string { return name; };
    return tss::sceneOf(tss::robotOf(stageOf(body), "root.usda"), {}, none);
}

inline std::string refusalOf(const std::string& body) {
    return refusal([&] { stageOf(body); });
}

inline const tss::Prim& primAt(const tss::UsdStage& stage, const std::string& path) {
    const tss::Prim* prim = tss::findPrim(stage.layer, path);
    if (!prim) FAIL("no prim " << path);
    return *prim;
}

inline double numberAt(const tss::UsdStage& stage, const std::string& path, const std::string& property) {
    const tss::Property* found = primAt(stage, path).property(property);
    if (!found || !found->defaultValue) FAIL("no value " << path << "." << property);
    return *found->defaultValue->as<double>();
}

/// Two boxes of 2 at x = 0 and x = 4 and a joint between them.
inline std::string twoBoxes(const std::string& joint, const std::string& second = "") {
    return R"usda(( defaultPrim = "R"
 metersPerUnit = 0.01
 upAxis = "Z" )
def Xform "R" {
    def Xform "a" ( prepend apiSchemas = ["PhysicsRigidBodyAPI"] ) {
        def Cube "c" ( prepend apiSchemas = ["PhysicsCollisionAPI"] ) {}
    }
    def Xform "b" ( prepend apiSchemas = ["PhysicsRigidBodyAPI"] ) {
        double3 xformOp:translate = (4, 0, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        def Cube "c" ( prepend apiSchemas = ["PhysicsCollisionAPI"] ) {}
        )usda" +
           second + "}\n" + joint + "}\n";
}

inline const char* const hinge = R"usda(
    def PhysicsRevoluteJoint "j" {
        rel physics:body0 = </R/a>
        rel physics:body1 = </R/b>
        uniform token physics:axis = "Z"
        point3f physics:localPos0 = (2, 0, 0)
        point3f physics:localPos1 = (-2, 0, 0)
        float physics:lowerLimit = -30
        float physics:upperLimit = 90
    }
)usda";
