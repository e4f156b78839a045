#include "bake/search/RestContact.h"

#include "tests/Joints.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

/// What is asked about two bodies, kept together while it is.
struct Both {
    Solid a, b;
    MeshQuery surfaceA, surfaceB;
    ContactSurface sideA, sideB;

    Both(const TriangleMesh& a, const TriangleMesh& b)
        : a(a), b(b), surfaceA(a), surfaceB(b), sideA(this->a, surfaceA), sideB(this->b, surfaceB) {}

    RestContact find(const Motion& motion, double reach, double close = -1) const {
        return findRestContact(sideA, sideB, motion, touchingDistance(a.mesh(), b.mesh(), motion),
                               {reach, close < 0 ? reach : close, 0, reach, 400});
    }
};

Motion sliding(const Vec3& axis, double lower, double upper) {
    Motion motion;
    motion.dofs = {joints::slide(axis, lower, upper)};
    return motion;
}

/// The bounds of the region on a mesh.
Eigen::AlignedBox3d boundsOf(const TriangleMesh& mesh, const std::vector<SurfacePart>& parts) {
    return bounds(meshOf(mesh, parts));
}

} // namespace

TEST_CASE("surfaces apart at rest have no region, however near") {
    const Both both(boxMesh({0, 0, 0}, {1, 1, 1}), boxMesh({1.001, 0, 0}, {2, 1, 1}));
    const RestContact rest = both.find(sliding({1, 0, 0}, -0.5, 0.5), 0.1);
    CHECK(rest.clearance == Approx(0.001));
    CHECK(rest.apart == Approx(0.001));
    CHECK(rest.region.empty());
}

TEST_CASE("a body wholly inside another, surfaces apart, does not overlap it") {
    const Both both(boxMesh({0, 0, 0}, {3, 3, 3}), boxMesh({1, 1, 1}, {2, 2, 2}));
    const RestContact rest = both.find(sliding({1, 0, 0}, -0.5, 0.5), 0.1);
    CHECK(rest.clearance == Approx(1));
    CHECK(rest.region.empty());
}

TEST_CASE("boxes that touch with a face have a region about that face") {
    const Both both(boxMesh({0, 0, 0}, {1, 1, 1}), boxMesh({1, 0.2, 0.2}, {2, 0.8, 0.8}));
    const RestContact rest = both.find(Motion{}, 0.05);
    CHECK(rest.clearance == 0);
    const Eigen::AlignedBox3d a = boundsOf(both.a.mesh(), rest.region.a),
                              b = boundsOf(both.b.mesh(), rest.region.b);
    CHECK(a.min().x() > 0.99); // of that face of A, what is near B
    CHECK(a.contains(Vec3(1, 0.2, 0.2)));
    CHECK(a.contains(Vec3(1, 0.8, 0.8)));
    CHECK(a.min().y() > 0.2 - 0.15);
    CHECK(a.max().z() < 0.8 + 0.15);
    CHECK(b.max().x() < 1 + 0.15);
    CHECK(area(both.a.mesh(), rest.region.a) < 0.9 * 0.9);
    CHECK(area(both.a.mesh(), rest.region.a) >= 0.36);
    CHECK(area(both.b.mesh(), rest.region.b) >= 0.36);
}

TEST_CASE("the region grows along the motion as far as the contact that was there at rest goes on") {
    // A block sunk a little into a long bar slides along it, up to a wall that it does not touch at rest.
    TriangleMesh bar = boxMesh({-5, -1, -1}, {5, 1, 0});
    append(bar, boxMesh({2, -0.4, 0.3}, {2.5, 0.4, 1.5}));
    const Both both(bar, boxMesh({-0.5, -0.5, -0.05}, {0.5, 0.5, 1}));
    const Motion motion = sliding({1, 0, 0}, -2, 4);
    const RestContact rest = both.find(motion, 0.1);
    CHECK(rest.clearance == 0);
    const Eigen::AlignedBox3d a = boundsOf(both.a.mesh(), rest.region.a);
    CHECK(a.min().x() < -2.5); // the block's end at the lower limit
    CHECK(a.min().x() > -3);   // and little more
    CHECK(a.max().x() > 1.9);  // until it meets the wall
    CHECK(a.max().x() < 2.5);
    CHECK(a.max().z() < 0.01); // the wall itself is not excepted
    const RestContact still = both.find(Motion{}, 0.1);
    CHECK(area(both.a.mesh(), still.region.a) < 0.6 * area(both.a.mesh(), rest.region.a));
}

