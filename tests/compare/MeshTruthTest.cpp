#include "bake/compare/MeshTruth.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

/// A corner of a box over the middle of another one's face, a quarter of the unit away.
double distanceInUnits(double unit) {
    const TriangleMesh below = boxMesh(Vec3(-1, -1, -1) * unit, Vec3(1, 1, 0) * unit),
                       above = boxMesh(Vec3::Zero(), Vec3(1, 1, 1) * unit);
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1), Vec3::UnitZ()).toRotationMatrix();
    pose.translation() = Vec3(0.3, -0.2, 0.25) * unit;
    return compare::MeshTruth(below, above).distance(pose) / unit;
}

} // namespace

TEST_CASE("the distance that the meshes are judged by does not depend on the unit") {
    for (const double unit : {1e-6, 1e-4, 1.0, 1e6}) {
        INFO(unit);
        CHECK(distanceInUnits(unit) == Approx(0.25).epsilon(1e-6));
    }
}
