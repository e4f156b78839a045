#include "bake/verify/MeshVerify.h"

#include "bake/base/Parallel.h"
#include "bake/geometry/TriangleDistance.h"
#include "bake/table/Query.h"
#include "tests/Joints.h"
#include "tests/geometry/TestMeshes.h"
#include "tests/search/Scenes.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace tss;
using namespace tss::test;

namespace {

struct Case {
    TriangleMesh a, b;
    Table table;
    Motion motion;
    MeshVerdict verdict() const { return verifyOnMeshes(a, b, table, motion); }
};

/// The surfaces meet at the pose, by looking at every two triangles.
bool meet(const Case& c, const std::vector<double>& q) {
    const Pose at = pose(c.motion, q);
    for (std::uint32_t s = 0; s < c.a.triangles.size(); ++s)
        for (std::uint32_t t = 0; t < c.b.triangles.size(); ++t) {
            Corners moved = corners(c.b, {t, 1});
            for (Vec3& p : moved) p = at * p;
            if (squaredDistanceOfTriangles(corners(c.a, {s, 1}), moved) == 0) return true;
        }
    return false;
}

/// A refusal that names a pose at which the meshes meet and the table is silent.
void refusedWithPose(const Case& c) {
    const MeshVerdict verdict = c.verdict();
    CHECK_FALSE(verdict.holds());
    CHECK_FALSE(verdict.miss);
    REQUIRE(verdict.pose.size() == c.motion.dofCount());
    CHECK(withinLimits(c.motion, verdict.pose));
    CHECK(meet(c, verdict.pose));
    CHECK(query(c.table, verdict.pose).gap > c.table.boundMiss.value());
}

/// A box that slides along x into another, each with one ball about its middle: they touch when the middles
/// are 1 apart.
Case boxes(double radius, double early = 10) {
    Case c;
    c.a = boxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    c.b = boxMesh({1.5, -0.5, -0.5}, {2.5, 0.5, 0.5});
    c.motion.dofs = {joints::slide(Vec3::UnitX(), -2, 0)};
    c.table = makeTable({{Vec3::Zero(), radius}}, {{Vec3(2, 0, 0), radius}}, {{0, 0}}, {}, c.motion);
    c.table.boundMiss = 0;
    c.table.boundEarly = early;
    c.table.certified = true;
    return c;
}

} // namespace

TEST_CASE("a table is proven when its test reports wherever the meshes meet, from the first touch on") {
    for (const double radius : {0.5, 0.500001, 0.7, 1.0}) {
        CAPTURE(radius);
        const MeshVerdict verdict = boxes(radius).verdict();
        INFO(verdict.reason);
        CHECK(verdict.holds());
        CHECK(verdict.miss);
    }
    for (const double radius : {0.499999, 0.49, 0.3}) {
        CAPTURE(radius);
        refusedWithPose(boxes(radius));
    }
}

TEST_CASE("a bound on misses is proven as it is stated and not a hair tighter") {
    Case c = boxes(0.45); // reports 0.1 late
    for (const double miss : {0.1000001, 0.11, 1.0}) {
        c.table.boundMiss = miss;
        CHECK(c.verdict().holds());
    }
    for (const double miss : {0.0, 0.05, 0.0999}) {
        c.table.boundMiss = miss;
        refusedWithPose(c);
    }
    c.table.boundMiss.reset(); // nothing is claimed
    CHECK(c.verdict().holds());
    CHECK_FALSE(c.verdict().miss);
}

TEST_CASE("what a second DOF brings about is seen: a test that is enough for one is refused for two") {
    Case c = boxes(0.5);
    c.motion.dofs.push_back(joints::slide(Vec3::UnitY(), -0.8, 0.8));
    c.table.motion = c.motion;
    refusedWithPose(c);
    c = boxes(0.65); // sqrt(0.25 + 0.16) is 0.6403
    c.motion.dofs.push_back(joints::slide(Vec3::UnitY(), -0.8, 0.8));
    c.table.motion = c.motion;
    CHECK(c.verdict().holds());
}

