#include "bake/geometry/Import.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <initializer_list>

using namespace tss;

#ifdef OSGTSS_IMPORT

namespace {

/// A glTF of one skinned triangle 0 0 0, 1 0 0, 0 1 0: its first two corners on joint 0, its third half on
/// joint 0 and half on joint 1. Its inverse bind matrices are a shift by -1 along x and none.
struct SkinnedTriangle {
    std::string name = std::string(OSGTSS_BINARY_DIR) + "/skin_places.gltf";
    std::string buffer = name + ".bin";

    /// nodes, skins: JSON of their elements. weights: the accessor's component type.
    SkinnedTriangle(const std::string& nodes, const std::string& skins, int weights = 5126) {
        std::string bytes;
        const auto add = [&](std::initializer_list<float> values) {
            for (const float value : values)
                bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
        };
        add({0, 0, 0, 1, 0, 0, 0, 1, 0});
        add({1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0});
        add({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
        add({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        for (int k = 0; k < 3; ++k) bytes.append("\0\1\0\0", 4);
        std::ofstream(buffer, std::ios::binary) << bytes;
        std::ofstream(name) << fmt::format(
            R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{}],"skins":[{}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"WEIGHTS_0":1,"JOINTS_0":3}}}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},
{{"bufferView":1,"componentType":{},"count":3,"type":"VEC4"}},
{{"bufferView":2,"componentType":5126,"count":2,"type":"MAT4"}},
{{"bufferView":3,"componentType":5121,"count":3,"type":"VEC4"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":48}},
{{"buffer":0,"byteOffset":84,"byteLength":128}},{{"buffer":0,"byteOffset":212,"byteLength":12}}],
"buffers":[{{"byteLength":{},"uri":"skin_places.gltf.bin"}}]}})",
            nodes, skins, weights, bytes.size());
    }
    ~SkinnedTriangle() {
        std::filesystem::remove(name);
        std::filesystem::remove(buffer);
    }
};

void checkVertices(const std::string& file, const std::vector<Vec3>& expected) {
    const TriangleMesh mesh = importMesh(file);
    REQUIRE(mesh.vertices.size() == expected.size());
    for (std::size_t v = 0; v < expected.size(); ++v) CHECK((mesh.vertices[v] - expected[v]).norm() < 1e-6);
}

} // namespace

TEST_CASE("a skinned mesh stands where its bones take it, with their scale and their way up") {
    // Half as large and turned by 90 degrees about x, as rigs are whose modeller has Z up.
    const std::string
        armature = R"({"children":[1,2,3],"scale":[0.5,0.5,0.5],"rotation":[0.70710678,0,0,0.70710678]},)",
        joints = R"({"name":"a","translation":[1,0,0]},{"name":"b"},)";
    SECTION("of its own node nothing counts") {
        const SkinnedTriangle file(armature + joints + R"({"mesh":0,"skin":0,"translation":[7,0,0]})",
                                   R"({"joints":[1,2],"inverseBindMatrices":2})");
        checkVertices(file.name, {{0, 0, 0}, {0.5, 0, 0}, {0, 0, 0.5}});
    }
    SECTION("a bone that is posed takes along what it carries, and half of what it half carries") {
        const SkinnedTriangle file(
            armature + R"({"name":"a","translation":[1,0,0]},{"name":"b","translation":[0,2,0]},)" +
                R"({"mesh":0,"skin":0})",
            R"({"joints":[1,2],"inverseBindMatrices":2})");
        checkVertices(file.name, {{0, 0, 0}, {0.5, 0, 0}, {0, 0, 1}});
    }
    SECTION("without inverse bind matrices these are identities") {
        const SkinnedTriangle file(armature + joints + R"({"mesh":0,"skin":0})", R"({"joints":[2,1]})");
        checkVertices(file.name, {{0, 0, 0}, {0.5, 0, 0}, {0.25, 0, 0.5}});
    }
    SECTION("joints without names, and of the same, are told apart") {
        for (const char* name : {"", R"("name":"bone",)"}) {
            const SkinnedTriangle file(
                armature +
                    fmt::format(R"({{{}"translation":[1,0,0]}},{{{}"translation":[0,2,0]}},)", name, name) +
                    R"({"mesh":0,"skin":0})",
                R"({"joints":[1,2],"inverseBindMatrices":2})");
            checkVertices(file.name, {{0, 0, 0}, {0.5, 0, 0}, {0, 0, 1}});
        }
    }
}

TEST_CASE("a mesh that two nodes share is skinned by each node's own skin") {
    const SkinnedTriangle file(
        R"({"children":[1,2,3,4,5]},{"name":"a"},{"name":"b"},{"name":"c","translation":[5,0,0]},)"
        R"({"mesh":0,"skin":0},{"mesh":0,"skin":1})",
        R"({"joints":[1,2]},{"joints":[3,3]})");
    checkVertices(file.name, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}});
}

