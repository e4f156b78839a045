#include "bake/geometry/FibreLine.h"
#include "bake/base/Error.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

TEST_CASE("the fibre line of a long body runs through its middle from end to end") {
    Eigen::Affine3d shape = Eigen::Affine3d::Identity();
    shape.translate(Vec3(5, 6, 7))
        .rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))
        .scale(Vec3(0.5, 4, 0.7));
    const std::vector<Vec3> line = fibreLine(transformed(ballMesh(Vec3::Zero(), 1, 4), shape));
    REQUIRE(line.size() == 9);
    const Vec3 axis = shape.linear().col(1).normalized(), middle(5, 6, 7);
    for (const Vec3& p : line) CHECK((p - middle - axis * axis.dot(p - middle)).norm() < 0.1);
    CHECK((line.front() - line.back()).norm() == Approx(8).epsilon(0.02));
    const double sense = (line.back() - line.front()).dot(axis);
    for (std::size_t k = 0; k + 1 < line.size(); ++k) CHECK((line[k + 1] - line[k]).dot(axis) * sense > 0);
}

TEST_CASE("the fibre line follows a body that bends, and is that of the largest component") {
    TriangleMesh mesh = ballMesh(Vec3::Zero(), 1, 4);
    for (Vec3& v : mesh.vertices) { // three quarters of a circle of radius 3
        const double angle = 0.75 * 3.14159265 * v.x(), radius = 3 + 0.4 * v.y();
        v = Vec3(radius * std::cos(angle), radius * std::sin(angle), 0.4 * v.z());
    }
    append(mesh, ballMesh({20, 0, 0}, 0.5, 2));
    const std::vector<Vec3> line = fibreLine(mesh);
    for (std::size_t k = 1; k + 1 < line.size(); ++k) {
        CHECK(std::abs(line[k].norm() - 3) < 0.2);
        CHECK(std::abs(line[k].z()) < 0.05);
    }
    CHECK_THROWS_AS(fibreLine(TriangleMesh()), InputError);
}