TEST_CASE("bodies and axes far from the origin are proven as near ones are") {
    const Vec3 far(1e5, -2e5, 3e4);
    for (const double radius : {0.8, 0.4}) {
        Case c = boxes(radius);
        for (TriangleMesh* mesh : {&c.a, &c.b})
            for (Vec3& v : mesh->vertices) v += far;
        c.motion.dofs[0].kind = DofKind::Rotation;
        c.motion.dofs[0].origin = far + Vec3(2, 1e5, 0); // a turn about it is a slide, nearly
        c.motion.dofs[0].axis = Vec3::UnitZ();
        c.motion.dofs[0].lower = -2e-5;
        c.table.motion = c.motion;
        for (Sphere& s : c.table.a) s.centre += far;
        for (Sphere& s : c.table.b) s.centre += far;
        const MeshVerdict verdict = c.verdict();
        INFO(verdict.reason << ", band " << verdict.band);
        CHECK(verdict.holds() == (radius > 0.5));
        CHECK(verdict.band < 1e-5);
    }
}

TEST_CASE("segments that triangles without area leave are surface") {
    Case c = boxes(0.5);
    c.b = {{{1, 0.7, 0}, {1.2, 3, 0}, {1.1, 1.85, 0}}, {{0, 1, 2}}}; // a wire beside the test's ball
    c.motion.dofs.push_back(joints::slide(Vec3::UnitY(), -0.5, 0));
    c.table.motion = c.motion;
    c.table.boundEarly.reset();
    refusedWithPose(c);
}

TEST_CASE("parts that are exempt from each other need no test, and everything else does") {
    Case c = boxes(0.5);
    for (Vec3& v : c.b.vertices) v.x() -= 1.2; // overlap by 0.2 at rest
    c.motion.dofs = {joints::slide(Vec3::UnitY(), -0.1, 0.1)};
    c.table = makeTable({}, {}, {}, {}, c.motion);
    c.table.boundMiss = 0;
    refusedWithPose(c);
    for (std::uint32_t t = 0; t < 12; ++t) {
        c.table.restRegion.a.push_back({t, 1});
        c.table.restRegion.b.push_back({t, 1});
    }
    const MeshVerdict whole = c.verdict();
    INFO(whole.reason);
    CHECK(whole.holds());
    CHECK(whole.exempt.shareA == Approx(1));
    CHECK(whole.exempt.areaB == Approx(6));
    // A triangle without area on an edge between two of them, or one of them again, is no other surface.
    Case twice = c;
    const Tri first = c.a.triangles[0];
    twice.a.triangles.emplace_back(first[0], first[1], first[0]);
    twice.a.triangles.push_back(first);
    CHECK(twice.verdict().holds());
    // Half of one triangle of A's right side counts again: B's sides cross it all round.
    for (std::uint32_t t = 0; t < 12; ++t) {
        const Corners corner = corners(c.a, {t, 1});
        if (corner[0].x() < 0.2 || corner[1].x() < 0.2 || corner[2].x() < 0.2) continue;
        for (const std::uint32_t exempt : {2u, 3u}) {
            Case half = c;
            half.table.restRegion.a[t].cuts = exempt;
            CHECK_FALSE(half.verdict().holds());
        }
    }
}

TEST_CASE("a region is refused where the meshes do not meet at rest, or far from where they do") {
    Case c = boxes(0.5);
    c.table.restRegion.a = {{0, 1}};
    CHECK(c.verdict().reason.find("do not meet at rest") != std::string::npos);
    c = boxes(1);
    append(c.a, boxMesh({-9, 0, 0}, {-8, 1, 1}));
    for (Vec3& v : c.b.vertices) v.x() -= 1.2;
    c.table.b[0].centre.x() -= 1.2;
    c.table.restRegion.a = {{10, 1}};
    CHECK(c.verdict().holds());
    c.table.restRegion.a = {{10, 1}, {12, 1}};
    CHECK(c.verdict().reason.find("nowhere near") != std::string::npos);
}

