#include "bake/base/Error.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/WriteLayer.h"
#include "bake/scene/WriteUsda.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

std::string sceneOf(const std::string& prims) {
    return R"({"format": "osgtss", "formatVersion": "1.0", "primChildren": [)" + prims + "]}";
}

SceneModel read(const std::string& prims) {
    return readScene(parseLayer(sceneOf(prims), "refs.tss"), "refs.tss");
}

std::string prim(const std::string& name, const std::string& references, const std::string& rest = "") {
    return R"({"name": ")" + name + R"(", "metadata": {"references": )" + references + "}" + rest + "}";
}

const std::string comma = ",";

/// A tooth and its root, as a class that is no body itself.
const std::string tooth = R"({"specifier": "class", "typeName": "Xform", "name": "Tooth",
  "metadata": {"apiSchemas": {"prepend": ["PhysicsRigidBodyAPI"]}},
  "properties": {"mine:root": {"targetPaths": ["/Tooth/Root", "/Elsewhere"]},
    "xformOp:translate": {"typeName": "double3", "default": [1, 2, 3]},
    "xformOpOrder": {"typeName": "token[]", "default": ["xformOp:translate"]}},
  "primChildren": [{"name": "Root", "typeName": "Mesh", "properties": {
    "points": {"typeName": "point3f[]", "default": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]},
    "doubleSided": {"typeName": "bool", "default": true},
    "faceVertexCounts": {"typeName": "int[]", "default": [3,3,3,3]},
    "faceVertexIndices": {"typeName": "int[]", "default": [0,2,1,0,1,3,0,3,2,1,2,3]}}}]})";

} // namespace

TEST_CASE("a prim takes type, properties and children of the prim that it references") {
    const SceneModel scene =
        read(tooth + comma + prim("Left", R"({"prepend": ["/Tooth"]})") + "," +
             prim("Right", R"(["/Tooth"])",
                  R"(, "properties": {"xformOp:translate": {"typeName": "double3", "default": [-1, 2, 3]}},
                "primChildren": [{"specifier": "over", "name": "Root", "properties": {
                  "doubleSided": {"typeName": "bool", "default": false}}},
                  {"specifier": "over", "name": "Nothing"}, {"name": "Filling", "typeName": "Mesh"}])"));
    REQUIRE(scene.bodies.size() == 5);
    const int left = findBody(scene, "/Left"), leftRoot = findBody(scene, "/Left/Root");
    const int right = findBody(scene, "/Right"), rightRoot = findBody(scene, "/Right/Root");
    REQUIRE(std::min({left, leftRoot, right, rightRoot, findBody(scene, "/Right/Filling")}) >= 0);
    CHECK(scene.bodies[left].rigid);
    CHECK(scene.bodies[left].placement.translation() == Vec3(1, 2, 3));
    CHECK(scene.bodies[right].placement.translation() == Vec3(-1, 2, 3)); // its own is stronger
    CHECK(scene.bodies[rightRoot].placement.translation() == Vec3(-1, 2, 3));
    CHECK(scene.bodies[leftRoot].mesh.triangles.size() == 4);
    CHECK(scene.bodies[leftRoot].doubleSided);
    CHECK_FALSE(scene.bodies[rightRoot].doubleSided);
}

TEST_CASE("references are kept when a scene is saved, and are written to .usda") {
    const Layer layer = parseLayer(sceneOf(tooth + comma + prim("Left", R"({"prepend": ["/Tooth"]})") + "," +
                                           prim("Right", R"(["/Tooth", "/Tooth/Root"])")),
                                   "");
    Layer instances = layer;
    findPrim(instances, "/Left")->metadata["instanceable"] = Value(true);
    CHECK(writeJson(layerOf(readScene(instances, ""))) == writeJson(instances));
    CHECK(parseLayer(writeCbor(instances), "") == instances);
    const std::string usda = writeUsda(instances);
    CHECK(usda.find("instanceable = true\n    prepend references = [</Tooth>]\n") != std::string::npos);
    CHECK(usda.find("    references = [</Tooth>, </Tooth/Root>]\n") != std::string::npos);
}

TEST_CASE("what stands below an instance does not count, as in USD") {
    const std::string left = R"({"name": "Left", "metadata": {"references": ["/Tooth"], "instanceable": true},
        "primChildren": [{"name": "Filling", "typeName": "Mesh"}]})";
    const SceneModel scene = read(tooth + "," + left);
    CHECK(findBody(scene, "/Left/Root") >= 0);
    CHECK(findBody(scene, "/Left/Filling") < 0);
}

