#pragma once
#include "Playback.h"
#include "Scenes.h"

#include "bake/scene/SceneFile.h"

#include <catch2/catch.hpp>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>
#include <osgTSS/JointTransform>

#include <filesystem>

/// Files and plugins of this build.
namespace files {

/// A folder of this process's own, empty.
inline std::filesystem::path scratch() {
    const std::filesystem::path folder = std::filesystem::path(OSGTSS_BINARY_DIR) / "test-osgTSS";
    std::filesystem::create_directories(folder);
    return folder;
}

/// The plugins of this build, before those that are installed.
inline void usePlugins() {
    osgDB::FilePathList& paths = osgDB::Registry::instance()->getLibraryFilePathList();
    const std::string own = std::string(OSGTSS_BINARY_DIR) + "/lib";
    if (paths.empty() || paths.front() != own) paths.push_front(own);
}

inline osg::ref_ptr<osg::Node> load(const std::filesystem::path& file,
                                    const std::string& words = "clock=frame") {
    usePlugins();
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options(words);
    return osgDB::readRefNodeFile(file.string(), options);
}

inline std::filesystem::path saveHinge(bool withTable = true) {
    const auto file = scratch() / "hinge.tss";
    tss::saveScene(scenes::hinge(withTable), file.string());
    return file;
}

/// The arm's matrix to the world, frame by frame.
inline std::vector<osg::Matrixd> states(osg::Node& root) {
    auto* joint = find<osgTSS::JointTransform>(root, "Hinge");
    REQUIRE(joint);
    Playback playback;
    std::vector<osg::Matrixd> matrices;
    for (unsigned int frame = 0; frame < 30; ++frame) {
        playback.frame(root, frame);
        matrices.push_back(joint->getWorldMatrices().at(0));
    }
    return matrices;
}

} // namespace files