TEST_CASE("a skin mirrored by its bones keeps its outside outside") {
    const SkinnedTriangle file(R"({"children":[1,2,3],"scale":[-1,1,1]},{"name":"a"},{"name":"b"},)"
                               R"({"mesh":0,"skin":0,"scale":[-1,1,1]})",
                               R"({"joints":[1,2]})");
    const TriangleMesh mesh = importMesh(file.name);
    const Tri& t = mesh.triangles.at(0);
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    CHECK((b - a).cross(c - a).z() > 0);
    CHECK(std::min({a.x(), b.x(), c.x()}) == Approx(-1));
}

TEST_CASE("an avatar in a VRM is read as the glTF that it is") {
    const SkinnedTriangle file(R"({"children":[1,2,3],"scale":[0.5,0.5,0.5]},{"name":"a"},{"name":"b"},)"
                               R"({"mesh":0,"skin":0})",
                               R"({"joints":[1,2]})");
    const std::string vrm = std::string(OSGTSS_BINARY_DIR) + "/skin_places.vrm";
    std::filesystem::copy_file(file.name, vrm, std::filesystem::copy_options::overwrite_existing);
    MeshFileNotes notes;
    CHECK(importMesh(vrm, &notes).vertices == std::vector<Vec3>{{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}});
    CHECK(notes.upAxis == 'Y');
    CHECK(notes.metersPerUnit == 1);
    std::filesystem::remove(file.buffer);
    CHECK_THROWS_WITH(importMesh(vrm), Catch::Contains(vrm + ": cannot be read as a mesh"));
    std::filesystem::remove(vrm);
}

TEST_CASE("where bones stand as a skin was bound, but for rounding, the numbers of its file stay") {
    const SkinnedTriangle file(
        R"({"children":[1,2,3]},{"name":"a","translation":[1.0000001,0,0]},{"name":"b"},)"
        R"({"mesh":0,"skin":0})",
        R"({"joints":[1,2],"inverseBindMatrices":2})");
    CHECK(importMesh(file.name).vertices == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST_CASE(
    "a skin that cannot be read is left out by its place in the file, and its mesh stands at its node") {
    const std::string nodes =
        R"({"children":[1,2,3]},{"name":"a"},{"name":"b"},{"mesh":0,"skin":0,"translation":[7,0,0]})";
    const auto leftOut = [&](const std::string& skins, int weights) {
        const SkinnedTriangle file(nodes, skins, weights);
        MeshFileNotes notes;
        CHECK(importMesh(file.name, &notes).vertices.at(0) == Vec3(7, 0, 0));
        return notes.leftOut.empty() ? "" : notes.leftOut.back();
    };
    CHECK(leftOut(R"({"joints":[1,9]})", 5126) == "/skins/0, which names a node that is not there");
    CHECK(leftOut(R"({"joints":[1,2]})", 5121) == "/skins/0, which has weights that are no floats");
    CHECK(leftOut(R"({"joints":[1,2],"inverseBindMatrices":0})", 5126) ==
          "/skins/0, which has no inverse bind matrix in floats for each of its joints");
    CHECK(leftOut("", 5126) == "/skins/0, which is not there");
}

TEST_CASE(
    "blend shapes are on as far as a glTF has them on where nothing is played, its node before its mesh") {
    const std::string name = std::string(OSGTSS_BINARY_DIR) + "/blend_shapes.gltf", buffer = name + ".bin";
    std::string bytes;
    for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f,  // a triangle
                              0.f, 0.f, 0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f,  // its second corner up
                              0.f, 0.f, 0.f, 0.f, 0.f, 0.f, 0.f, 0.f, 4.f}) // its third
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    std::ofstream(buffer, std::ios::binary) << bytes;
    const auto vertices = [&](const std::string& ofMesh, const std::string& nodes) {
        std::ofstream(name) << fmt::format(
            R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{{"POSITION":1}},{{"POSITION":2}}]}}]{}}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},
{{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"}},
{{"bufferView":2,"componentType":5126,"count":3,"type":"VEC3"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":36}},
{{"buffer":0,"byteOffset":72,"byteLength":36}}],"buffers":[{{"byteLength":108,"uri":"blend_shapes.gltf.bin"}}]}})",
            nodes, ofMesh);
        return importMesh(name).vertices;
    };
    const std::string one = R"({"mesh":0})";
    CHECK(vertices("", one) == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(vertices(R"(,"weights":[1,0.25])", one) == std::vector<Vec3>{{0, 0, 0}, {1, 0, 2}, {0, 1, 1}});
    // Of two nodes with one mesh each has its own.
    CHECK(vertices(R"(,"weights":[1,0.25])", R"({"mesh":0,"weights":[0,0.5],"children":[1]},{"mesh":0})") ==
          std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 2}, {1, 0, 2}, {0, 1, 1}}); // one corner in common
    std::filesystem::remove(name);
    std::filesystem::remove(buffer);
}

#endif
