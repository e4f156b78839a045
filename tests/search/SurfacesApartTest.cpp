#include "bake/search/SurfacesApart.h"

#include "bake/base/Parallel.h"
#include "bake/geometry/MeshQuery.h"
#include "tests/Joints.h"
#include "tests/Shapes.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <random>

using namespace tss;
using namespace tss::test;

namespace {

constexpr double touching = 1e-9;

/// A ball of radius 1 about the origin and one of 0.5 that goes round it, its centre `out` from the axis.
std::optional<SurfacesApart> round(double out, double from, double to,
                                   const std::vector<LimitPlane>& planes = {}) {
    Motion motion;
    motion.dofs = {joints::turn(Vec3(0.05, 0, 0), Vec3::UnitZ(), from, to)};
    motion.planes = planes;
    return surfacesApart(ballMesh(Vec3::Zero(), 1, 3), ballMesh({out + 0.05, 0, 0}, 0.5, 3), motion,
                         touching);
}

} // namespace

TEST_CASE("surfaces that pass close all the way round are proven apart, by at least half of their distance") {
    // Where the turn brings it nearest, half way round, its centre is 1.46 from the other's.
    constexpr double pi = std::numbers::pi;
    const auto apart = round(1.56, -pi, pi);
    REQUIRE(apart);
    CHECK(apart->clearance > 0.005);
    CHECK(apart->clearance < 0.03); // polyhedra, a little inside their balls
    CHECK(round(1.51 + 0.0002, -0.2, 0.2));
}

TEST_CASE("surfaces that touch at one pose alone are not apart, unless a limit plane keeps it off") {
    constexpr double pi = std::numbers::pi;
    CHECK_FALSE(round(1.48, -pi, pi));
    CHECK(round(1.48, -0.5, 0.5));
    CHECK(round(1.48, -pi, pi, {{{1}, 0.5}, {{-1}, 0.5}}));
}

TEST_CASE("a body inside another, surfaces apart, is apart; a joint without freedom has one pose to ask") {
    Motion motion;
    motion.dofs = {joints::slide(Vec3::UnitX(), -0.4, 0.4), joints::slide(Vec3::UnitY(), -0.4, 0.4)};
    const TriangleMesh outer = ballMesh(Vec3::Zero(), 1, 3), inner = ballMesh(Vec3::Zero(), 0.2, 2);
    const auto inside = surfacesApart(outer, inner, motion, touching);
    REQUIRE(inside);
    CHECK(inside->clearance < 1 - 0.2 - std::hypot(0.4, 0.4));
    motion.dofs.clear();
    REQUIRE(surfacesApart(outer, inner, motion, touching));
    CHECK(surfacesApart(outer, inner, motion, touching)->clearance > 0.5);
    CHECK_FALSE(surfacesApart(outer, outer, motion, touching));
    CHECK_FALSE(surfacesApart(outer, TriangleMesh{}, motion, touching));
}

TEST_CASE("surfaces proven apart are apart by the clearance at random poses of random joints") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto vec = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
    int proven = 0, tight = 0;
    for (int round = 0; round < 60; ++round) {
        const TriangleMesh a = soupMesh(random, 12, 1, 0.5);
        TriangleMesh b = soupMesh(random, 12, 1, 0.5);
        Motion motion;
        motion.base = Pose(Eigen::Translation3d(2.2 * vec().normalized()));
        for (int k = 0; k < 1 + round % 3; ++k)
            motion.dofs.push_back(k % 2 == 0 ? joints::turn(vec(), vec(), -0.7, 0.9)
                                             : joints::slide(vec(), -0.2, 0.3));
        const auto apart = surfacesApart(a, b, motion, touching);
        if (!apart) continue;
        ++proven;
        const MeshQuery queryA(a), queryB(b);
        double least = 1e9;
        for (int i = 0; i < 2000; ++i) {
            std::vector<double> q;
            for (const Dof& dof : motion.dofs)
                q.push_back(dof.lower + (dof.upper - dof.lower) * (unit(random) + 1) / 2);
            least = std::min(least, queryA.distanceTo(queryB, pose(motion, q), least));
        }
        CHECK(least > apart->clearance);
        tight += least < 2.5 * apart->clearance;
    }
    CHECK(proven > 10);
    CHECK(tight > 10);
}

TEST_CASE("discs that turn a millionth of their size apart are proven apart; tilted, they are not") {
    const TriangleMesh lower = boxMesh({-1, -1, -0.2}, {1, 1, 0}),
                       upper = boxMesh({-1, -1, 1e-6}, {1, 1, 0.2});
    Motion motion;
    motion.dofs = {joints::turn(Vec3(0.2, 0.1, 0), Vec3::UnitZ(), -3.1, 3.1)};
    const auto apart = surfacesApart(lower, upper, motion, touching);
    REQUIRE(apart);
    CHECK(apart->clearance > 0.4e-6);
    CHECK(apart->clearance < 1e-6);
    motion.dofs[0].axis = Vec3(1e-6, 0, 1).normalized(); // a corner goes down by 2e-6 and more
    CHECK_FALSE(surfacesApart(lower, upper, motion, touching));
}

TEST_CASE("over many values poses are found where surfaces meet though none of the sampled ones is near") {
    Motion motion;
    for (int k = 0; k < 9; ++k) motion.dofs.push_back(joints::slide(Vec3::Unit(k % 3), -0.5, 0.5));
    const TriangleMesh b = boxMesh(Vec3::Constant(-0.1), Vec3::Constant(0.1));
    const Vec3 place{1.1, -0.9, 1.2};
    const TriangleMesh a = boxMesh(place - Vec3::Constant(0.1), place + Vec3::Constant(0.1));
    double nearest = 1;
    CHECK_FALSE(surfacesApart(a, b, motion, touching, {}, &nearest));
    CHECK(nearest <= touching);
}

TEST_CASE("the proof that surfaces stay apart is the same for any number of threads, and can be stopped") {
    Motion motion;
    motion.dofs = {joints::turn(Vec3::Zero(), Vec3::UnitZ(), -1, 1),
                   joints::turn(Vec3(1, 0, 0), Vec3::UnitY(), -1, 1)};
    const TriangleMesh a = ballMesh(Vec3::Zero(), 1, 3), b = ballMesh({2.2, 0, 0}, 0.5, 3);
    const auto many = surfacesApart(a, b, motion, touching);
    const ThreadLimit limit(1);
    const auto one = surfacesApart(a, b, motion, touching);
    REQUIRE(many);
    REQUIRE(one);
    CHECK(one->clearance == many->clearance);
    CHECK(one->cells == many->cells);
    CHECK_FALSE(surfacesApart(a, b, motion, touching, [](std::string_view, double) { return false; }));
}
