// The judge must see what is wrong: it is asked about claims that are known to be false, and known to be so.
#include "bake/base/Error.h"
#include "tests/Shapes.h"
#include "tests/adversary/judge/Attack.h"
#include "tests/adversary/judge/Surfaces.h"
#include "tests/adversary/scenes/Draws.h"

#include <catch2/catch.hpp>

using namespace adversary;

namespace {

/// A ball of radius 1 at the origin and one that slides into it from x = 3 on.
Motion inwards() {
    Motion motion;
    motion.dofs = {slide({-1, 0, 0}, 0, 2)};
    return motion;
}

/// The two balls as one sphere each, of this radius.
tss::Table tableOf(double radius) {
    tss::Table table =
        tss::makeTable({{Vec3::Zero(), radius}}, {{Vec3(3, 0, 0), radius}}, {{0, 0}}, {}, inwards());
    table.certified = true;
    table.boundMiss = 0;
    table.boundEarly = 0.2;
    return table;
}

} // namespace

TEST_CASE("the judge finds contacts that a table misses, reports that are early, and nothing in a true one") {
    const TriangleMesh a = ballMesh(Vec3::Zero(), 1, 2), b = ballMesh({3, 0, 0}, 1, 2);
    const AttackOptions options{2000, 1};
    const Findings good = attackTable(a, b, inwards(), tableOf(1), options);
    CHECK_FALSE(good.failed());
    CHECK(good.contacts > 200);
    CHECK(good.fired > 200);
    CHECK(good.poses >= 2000);
    const Findings late = attackTable(a, b, inwards(), tableOf(1 - 1e-7), options);
    CHECK(late.missed > 0);
    CHECK(late.latest == Approx(2e-7).epsilon(0.01));
    const Findings early = attackTable(a, b, inwards(), tableOf(1.1 + 1e-7), options);
    CHECK(early.early > 0);
    CHECK(early.earliest == Approx(0.2 + 2e-7).epsilon(1e-9));
}

TEST_CASE(
    "a report for a body that stands behind an opening as a whole is early, for one in the opening not") {
    TriangleMesh a = ballMesh(Vec3::Zero(), 1, 3);
    std::erase_if(a.triangles, [&](const tss::Tri& t) { // open towards the other
        return std::all_of(t.begin(), t.end(), [&](int v) { return a.vertices[std::size_t(v)].x() > 0.6; });
    });
    const TriangleMesh b = ballMesh({0.6, 0, 0}, 0.1, 1);
    tss::Table table = tableOf(1);
    table.b[0] = {Vec3(0.6, 0, 0), 0.1};
    const auto judged = [&](double from, double to) {
        Motion motion;
        motion.dofs = {slide({-1, 0, 0}, from, to)};
        motion.dofs[0].rest = from;
        table.motion = motion;
        return attackTable(a, b, motion, table, {300, 1});
    };
    const Findings within = judged(0.4, 0.6), across = judged(-0.05, 0.05);
    CHECK(within.fired >= 100); // of which it soon has enough
    CHECK(within.early >= 100);
    CHECK(across.fired > 200);
    CHECK_FALSE(across.failed());
}

TEST_CASE("the judge measures how late and how early a table with bounds is") {
    const TriangleMesh a = ballMesh(Vec3::Zero(), 1, 2), b = ballMesh({3, 0, 0}, 1, 2);
    tss::Table table = tableOf(0.9);
    CHECK(attackTable(a, b, inwards(), table, {2000, 1}).missed > 0);
    table.boundMiss = 0.2 + 1e-9;
    CHECK_FALSE(attackTable(a, b, inwards(), table, {2000, 1}).failed());
    table.boundMiss = 0.2 - 1e-6;
    CHECK(attackTable(a, b, inwards(), table, {2000, 1}).missed > 0);
}

TEST_CASE("the judge finds where bodies that never collide do, or come nearer than was said") {
    const TriangleMesh a = ballMesh(Vec3::Zero(), 1, 2), b = ballMesh({3, 0, 0}, 1, 2);
    Motion motion = inwards();
    motion.dofs[0].upper = 0.5;
    tss::NeverCollides proof;
    proof.clearance = 0.5 - 1e-9;
    CHECK_FALSE(attackProof(a, b, motion, proof, {1000, 1}).failed());
    proof.clearance = 0.5 + 1e-6;
    CHECK(attackProof(a, b, motion, proof, {1000, 1}).failed());
    motion.dofs[0].upper = 1.0001;
    const Findings deep = attackProof(a, b, motion, proof, {1000, 1});
    CHECK(deep.failed());
    CHECK(deep.contacts > 0);
}

