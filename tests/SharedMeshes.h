#pragma once
#include <filesystem>
#include <string>

#include <catch2/catch.hpp>

/// Path of a real mesh that is not part of this repository, e.g. sharedMesh("dog_jaw/skull.obj").
inline std::string sharedMesh(const std::string& name) {
    return std::string(OSGTSS_SHARED_MESHES) + "/" + name;
}

/// Ends the test case with a message where the real meshes are absent.
#define REQUIRE_SHARED_MESHES()                                                                              \
    if (!std::filesystem::exists(OSGTSS_SHARED_MESHES)) {                                                    \
        WARN("skipped, no meshes");                                                                          \
        return;                                                                                              \
    }
