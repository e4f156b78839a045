#include "bake/motion/Motion.h"
#include "tests/Joints.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>

using namespace tss;
using random_table::Random;

namespace {

constexpr double quarterTurn = 1.57079632679489661923;

Dof turn(const Vec3& origin, const Vec3& axis) {
    return joints::turn(origin, axis, -3, 3);
}

Dof slideAlong(const Vec3& axis) {
    return joints::slide(axis, -10, 10);
}

} // namespace

TEST_CASE("a quarter turn about an axis beside the origin") {
    const Pose p = dofPose(turn(Vec3(1, 0, 0), Vec3::UnitZ()), quarterTurn);
    CHECK((p * Vec3(2, 0, 5)).isApprox(Vec3(1, 1, 5)));
    CHECK((p * Vec3(1, 0, 0)).isApprox(Vec3(1, 0, 0)));
}

TEST_CASE("a slide counts in multiples of its axis") {
    CHECK((dofPose(slideAlong(Vec3(0, 2, 0)), 1.5) * Vec3(1, 1, 1)).isApprox(Vec3(1, 4, 1)));
}

TEST_CASE("the last DOF acts on a point first, after the base") {
    Motion m;
    m.dofs = {turn(Vec3::Zero(), Vec3::UnitZ()), slideAlong(Vec3::UnitX())};
    m.base.translation() = Vec3(0, 0, 7);
    const std::vector<double> q{quarterTurn, 3.0};
    // The point slides along x to (3, 0, 7), then turns to y.
    CHECK((pose(m, q) * Vec3::Zero()).isApprox(Vec3(0, 3, 7)));
}

TEST_CASE("a path goes through its rows and half way between them") {
    Dof d;
    d.kind = DofKind::Path;
    d.lower = 0;
    d.upper = 2;
    d.path = {{0, Vec3::Zero(), Eigen::Quaterniond::Identity()},
              {1, Vec3(1, 0, 0), Eigen::Quaterniond(Eigen::AngleAxisd(quarterTurn, Vec3::UnitZ()))},
              {2, Vec3(1, 5, 0), Eigen::Quaterniond(Eigen::AngleAxisd(quarterTurn, Vec3::UnitZ()))}};
    CHECK((dofPose(d, 0) * Vec3(1, 0, 0)).isApprox(Vec3(1, 0, 0)));
    CHECK((dofPose(d, 1) * Vec3(1, 0, 0)).isApprox(Vec3(1, 1, 0)));
    CHECK((dofPose(d, 1.5) * Vec3(1, 0, 0)).isApprox(Vec3(1, 3.5, 0)));
    const double half = std::sqrt(0.5);
    CHECK((dofPose(d, 0.5) * Vec3(1, 0, 0)).isApprox(Vec3(0.5 + half, half, 0)));
    CHECK((dofPose(d, -1) * Vec3(1, 0, 0)).isApprox(Vec3(1, 0, 0)));
    CHECK((dofPose(d, 9) * Vec3(1, 0, 0)).isApprox(Vec3(1, 6, 0)));
}

TEST_CASE("a path in a frame of its own is the path seen from there") {
    Random random(11);
    const Dof d = random_table::path(random, 5);
    Dof plain = d;
    plain.frame = Pose::Identity();
    for (double q : {0.0, 0.1, 0.6, 1.0}) {
        const Vec3 x(1, 2, 3);
        const Vec3 seen = d.frame * (dofPose(plain, q) * (d.frame.inverse() * x));
        CHECK((dofPose(d, q) * x).isApprox(seen, 1e-12));
    }
}

TEST_CASE("every pose of a random motion is rigid") {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Motion m = random_table::motion(random, 1 + int(random() % 6), 10);
        REQUIRE_NOTHROW(checkMotion(m));
        const Pose p = pose(m, random_table::values(random, m));
        REQUIRE((p.linear() * p.linear().transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
        REQUIRE(p.linear().determinant() == Approx(1));
    }
}

TEST_CASE("rest values are those of the DOFs") {
    Motion m;
    m.dofs = {turn(Vec3::Zero(), Vec3::UnitZ()), slideAlong(Vec3::UnitX())};
    m.dofs[1].rest = 0.25;
    CHECK(restValues(m) == std::vector<double>{0, 0.25});
}
