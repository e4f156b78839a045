#include "bake/base/Error.h"
#include "bake/base/NearestFloat.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneLayer.h"

#include <catch2/catch.hpp>

#include <numbers>

using namespace tss;

namespace {

constexpr const char* triangle = R"("points": {"typeName": "point3f[]", "default": [[1,0,0],[0,1,0],[0,0,1]]},
    "faceVertexCounts": {"typeName": "int[]", "default": [3]},
    "faceVertexIndices": {"typeName": "int[]", "default": [0,1,2]})";

/// A mesh with these operations under a parent with those.
Body meshUnder(const std::string& parent, const std::string& own) {
    const auto properties = [](const std::string& xform) { return xform.empty() ? xform : xform + ", "; };
    const std::string text = R"({"format": "osgtss", "formatVersion": "1.0", "primChildren": [
        {"name": "P", "typeName": "Xform", "properties": {)" +
                             properties(parent) +
                             R"("x": {"typeName": "int", "default": 1}}, "primChildren": [
        {"name": "M", "typeName": "Mesh", "properties": {)" +
                             properties(own) + triangle + "}}]}]}";
    return readScene(parseLayer(text, "test.tss"), "test.tss").bodies.at(0);
}

std::string op(const std::string& order, const std::string& operations) {
    return R"("xformOpOrder": {"typeName": "token[]", "default": [)" + order + "]}, " + operations;
}

const std::string shift = R"("xformOp:translate": {"typeName": "double3", "default": [1, 2, 3]})";

/// Where the mesh's corners are in the world.
std::vector<Vec3> world(const Body& body) {
    std::vector<Vec3> points;
    for (const Vec3& vertex : body.mesh.vertices) points.push_back(body.placement * vertex);
    return points;
}

} // namespace

TEST_CASE("operations are applied from the last to the first, parents after children") {
    const Body body = meshUnder(op(R"("xformOp:translate")", shift),
                                op(R"("xformOp:translate", "xformOp:rotateZ")",
                                   shift + R"(, "xformOp:rotateZ": {"typeName": "float", "default": 90})"));
    CHECK((world(body)[0] - Vec3(2, 5, 6)).norm() < 1e-12); // (1,0,0) turned to (0,1,0), then shifted twice
    CHECK(body.mesh.vertices[0] == Vec3(1, 0, 0));
}

TEST_CASE("rotateXYZ turns about X first") {
    const Body body =
        meshUnder("", op(R"("xformOp:rotateXYZ")",
                         R"("xformOp:rotateXYZ": {"typeName": "float3", "default": [90, 0, 90]})"));
    CHECK((world(body)[1] - Vec3(0, 0, 1)).norm() < 1e-12); // y -> z by X, z stays by Z
    CHECK((world(body)[0] - Vec3(0, 1, 0)).norm() < 1e-12);
}

TEST_CASE("an operation may be upon one axis alone, and be inverted") {
    const auto along = [](const std::string& name, const std::string& type, double value) {
        return "\"xformOp:" + name + "\": {\"typeName\": \"" + type +
               "\", \"default\": " + std::to_string(value) + "}";
    };
    const auto corner = [&](const std::string& order, const std::string& operations) {
        return world(meshUnder("", op(order, operations)))[0]; // (1, 0, 0)
    };
    CHECK((corner(R"("xformOp:translateX", "xformOp:translateY:pivot", "xformOp:translateZ")",
                  along("translateX", "double", 1) + ", " + along("translateY:pivot", "float", 2) + ", " +
                      along("translateZ", "half", 3)) -
           Vec3(2, 2, 3))
              .norm() < 1e-12);
    CHECK((corner(R"("xformOp:scaleX", "!invert!xformOp:scaleX:twice", "xformOp:scaleY")",
                  along("scaleX", "float", 3) + ", " + along("scaleX:twice", "double", 2) + ", " +
                      along("scaleY", "float", 7)) -
           Vec3(1.5, 0, 0))
              .norm() < 1e-7);
    CHECK_THROWS_WITH(corner(R"("xformOp:scaleZ")", along("scaleZ", "float", 0)),
                      Catch::Contains("scales that are not 0"));
    for (const char* none : {"translateXY", "rotate", "rotateXX", "scaleW"})
        CHECK_THROWS_WITH(corner("\"xformOp:" + std::string(none) + "\"", along(none, "float", 1)),
                          Catch::Contains("expected translate..., orient, rotate..., scale... or transform"));
}

TEST_CASE("points that a scale moves are floats, as those of files: what is hashed is what was baked") {
    const Body body =
        meshUnder("", op(R"("xformOp:scale")",
                         R"("xformOp:scale": {"typeName": "double3", "default": [1.1, -0.7, 1.3]})"));
    for (const Vec3& vertex : world(body))
        for (const double coordinate : vertex) CHECK(isFloat(coordinate));
    CHECK((world(body)[0] - Vec3(1.1, 0, 0)).norm() < 1e-7);
}

TEST_CASE("a matrix is row by row, with the translation in its last row") {
    const Body body = meshUnder(
        "",
        op(R"("xformOp:transform")",
           R"("xformOp:transform": {"typeName": "matrix4d", "default": [[0,1,0,0],[-1,0,0,0],[0,0,1,0],[5,6,7,1]]})"));
    CHECK((world(body)[0] - Vec3(5, 7, 7)).norm() < 1e-12);
    CHECK(body.mesh.vertices[0] == Vec3(1, 0, 0));
}

TEST_CASE("scale goes into the points and leaves a rigid placement") {
    const Body body = meshUnder(
        op(R"("xformOp:scale")", R"("xformOp:scale": {"typeName": "float3", "default": [2, 3, 4]})"),
        op(R"("xformOp:translate", "xformOp:rotateZ")",
           shift + R"(, "xformOp:rotateZ": {"typeName": "float", "default": 90})"));
    CHECK(
        (body.placement.linear().transpose() * body.placement.linear() - Eigen::Matrix3d::Identity()).norm() <
        1e-12);
    CHECK((world(body)[0] - Vec3(2, 9, 12)).norm() < 1e-12);
    CHECK((world(body)[1] - Vec3(0, 6, 12)).norm() < 1e-12);
}

TEST_CASE("a mirror keeps the outside outside") {
    const Body body = meshUnder(
        "", op(R"("xformOp:scale")", R"("xformOp:scale": {"typeName": "float3", "default": [-1, 1, 1]})"));
    CHECK(body.placement.linear().determinant() == Approx(1));
    const auto corner = world(body);
    CHECK((corner[0] - Vec3(-1, 0, 0)).norm() < 1e-12);
    const Tri t = body.mesh.triangles[0];
    const Vec3 normal = (corner[t[1]] - corner[t[0]]).cross(corner[t[2]] - corner[t[0]]);
    CHECK(normal.dot(Vec3(-1, 1, 1)) > 0);
}

TEST_CASE("inverted operations and a stack that begins anew") {
    const Body body = meshUnder(op(R"("xformOp:translate")", shift),
                                op(R"("!resetXformStack!", "!invert!xformOp:translate")", shift));
    CHECK((world(body)[0] - Vec3(0, -2, -3)).norm() < 1e-12);
}

TEST_CASE("of animated operations the first sample counts where there is no default") {
    const Body body =
        meshUnder("", op(R"("xformOp:rotateX")",
                         R"("xformOp:rotateX": {"typeName": "float", "timeSamples": [[3, 90], [24, 0]]})"));
    CHECK((world(body)[1] - Vec3(0, 0, 1)).norm() < 1e-12);
}

TEST_CASE("a scaled body takes its joint along") {
    const std::string text =
        R"({"format": "osgtss", "formatVersion": "1.0", "primChildren": [
        {"name": "A", "typeName": "Mesh", "properties": {)" +
        op(R"("xformOp:scale")", R"("xformOp:scale": {"typeName": "float3", "default": [2, 2, 2]})") + ", " +
        triangle + R"(}},
        {"name": "J", "typeName": "PhysicsRevoluteJoint", "properties": {
            "physics:body1": {"targetPaths": ["/A"]},
            "physics:localPos1": {"typeName": "point3f", "default": [1, 2, 3]}}}]})";
    const SceneModel scene = readScene(parseLayer(text, ""), "");
    CHECK((scene.joints.at(0).frame1.translation() - Vec3(2, 4, 6)).norm() < 1e-12);
    CHECK(scene.joints[0].body0 == -1);
    CHECK(std::isinf(scene.joints[0].dofs.at(0).lower));
}