TEST_CASE("references to references compose, and paths inside move along") {
    const std::string jaw = prim(
        "Jaw", "[]", R"(, "typeName": "Xform", "primChildren": [)" + prim("First", R"(["/Tooth"])") + "]");
    const SceneModel scene = read(tooth + "," + jaw + comma + prim("Copy", R"(["/Jaw"])") +
                                  R"(, {"name": "Hinge", "typeName": "PhysicsRevoluteJoint",
        "properties": {"physics:body0": {"targetPaths": ["/Copy/First"]}, "physics:body1": {"targetPaths": ["/Jaw/First"]}}})");
    CHECK(findBody(scene, "/Copy/First/Root") >= 0);
    REQUIRE(scene.joints.size() == 1);
    CHECK(scene.bodies[scene.joints[0].body0].path == "/Copy/First");

    // A joint of a class links the parts of each copy, not those of the class.
    const std::string chain = R"({"specifier": "class", "name": "Chain", "primChildren": [
        {"name": "A", "typeName": "Xform"}, {"name": "B", "typeName": "Xform"},
        {"name": "Hinge", "typeName": "PhysicsRevoluteJoint", "properties": {
          "physics:body0": {"targetPaths": {"prepend": ["/Chain/A"]}}, "physics:body1": {"targetPaths": ["/Chain/B"]}}}]})";
    const SceneModel copies =
        read(chain + comma + prim("One", R"(["/Chain"])") + comma + prim("Two", R"(["/Chain"])"));
    REQUIRE(copies.joints.size() == 2);
    CHECK(copies.bodies[copies.joints[1].body0].path == "/Two/A");
    CHECK(copies.bodies[copies.joints[1].body1].path == "/Two/B");
}

TEST_CASE("references that cannot be followed are refused") {
    const auto refused = [](const std::string& prims, const std::string& pointer, const std::string& says) {
        INFO(prims.substr(0, 300));
        try {
            read(prims);
            FAIL_CHECK("was accepted");
        } catch (const InputError& error) {
            CHECK(error.where.pointer == pointer);
            CHECK(error.where.file == "refs.tss");
            CHECK_THAT(error.message, Catch::Contains(says) && Catch::Contains("expected"));
        }
    };
    const std::string first = "/primChildren/0/metadata/references",
                      second = "/primChildren/1/metadata/references";
    refused(prim("A", R"(["/B"])"), first, "the path of a prim of this file, found \"/B\"");
    refused(prim("A", R"(["/A"])"), first, "lead back to this prim, found \"/A\"");
    refused(prim("A", R"(["/B"])") + comma + prim("B", R"(["/A"])"), second, "lead back");
    refused(prim("A", "[]", R"(, "primChildren": [)" + prim("In", R"(["/A"])") + "]") + comma +
                prim("B", R"(["/A"])"),
            "/primChildren/0/primChildren/0/metadata/references", "lead back");
    refused(prim("A", R"("/B")"), first, "an array of paths");
    refused(prim("A", R"(["B"])"), first + "/0", "an absolute path");
    refused(prim("A", R"(["@teeth.usd@</B>"])"), first + "/0", "an absolute path");
    refused(prim("A", R"({"prepend": [3]})"), first + "/prepend/0", "a string");
    refused(prim("A", R"({"insert": ["/B"]})"), first + "/insert",
            "expected prepend, append, delete or explicit");

    const std::string bodies =
        tooth + comma + prim("A", R"(["/Tooth"])") + comma + prim("B", R"(["/Tooth"])");
    refused(bodies + R"(, {"name": "P", "metadata": {"references": ["/Tooth"],
        "apiSchemas": {"prepend": ["TssPairAPI"]}}})",
            "/primChildren/3", "TssPairAPI on a prim without references");
    refused(R"({"specifier": "class", "name": "T", "typeName": "Mesh",
        "metadata": {"apiSchemas": {"prepend": ["TssSkinAPI"]}}},)" +
                prim("A", R"(["/T"])"),
            "/primChildren/1", "TssSkinAPI on a prim without references");

    std::string doubling = R"({"name": "P0", "typeName": "Xform"})"; // 2^40 prims
    for (int k = 1; k <= 40; ++k) {
        const std::string below = R"(["/P)" + std::to_string(k - 1) + R"("])";
        doubling +=
            comma + prim(std::string("P") + std::to_string(k), "[]",
                         R"(, "primChildren": [)" + prim("A", below) + comma + prim("B", below) + "]");
    }
    CHECK_THROWS_WITH(read(doubling), Catch::Contains("references that make at most 65536 prims"));
    std::string chain = prim("P0", "[]");
    for (int k = 1; k <= 70; ++k)
        chain +=
            comma + prim(std::string("P") + std::to_string(k), R"(["/P)" + std::to_string(k - 1) + R"("])");
    CHECK_THROWS_WITH(read(chain), Catch::Contains("at most 64 levels of references"));
}

TEST_CASE("validation goes on after a reference that cannot be followed") {
    Problems problems("refs.tss", Problems::Mode::Collect);
    const auto layer = std::make_shared<const Layer>(parseLayer(
        sceneOf(prim("A", R"(["/No", "/Neither"])") + "," + tooth + comma + prim("B", R"(["/Tooth"])")), ""));
    const SceneModel scene = readScene(layer, problems);
    CHECK(problems.errors.size() == 2);
    CHECK(findBody(scene, "/B/Root") >= 0);
}