TEST_CASE("a piece that stands off the other body is exempt up to a fiftieth of the smaller one, and told") {
    for (const double off : {0.01, 0.019, 0.021, 0.1}) {
        Case c = boxes(0.5);
        const double smaller = std::sqrt(3.0);
        for (Vec3& v : c.b.vertices) v.x() -= 1.2; // overlap by 0.2 at rest
        // Beside B, which the table has nothing to say about.
        append(c.a, boxMesh({0.4, 0.5 + off * smaller, -0.4}, {1.2, 2, 0.4}));
        c.motion.dofs[0].lower = 0;
        c.table = makeTable({}, {}, {}, {}, c.motion);
        c.table.boundMiss = 0;
        // Many large spheres: what they stick out must not widen what may be exempt.
        c.table.a = {{Vec3::Zero(), 50}};
        c.table.rowOffsets = {0, 0};
        for (std::uint32_t t = 0; t < 24; ++t) c.table.restRegion.a.push_back({t, 1});
        for (std::uint32_t t = 0; t < 12; ++t) c.table.restRegion.b.push_back({t, 1});
        const MeshVerdict verdict = c.verdict();
        INFO(off << ": " << verdict.reason);
        CHECK(verdict.holds() == (off < 0.02));
        CHECK(verdict.farthestExempt == Approx(off * smaller));
    }
}

TEST_CASE("spheres that stick out further than stated are refused") {
    const double out = std::sqrt(0.75); // a ball of that radius holds the box, and sticks out of its faces
    Case c = boxes(out, 2 * (out - 0.5));
    CHECK(c.verdict().early);
    CHECK(c.verdict().earlyBound.value() == Approx(2 * (out - 0.5)));
    *c.table.boundEarly *= 0.999;
    CHECK_FALSE(c.verdict().holds());
    c = boxes(0.5, 0.3);
    c.table.restGaps = {0.2};
    c.table.epsilon = 0.31;
    CHECK(c.verdict().holds());
    c.table.restGaps = {0.31};
    CHECK_FALSE(c.verdict().holds());
}

TEST_CASE(
    "a report for a body wholly inside the other is refused, surfaces apart; where they meet it is none") {
    Case c;
    c.a = boxMesh({-2, -2, -2}, {2, 2, 2});
    c.b = boxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    c.motion.dofs = {joints::slide(Vec3::UnitX(), -1, 1)};
    c.table = makeTable({{Vec3::Zero(), 2}}, {{Vec3::Zero(), 0.5}}, {{0, 0}}, {}, c.motion);
    c.table.boundEarly = 0.1;
    const MeshVerdict inside = c.verdict();
    CHECK_FALSE(inside.holds());
    CHECK(inside.reason.find("inside") != std::string::npos);
    REQUIRE(inside.pose.size() == 1);
    // Longer than A is wide, it crosses A's walls wherever it goes.
    c.b = boxMesh({-0.5, -0.5, -3}, {0.5, 0.5, 3});
    const MeshVerdict through = c.verdict();
    INFO(through.reason);
    CHECK(through.holds());
    CHECK(through.early);
}

TEST_CASE(
    "bodies never collide with a positive clearance of the meshes, at every pose of limits that have one") {
    Case c = boxes(0.5);
    c.motion.dofs[0].lower = -0.75; // 0.25 apart at the end
    NeverCollides proof;
    const auto verdict = [&] { return verifyOnMeshes(c.a, c.b, proof, c.motion); };
    for (const double clearance : {1e-3, 0.2, 0.25}) {
        proof.clearance = clearance;
        INFO(verdict().reason);
        CHECK(verdict().holds());
    }
    for (const double clearance : {-1.0, 0.0, 0.2501, 0.3, 2.0}) {
        proof.clearance = clearance;
        CHECK_FALSE(verdict().holds());
    }
    proof.clearance = 0.1;
    c.motion.planes = {{{1}, -0.4}, {{-1}, 0.3}}; // q <= -0.4 and q >= -0.3
    CHECK(verdict().reason.find("leave some pose") != std::string::npos);
    c.motion.planes = {{{1}, -0.3}};
    CHECK(verdict().reason.find("rest") != std::string::npos);
    c.motion.dofs[0].rest = -0.5;
    CHECK(verdict().holds());
    // Overlapping at the only pose there is.
    c = boxes(0.5);
    c.motion.dofs[0].lower = c.motion.dofs[0].upper = c.motion.dofs[0].rest = -1.5;
    CHECK_FALSE(verdict().holds());
}