TEST_CASE("contact of exempt parts with each other is none, with anything else it is") {
    const TriangleMesh a = boxMesh({-1, -1, -1}, {1, 1, 0}), b = boxMesh({-1, -1, -0.1}, {1, 1, 1});
    const Pose rest = Pose::Identity(), aside(Eigen::Translation3d(1.5, 0.1, 0));
    tss::RestRegion region;
    const auto whole = [](const TriangleMesh& mesh) {
        std::vector<tss::SurfacePart> parts;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) parts.push_back({t, 1});
        return parts;
    };
    region.a = whole(a);
    CHECK(Surfaces(a, b, region).meet(rest));
    region.b = whole(b);
    CHECK_FALSE(Surfaces(a, b, region).meet(rest));
    CHECK(Surfaces(a, b, region).exemptShareA() == 1);
    // One triangle in halves: a half and its sibling together are the triangle.
    region.b = {{0, 2}, {0, 6}, {0, 7}};
    for (std::uint32_t t = 1; t < b.triangles.size(); ++t) region.b.push_back({t, 1});
    CHECK_FALSE(Surfaces(a, b, region).meet(rest));
    CHECK(Surfaces(a, b, region).exemptShareB() == Approx(1));
    region.b.pop_back();
    const Surfaces less(a, b, region);
    CHECK(less.exemptShareB() < 1);
    CHECK((less.meet(rest) || less.meet(aside)));
}

TEST_CASE("a split surface is the surface") {
    Random random(5);
    const TriangleMesh mesh = ballMesh(Vec3::Zero(), 1, 1);
    std::vector<tss::SurfacePart> parts;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 2)
        parts.push_back({t, 8u + unsigned(random.below(8))});
    const SplitSurface both = split(mesh, parts);
    CHECK(both.exempt.triangles.size() == parts.size());
    CHECK(both.exemptShare == Approx(0.5 / 8).epsilon(0.2));
    for (std::size_t k = 0; k < parts.size(); ++k)
        for (int c = 0; c < 3; ++c)
            CHECK(both.exempt.corner(k, c) == tss::corners(mesh, parts[k])[static_cast<std::size_t>(c)]);
    CHECK(both.other.triangles.size() == mesh.triangles.size() / 2 + 3 * parts.size());
}

TEST_CASE("wires and points are surface to the judge") {
    Random random(3);
    TriangleMesh a = boxMesh({-1, -1, -1}, {1, 1, 0}), b = boxMesh({-1, -1, 2}, {1, 1, 3});
    CHECK_FALSE(Surfaces(a, b, {}).meet(Pose::Identity()));
    for (int k = 0; k < 4; ++k) { // both spellings come
        TriangleMesh wired = b;
        addWire(random, wired, {0.1, 0.2, 2}, {0.1, 0.2, -0.5});
        CHECK(Surfaces(a, wired, {}).surelyMeet(Pose::Identity()));
        CHECK(Surfaces(wired, a, {}).surelyMeet(Pose::Identity()));
        TriangleMesh pointed = b;
        addWire(random, pointed, {0.1, 0.2, 0}, {0.1, 0.2, 0});
        CHECK(Surfaces(a, pointed, {}).surelyMeet(Pose::Identity()));
        CHECK_FALSE(Surfaces(a, pointed, {}).meet(Pose(Eigen::Translation3d(0, 0, 1e-9))));
    }
}

TEST_CASE("seeds give the same scene every time, and each kind what its name says") {
    for (std::uint64_t seed = 0; seed < kinds().size(); ++seed) {
        const NamedDraft first = drawScene(seed), second = drawScene(seed);
        CAPTURE(first.name);
        const auto text = [](const NamedDraft& drawn) -> std::string {
            try {
                return extreme::textOf(sceneOf(drawn.draft, "x"));
            } catch (const tss::InputError& refused) { // limits that leave no pose
                return refused.what();
            }
        };
        CHECK(text(first) == text(second));
        CHECK(first.kind == kinds()[seed].name);
    }
}
