#pragma once
#include "bake/base/Error.h"
#include "bake/robot/RobotScene.h"
#include "bake/usd/Stage.h"
#include "bake/usd/UsdRobot.h"

#include <catch2/catch.hpp>
#include <functional>
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

/// What the work throws; empty when nothing.
inline std::string refusal(const std::function<void()>& work) {
    try {
        work();
    } catch (const tss::InputError& error) {
        return error.what();
    }
    return "";
}

inline std::string refusalOf(const std::string& body) {
    return refusal([&] { stageOf(body); });
}

inline bool hasNote(const std::vector<std::string>& notes, const std::string& words) {
    for (const std::string& note : notes)
        if (note.find(words) != std::string::npos) return true;
    return false;
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