TEST_CASE("edges a millionth of the bodies apart are proven to be, whichever way they cross") {
    scenes::Random random(7);
    for (int round = 0; round < 20; ++round) {
        const double apart = 1e-6, tilt = 0.3 + 2.5 * random.in(0, 1);
        Case c;
        // Two wedges, edge over edge.
        c.a = {{{-1, 0, 0}, {1, 0, 0}, {0, -0.7, -1}, {0, 0.8, -1.3}},
               {{0, 1, 3}, {1, 0, 2}, {0, 3, 2}, {1, 2, 3}}};
        c.b = c.a;
        const Eigen::Quaterniond all(Eigen::AngleAxisd(3 * random.in(0, 1), random.direction()));
        for (Vec3& v : c.b.vertices)
            v = all * Vec3(Eigen::AngleAxisd(tilt, Vec3::UnitZ()) * Vec3(v.x(), -v.y(), apart - v.z()));
        for (Vec3& v : c.a.vertices) v = all * v;
        c.motion.dofs = {joints::slide((all * Vec3(1, 0.2, 0.1)).normalized(), -1e-7, 1e-7)};
        NeverCollides proof;
        proof.clearance = apart - 1e-7 * 0.1 / std::sqrt(1.05) - 2e-9;
        const MeshVerdict verdict = verifyOnMeshes(c.a, c.b, proof, c.motion);
        INFO(round << ", tilt " << tilt << ": " << verdict.reason);
        CHECK(verdict.holds());
        proof.clearance += 4e-9;
        CHECK_FALSE(verifyOnMeshes(c.a, c.b, proof, c.motion).holds());
    }
}

TEST_CASE("a table of limits that leave no pose is refused, and one of another motion") {
    Case c = boxes(0.7);
    CHECK(c.verdict().holds());
    c.table.motion.dofs[0].lower = -1.9;
    CHECK_FALSE(c.verdict().holds());
    c = boxes(0.7);
    c.motion.planes = {{{1}, -1.5}, {{-1}, 1.4}};
    c.table.motion = c.motion;
    CHECK(c.verdict().reason.find("leave some pose") != std::string::npos);
}

TEST_CASE("a path with corners is proven from corner to corner") {
    for (const double radius : {0.75, 0.4}) {
        Case c = boxes(radius);
        Dof path;
        path.kind = DofKind::Path;
        path.upper = 3;
        const auto row = [](double value, const Vec3& at, double angle) {
            return PathRow{value, at, Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitZ()))};
        };
        path.path = {row(0, {0, 0, 0}, 0), row(1, {0.3, 0.4, 0}, 0.2), row(2, {-1, 0.1, 0}, -0.1),
                     row(3, {-0.9, -0.3, 0.1}, 0.1)};
        c.motion.dofs = {path};
        c.table.motion = c.motion;
        INFO(c.verdict().reason);
        CHECK(c.verdict().holds() == (radius > 0.5));
        if (radius < 0.5) refusedWithPose(c);
    }
}