TEST_CASE("faces of many corners become triangles, left-handed ones are turned over") {
    const std::string text = R"({"format": "osgtss", "formatVersion": "1.0", "primChildren": [
        {"name": "A", "typeName": "Mesh", "properties": {
            "orientation": {"typeName": "token", "default": "leftHanded"},
            "points": {"typeName": "point3f[]", "default": [[0,0,0],[1,0,0],[1,1,0],[0,1,0],[5,5,5]]},
            "faceVertexCounts": {"typeName": "int[]", "default": [4, 3]},
            "faceVertexIndices": {"typeName": "int[]", "default": [0,1,2,3, 0,1,4]}}}]})";
    const Body body = readScene(parseLayer(text, ""), "").bodies.at(0);
    CHECK(body.mesh.triangles == std::vector<Tri>{{0, 2, 1}, {0, 3, 2}, {0, 4, 1}});
}

TEST_CASE("triangles of a face that is not convex lie on it, whichever its first corner is") {
    const std::string text = R"({"format": "osgtss", "formatVersion": "1.0", "primChildren": [
        {"name": "A", "typeName": "Mesh", "properties": {
            "points": {"typeName": "point3f[]", "default": [[2,0,0],[0.5,0.5,0],[0,2,0],[0,0,0]]},
            "faceVertexCounts": {"typeName": "int[]", "default": [4]},
            "faceVertexIndices": {"typeName": "int[]", "default": [0,1,2,3]}}}]})";
    const Body body = readScene(parseLayer(text, ""), "").bodies.at(0);
    CHECK(body.mesh.triangles == std::vector<Tri>{{1, 2, 3}, {0, 1, 3}});
}
