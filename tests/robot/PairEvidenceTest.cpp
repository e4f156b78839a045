#include "bake/robot/PairEvidence.h"

#include "tests/Shapes.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

Body cube(const std::string& name, double half, const Vec3& at = Vec3::Zero()) {
    Body body;
    body.path = "/Scene/" + name;
    body.mesh = boxMesh(at - Vec3::Constant(half), at + Vec3::Constant(half));
    return body;
}

/// Holds B where the frames say, `at` from A.
Joint fixed(const std::string& name, int a, int b, const Vec3& at) {
    Joint joint;
    joint.path = "/Scene/" + name;
    joint.body0 = a;
    joint.body1 = b;
    joint.frame0.translation() = at;
    return joint;
}

PairEvidence only(const SceneModel& scene) {
    const std::vector<PairEvidence> all = evidenceOf(scene);
    REQUIRE(all.size() == 1);
    return all.front();
}

} // namespace

TEST_CASE("bodies fixed to each other are where their joint has them, not where they are drawn") {
    SceneModel scene;
    scene.bodies = {cube("a", 1), cube("b", 1)};
    scene.joints = {fixed("weld", 0, 1, {1.5, 0, 0})};
    scene.bodies[1].placement.translation() = Vec3(9, 0, 0);
    CHECK(only(scene).verdict == Meeting::Always);
    scene.joints = {fixed("weld", 0, 1, {5, 0, 0})};
    CHECK(only(scene).verdict == Meeting::Never);
    CHECK(only(scene).clearance == Approx(3));
}

TEST_CASE("a part that lies in the other body meets it, whichever part of whichever body it is") {
    SceneModel scene;
    scene.bodies = {cube("a", 0.5, {5, 0, 0}), cube("b", 1)};
    const TriangleMesh small = cube("", 0.1).mesh;
    TriangleMesh& a = scene.bodies[0].mesh;
    const int first = static_cast<int>(a.vertices.size());
    a.vertices.insert(a.vertices.end(), small.vertices.begin(), small.vertices.end());
    for (const Tri& t : small.triangles) a.triangles.emplace_back(t[0] + first, t[1] + first, t[2] + first);
    scene.joints = {fixed("weld", 0, 1, Vec3::Zero())};
    CHECK(only(scene).verdict == Meeting::Always);
    std::swap(scene.bodies[0].mesh, scene.bodies[1].mesh);
    CHECK(only(scene).verdict == Meeting::Always);
    scene.joints = {fixed("weld", 0, 1, {0, 0, 3})};
    CHECK(only(scene).verdict == Meeting::Never);
}