TEST_CASE("a slow stretch between fast ones of a path is not taken to go less far than it does") {
    Dof path;
    path.kind = DofKind::Path;
    path.upper = 4.2;
    const std::vector<double> values{0, 1, 2, 3, 4.2}, angles{0, 2.9, 3.9, 4.9, 7.9};
    for (std::size_t i = 0; i < values.size(); ++i)
        path.path.push_back(
            {values[i], Vec3::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(angles[i], Vec3::UnitZ()))});
    Motion motion;
    motion.dofs = {path};
    const Vec3 small = Vec3::Constant(2e-4), from(1, 0, 0);
    const auto boxAbout = [&](const Vec3& centre) { return boxMesh(centre - small, centre + small); };
    const Vec3 there = pose(motion, std::vector<double>{2}) * from, beyond = 1.01 * there;
    NeverCollides proof;
    proof.clearance = 1e-4;
    CHECK_FALSE(verifyOnMeshes(boxAbout(there), boxAbout(from), proof, motion).holds());
    CHECK(verifyOnMeshes(boxAbout(beyond), boxAbout(from), proof, motion).holds());
}

TEST_CASE("a box that goes into an open cup far from its walls is nested there, whatever the mouth is near") {
    Case c;
    c.a = boxMesh({-10, -10, -20}, {10, 10, 0});
    std::erase_if(c.a.triangles, [&](const Tri& t) {
        return std::ranges::all_of(t, [&](int v) { return c.a.vertices[v].z() == 0; });
    });
    REQUIRE(c.a.triangles.size() == 10);
    c.b = boxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    for (const double upper : {6.0, -4.0}) {
        c.motion.dofs = {joints::slide(Vec3::UnitZ(), -5, upper)};
        c.motion.dofs[0].rest = upper;
        c.table = makeTable({{Vec3(0, 0, -5), 2}}, {{Vec3::Zero(), 0.5}}, {{0, 0}}, {}, c.motion);
        c.table.certified = true;
        c.table.boundEarly = 0.1;
        INFO(upper);
        CHECK_FALSE(c.verdict().holds());
    }
}

TEST_CASE("a path that is steep for a millionth of its values is cut there, and not along the other DOF") {
    const Case c = boxes(0.5);
    Dof path;
    path.kind = DofKind::Path;
    path.upper = 3;
    path.path = {PathRow{0, {0, 0, 0}, Eigen::Quaterniond::Identity()},
                 PathRow{1e-6, {1, 0, 0}, Eigen::Quaterniond::Identity()},
                 PathRow{3, {1.01, 0, 0}, Eigen::Quaterniond::Identity()}};
    Motion motion;
    motion.dofs = {path, joints::turn({0, 0, 0}, Vec3::UnitZ(), -1, 1)};
    NeverCollides proof;
    proof.clearance = 0.5;
    const MeshVerdict verdict = verifyOnMeshes(c.a, c.b, proof, motion);
    INFO(verdict.reason);
    CHECK(verdict.holds());
    CHECK(verdict.cells < 200);
}

TEST_CASE("what is said does not depend on the number of threads, nor on how often it is asked") {
    std::mt19937_64 random(7);
    Case c = boxes(1.2);
    c.a = lumpyMesh(random, 2, 0.3);
    c.b = transformed(lumpyMesh(random, 2, 0.3), Eigen::Affine3d(Eigen::Translation3d(2, 0, 0)));
    c.motion.dofs = {joints::slide(Vec3::UnitX(), -1, 1), joints::turn({2, 0, 0}, Vec3::UnitZ(), -1, 1)};
    c.table.motion = c.motion;
    c.table.boundEarly.reset();
    const MeshVerdict first = c.verdict();
    const ThreadLimit one(1);
    const MeshVerdict second = c.verdict();
    CHECK(first.reason == second.reason);
    CHECK(first.pose == second.pose);
    CHECK(first.cells == second.cells);
    CHECK(first.work == second.work);
}

TEST_CASE("a proof that would take too long says so and does not hold") {
    Case c = boxes(0.7);
    const MeshVerdict verdict = verifyOnMeshes(c.a, c.b, c.table, c.motion, 1);
    CHECK(verdict.reason.find("effort") != std::string::npos);
    const MeshVerdict stopped =
        verifyOnMeshes(c.a, c.b, c.table, c.motion, 0, [](std::string_view, double) { return false; });
    CHECK(stopped.reason.find("stopped") != std::string::npos);
}
