#pragma once
#include "bake/model/SourceHash.h"
#include "bake/scene/SceneLayer.h"

#include <cmath>
#include <memory>
#include <numbers>

/// Small scenes with tables made by hand, so that contact is known in closed form.
namespace scenes {

inline tss::TriangleMesh box(const tss::Vec3& centre, const tss::Vec3& half) {
    tss::TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.vertices.push_back(centre +
                                half.cwiseProduct(tss::Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// The stop stands at this angle of the hinge; contact is where the chord between the two spheres is 0.5.
constexpr double stopAngle = 1;
inline double contactAngle() {
    return stopAngle - 2 * std::asin(0.5 / 2 / 2);
}

/// An arm on a hinge about Y through the origin, from 0 to 86 degrees, asked to go from 0 to 1.4 and back
/// within 24 time codes. A sphere at its end, 2 from the axis, meets a sphere of the frame at contactAngle().
inline tss::SceneModel hinge(bool withTable = true) {
    tss::SceneModel scene;
    scene.defaultPrim = "Rig";
    scene.endTimeCode = 24;
    // A file keeps spheres as floats.
    const tss::Vec3 stop(float(2 * std::cos(stopAngle)), 0, float(-2 * std::sin(stopAngle)));
    tss::Body frame, arm;
    frame.path = "/Rig/Frame";
    frame.mesh = box(stop, {0.2, 0.2, 0.2});
    frame.placement.translation() = tss::Vec3(5, 0, 0);
    arm.path = "/Rig/Arm";
    arm.mesh = box({1, 0, 0}, {1, 0.2, 0.2});
    arm.placement = frame.placement;
    frame.rigid = arm.rigid = true;
    scene.bodies = {frame, arm};

    tss::Joint joint;
    joint.path = "/Rig/Hinge";
    joint.body0 = 0;
    joint.body1 = 1;
    tss::Dof dof;
    dof.name = "rotY";
    dof.axis = tss::Vec3::UnitY();
    dof.upper = 86 * std::numbers::pi / 180;
    joint.dofs = {dof};
    joint.drives = {{{0, 12, 24}, {0, 1.4, 0}}};
    scene.joints = {joint};

    tss::Pair pair;
    pair.path = joint.path;
    pair.bodyA = 0;
    pair.bodyB = 1;
    pair.joints = {0};
    scene.pairs = {pair};
    scene = tss::readScene(tss::toLayer(scene), "hinge"); // numbers as a file holds them
    if (!withTable) return scene;
    scene.pairs[0].table = std::make_shared<tss::Table>(tss::makeTable(
        {{stop, 0.25}}, {{tss::Vec3(2, 0, 0), 0.25}}, {{0, 0}}, {}, pairMotion(scene, scene.pairs[0])));
    scene.pairs[0].sourceHash = tss::sourceHash(scene, scene.pairs[0]);
    return scene;
}

} // namespace scenes
