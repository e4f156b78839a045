#include "bake/geometry/Import.h"

#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

using namespace tss;

TEST_CASE("a binary glTF of version 1 has one chunk, and behind it numbers that are no chunk's length") {
    std::string json = R"({"scene": "s", "scenes": {"s": {"nodes": ["n"]}}, "nodes": {"n": {"meshes": ["m"]}},
        "meshes": {"m": {"primitives": [{"attributes": {"POSITION": "a"}, "mode": 4}]}},
        "accessors": {"a": {"bufferView": "v", "byteOffset": 0, "byteStride": 12, "componentType": 5126,
                            "count": 3, "type": "VEC3"}},
        "bufferViews": {"v": {"buffer": "binary_glTF", "byteOffset": 0, "byteLength": 36, "target": 34962}},
        "buffers": {"binary_glTF": {"byteLength": 36, "type": "arraybuffer", "uri": "data:,"}},
        "extensionsUsed": ["KHR_binary_glTF"], "asset": {"version": "1.0"}})";
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::array<float, 9> corners = {9, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::array<std::uint32_t, 5> header = {
        0x46546C67, 1, std::uint32_t(20 + json.size() + sizeof corners), std::uint32_t(json.size()), 0};
    const std::string bytes = std::string(reinterpret_cast<const char*>(header.data()), sizeof header) +
                              json +
                              std::string(reinterpret_cast<const char*>(corners.data()), sizeof corners);
    const std::string file = std::string(OSGTSS_BINARY_DIR) + "/import_old.glb";
    std::ofstream(file, std::ios::binary) << bytes;
    CHECK(importMesh(file).triangles.size() == 1);
    std::filesystem::remove(file);
}