TEST_CASE("what comes near between two poses that are looked at is of the region") {
    // A comb of thin teeth slides over a bar that it is sunk into: between two poses a tooth covers a strip
    // that it covers at neither.
    TriangleMesh comb = boxMesh({-0.5, -0.5, 0.5}, {0.5, 0.5, 1});
    for (int k = 0; k < 2; ++k) append(comb, boxMesh({k - 0.5, -0.5, -0.05}, {k - 0.48, 0.5, 0.5}));
    const Both both(boxMesh({-5, -1, -1}, {5, 1, 0}), comb);
    const double reach = 0.05, step = 0.02;
    const Motion motion = sliding({1, 0, 0}, -2, 2);
    const RestContact rest =
        findRestContact(both.sideA, both.sideB, motion, 1e-9, {reach, reach, 0, step, 400});
    PartSet region;
    for (const SurfacePart& part : rest.region.a) region.insert(part);
    std::mt19937_64 random(5);
    const Progress progress;
    Poll poll(progress, "");
    for (int k = 0; k < 40; ++k) {
        const std::vector<double> q{std::uniform_real_distribution<>(-2, 2)(random)};
        const Pose bToA = pose(motion, q);
        CHECK(both.sideA.meeting(both.sideB, bToA.inverse(), reach - step / 2, 1e-4, region, poll).empty());
    }
}

TEST_CASE("what is near at rest without touching is no part of the region") {
    // Two pairs of faces: one overlaps, the other is apart by less than the reach.
    TriangleMesh a = boxMesh({0, 0, 0}, {1, 1, 1}), b = boxMesh({0.99, 0, 0}, {2, 1, 1});
    append(a, boxMesh({0, 3, 0}, {1, 4, 1}));
    append(b, boxMesh({1.02, 3, 0}, {2, 4, 1}));
    const Both both(a, b);
    const RestContact rest = both.find(Motion{}, 0.1);
    CHECK(rest.clearance == 0);
    CHECK(rest.apart == Approx(0.02));
    CHECK(boundsOf(both.a.mesh(), rest.region.a).max().y() < 1.01);
    CHECK(boundsOf(both.b.mesh(), rest.region.b).max().y() < 1.01);
    CHECK(bounds(rest.nearA).min().y() > 2.9);
    CHECK(bounds(rest.nearB).min().y() > 2.9);
}

TEST_CASE(
    "a second foot that stands off the ground is of the region as far as it is close, not within reach") {
    TriangleMesh a = boxMesh({0, 0, -0.05}, {1, 1, 1}); // stands in the ground
    append(a, boxMesh({1.02, 0, 0.04}, {2, 1, 1}));     // does not reach it
    const Both both(a, boxMesh({-1, -1, -1}, {5, 2, 0}));
    for (const double close : {0.03, 0.05}) {
        const RestContact rest = both.find(Motion{}, 0.1, close);
        CHECK((boundsOf(both.a.mesh(), rest.region.a).max().x() > 1.9) == (close > 0.04));
        CHECK(rest.apart == Approx(close > 0.04 ? 0.1 : 0.04));
        CHECK(rest.nearA.empty() == (close > 0.04));
    }
}

TEST_CASE("what the region leaves out is outside of the other body and at least the reach away") {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        CAPTURE(seed);
        std::mt19937_64 random(seed);
        const TriangleMesh a = lumpyMesh(random, 3, 0.3), b = lumpyMesh(random, 3, 0.3);
        Motion motion;
        motion.base.translation() = Vec3(1.6, 0.2, 0);
        const double reach = 0.08;
        const Both both(a, b);
        const RestContact rest = both.find(motion, reach);
        if (rest.clearance > 0) continue;
        PartSet region;
        for (const SurfacePart& part : rest.region.a) region.insert(part);
        MeshQuery near(rest.nearA);
        const Pose toB = motion.base.inverse();
        int left = 0;
        for (std::uint32_t t = 0; t < a.triangles.size(); ++t)
            for (std::uint32_t cuts = 1u << 8; cuts < 1u << 9; cuts += 7) {
                if (region.contains({t, cuts})) continue;
                const Corners c = corners(a, {t, cuts});
                const Vec3 x = (c[0] + c[1] + c[2]) / 3;
                if (!rest.nearA.empty() && near.distance(x) < 1e-9) continue;
                ++left;
                CHECK(both.b.boundary().distance(toB * x) >= reach);
                CHECK_FALSE(both.b.inside(toB * x));
            }
        CHECK(left > 1000);
        CHECK(area(a, rest.region.a) < 0.5 * area(a));
    }
}
