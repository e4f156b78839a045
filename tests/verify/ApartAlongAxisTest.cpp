#include "bake/search/SurfacesApart.h"

#include "bake/geometry/MeshQuery.h"
#include "bake/verify/MeshVerify.h"
#include "tests/Joints.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <random>

using namespace tss;

namespace {

constexpr double touching = 1e-9;

} // namespace

TEST_CASE("links of a flat linkage in layers of their own are proven apart, over however many turns") {
    constexpr double pi = std::numbers::pi;
    const TriangleMesh a = boxMesh({-1, -0.1, 0}, {9, 0.1, 1});
    Motion motion;
    const Vec3 axis = Vec3(1e-9, 0, 1).normalized(); // as frames in floats have it, and less
    for (const double x : {0.0, 8.0, 4.0, 6.0})
        motion.dofs.push_back(joints::turn({x, 0, 0}, x > 0 ? axis : Vec3(-axis), -pi, pi));
    const auto layer = [&](double from) { return boxMesh({-1, -0.1, from}, {9, 0.1, from + 1}); };
    const auto holds = [&](const TriangleMesh& b, double clearance) {
        NeverCollides proof;
        proof.clearance = clearance;
        return verifyOnMeshes(a, b, proof, motion, 100'000).holds();
    };
    for (const double from : {1.01, -1.01}) {
        const auto apart = surfacesApart(a, layer(from), motion, touching);
        REQUIRE(apart);
        CHECK(apart->clearance > 0.008);
        CHECK(apart->clearance < 0.01);
        CHECK(holds(layer(from), apart->clearance));
        CHECK(holds(layer(from), 0.00999));
        CHECK_FALSE(holds(layer(from), 0.0101));
    }
    CHECK_FALSE(surfacesApart(a, layer(1), motion, touching));
    CHECK_FALSE(surfacesApart(a, layer(0.9), motion, touching));

    motion.dofs.push_back(joints::slide({0, 1, 0.01}, -0.5, 2)); // down by 0.005
    CHECK(apartAlongAxis(a, layer(1.01), motion) == Approx(0.005).margin(1e-5));
    CHECK(apartAlongAxis(a, layer(-1.05), motion) == Approx(0.03).margin(1e-5));
    CHECK(holds(layer(1.01), 0.0049));
    CHECK(holds(layer(-1.05), 0.0299));
    CHECK_FALSE(holds(layer(1.01), 0.0051));
    motion.dofs.push_back(joints::turn(Vec3::Zero(), Vec3(0.01, 0, 1), -0.1, 0.1)); // tilted
    CHECK_FALSE(apartAlongAxis(a, layer(1.01), motion) > 0);
    CHECK_FALSE(holds(layer(1.01), 0.004));
    CHECK(apartAlongAxis(a, layer(3), motion) > 0.5);
}

TEST_CASE("how far bodies stay apart along an axis is never more than their distance") {
    std::mt19937 random(5);
    const auto in = [&](double from, double to) { return std::uniform_real_distribution(from, to)(random); };
    int shown = 0;
    for (int round = 0; round < 200; ++round) {
        Motion motion;
        const double tilt = round % 2 ? 0 : in(0, 0.1);
        for (int k = 0; k < 3; ++k)
            motion.dofs.push_back(joints::turn({in(-3, 3), in(-3, 3), in(-3, 3)},
                                               {in(-tilt, tilt), in(-tilt, tilt), 1}, in(-3, 0), in(0, 3)));
        motion.dofs.push_back(joints::slide({in(-1, 1), in(-1, 1), in(-0.5, 0.5)}, in(-1, 0), in(0, 1)));
        motion.base.translation() = Vec3(0, 0, in(-6, 6));
        const TriangleMesh a = boxMesh({-2, -2, -1}, {2, 2, 1}), b = boxMesh({-1, -2, -0.5}, {2, 1, 0.5});
        const double apart = apartAlongAxis(a, b, motion);
        if (!(apart > 0)) continue;
        ++shown;
        const MeshQuery still(a), moving(b);
        for (int pose_ = 0; pose_ < 50; ++pose_) {
            std::vector<double> q;
            for (const Dof& dof : motion.dofs) q.push_back(in(dof.lower, dof.upper));
            CHECK(still.distanceTo(moving, pose(motion, q)) >= apart);
        }
        NeverCollides proof;
        proof.clearance = 0.875 * apart;
        CHECK(verifyOnMeshes(a, b, proof, motion, 1'000'000).holds());
    }
    CHECK(shown > 50);
}
