#include "bake/fill/NestedBodies.h"

#include "bake/check/VerifyPair.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/model/AddPair.h"
#include "bake/pipeline/Bake.h"
#include "bake/pipeline/FillPair.h"
#include "bake/table/Query.h"
#include "bake/verify/Nesting.h"
#include "tests/Joints.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

/// A small ball on a slide along x through a large one about the origin.
struct Through {
    TriangleMesh large = ballMesh(Vec3::Zero(), 2, 3), small = ballMesh({0, 0.3, 0}, 0.3, 2);
    Motion motion;

    explicit Through(double from, double to) { motion.dofs = {joints::slide(Vec3::UnitX(), from, to)}; }
    Nesting nesting(double reach) const { return findNested(Solid(large), Solid(small), motion, reach); }
};

bool decided(const Nesting& nesting) {
    return !nesting.undecided;
}

SceneModel sceneOf(const Through& through, bool swapped, const std::string& tolerance) {
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "Scene";
    for (const auto& [name, mesh] :
         {std::pair("Large", &through.large), std::pair("Small", &through.small)}) {
        Body body;
        body.path = std::string("/Scene/") + name;
        body.mesh = *mesh;
        scene.bodies.push_back(body);
    }
    const int pair = addPair(scene, swapped ? 1 : 0, swapped ? 0 : 1, through.motion, "Slide");
    scene.pairs[pair].settings["tolerance"] = tolerance;
    return scene;
}

/// Full turns about a point, about axes that lie askew to each other.
void addTurns(Motion& motion, const Vec3& about, int count) {
    const Vec3 axes[] = {{1, 0.1, 0.2}, {0.2, 1, -0.1}, {-0.1, 0.2, 1}, {1, 1, 0.3}};
    for (int k = 0; k < count; ++k) motion.dofs.push_back(joints::turn(about, axes[k % 4], -3.1, 3.1));
}

} // namespace

TEST_CASE("a body that comes to stand inside a closed one makes it hollow, one that only dips in does not") {
    CHECK(Through(-4, 4).nesting(0.1).outer.a);
    CHECK_FALSE(Through(-4, 4).nesting(0.1).outer.b);
    // Where it is deepest in, its far side is still out.
    const Nesting dips = Through(1.85, 4).nesting(0.1);
    CHECK_FALSE(dips.outer);
    CHECK(decided(dips));
    // Wholly inside, but nowhere with the surfaces that far apart.
    const Nesting near = Through(-4, 4).nesting(4);
    CHECK_FALSE(near.outer);
    CHECK(decided(near));
    // A range that no sample of a coarse grid would meet: inside for a thousandth of it.
    Through narrow(-3000, 3000);
    narrow.motion.dofs[0].lower -= 0.37;
    CHECK(narrow.nesting(0.1).outer.a);
}

TEST_CASE("the body that stands still may be the one inside, and a part of a body alone may be") {
    Through through(-4, 4);
    const Solid large(through.large), small(through.small);
    Motion turned = through.motion;
    turned.dofs.push_back(joints::turn({0.1, 0, 0}, Vec3::UnitZ(), -3, 3));
    const Nesting other = findNested(small, large, turned, 0.1);
    CHECK(other.outer.b);
    CHECK_FALSE(other.outer.a);
    // A second part that stays outside: the first one is inside all the same.
    append(through.small, ballMesh({0, 9, 0}, 0.5, 1));
    CHECK(through.nesting(0.1).outer.a);
    // Not while the surfaces of another part are near.
    Through both(-0.2, 0.2);
    append(both.small, ballMesh({0, 2.3, 0}, 0.27, 1));
    const Nesting touched = both.nesting(0.2);
    CHECK_FALSE(touched.outer);
    CHECK(decided(touched));
}

TEST_CASE(
    "what could not be decided is bounded by how wide the bodies are, and that is proven without a look") {
    const Through through(-4, 12); // whose middle is outside
    const Solid large(through.large), small(through.small);
    const auto never = [](std::string_view, double) { return false; };
    const Nesting stopped = findNested(large, small, through.motion, 0.1, never);
    CHECK(stopped.undecided.a);
    // The ball of radius 2 stands about the other's centre: no deeper than that.
    CHECK(stopped.apart() > 1.9);
    CHECK(stopped.apart() < 2.01);
    TriangleMesh opened = through.large;
    opened.triangles.erase(opened.triangles.begin(), opened.triangles.begin() + 4);
    CHECK(std::isinf(findNested(Solid(opened), small, through.motion, 0.1, never).apart()));

    const verify::VerifiedBody a(through.large), b(through.small);
    const std::vector<verify::MeshTest> tests{{Vec3::Zero(), Vec3(0, 0.3, 0), 2.3, 0, 0, 0}};
    const auto prove = [&](double early) {
        return verify::proveNoNesting(a, b, through.motion, 10, tests, early, {});
    };
    CHECK(prove(stopped.apart()).reason.empty());
    CHECK(prove(stopped.apart()).cells == 0);
    CHECK_FALSE(prove(0.5).reason.empty()); // inside by more
}

TEST_CASE("over many DOFs a body of which that could not be decided is hollow: contact is early by little") {
    const SceneModel scene = sceneOf(Through(-4, 12), false, "0.05");
    Motion motion = pairMotion(scene, scene.pairs[0]);
    addTurns(motion, {0, 0.3, 0}, 3);
    const auto notNested = [](std::string_view step, double) { return step != "nested bodies"; };
    BakeOptions options;
    options.tolerance = 0.05;
    const PairSpheres spheres = fillToTestAll(scene, scene.pairs[0], motion, options, notNested);
    CHECK(spheres.a.hollow);
    CHECK_FALSE(spheres.b.hollow); // which has no room for the other
    CHECK(spheres.a.enclosed < 0.5);
    CHECK(spheres.protrusions < 0.5);
}

TEST_CASE("where a body inside another is contact both are solid, and the bound is of how deep it is") {
    Through through(-4, 4);
    through.motion.dofs[0].rest = 4;
    for (const bool opened : {false, true}) {
        CAPTURE(opened);
        if (opened) // behind which nobody looks for the other body
            std::erase_if(through.large.triangles, [&](const Tri& t) {
                return std::ranges::all_of(t, [&](int v) { return through.large.vertices[v].z() > 1.8; });
            });
        SceneModel scene = sceneOf(through, false, "0.05");
        bake(scene, {});
        REQUIRE(scene.pairs[0].table);
        CHECK_FALSE(query(*scene.pairs[0].table, std::vector{0.0}).hit());
        scene.pairs[0].settings["inside"] = "contact";
        bake(scene, {});
        const Pair& pair = scene.pairs[0];
        REQUIRE(pair.table);
        CHECK(query(*pair.table, std::vector{0.0}).hit());
        CHECK_FALSE(query(*pair.table, std::vector{4.0}).hit());
        CHECK(pair.table->boundEarly.has_value() == !opened);
        if (!opened) CHECK(*pair.table->boundEarly == Approx(2).epsilon(0.01));
        const PairVerdict verdict = verifyPair(scene, pair);
        INFO(verdict.reason);
        CHECK(verdict.holds());
    }
}

TEST_CASE("over many DOFs a body inside another makes none hollow where it is contact") {
    Through through(-4, 12);
    through.motion.dofs[0].rest = 12; // not inside at rest, which is no contact whatever is asked for
    const SceneModel scene = sceneOf(through, false, "0.05");
    Motion motion = pairMotion(scene, scene.pairs[0]);
    addTurns(motion, {0, 0.3, 0}, 3);
    BakeOptions options;
    options.tolerance = 0.05;
    options.inside = Inside::Contact;
    const PairSpheres spheres = fillToTestAll(scene, scene.pairs[0], motion, options, {});
    CHECK_FALSE(spheres.a.hollow);
    CHECK_FALSE(spheres.b.hollow);
    CHECK(spheres.a.enclosed == Approx(2).epsilon(0.01));
    CHECK(spheres.protrusions < 0.5);
}

TEST_CASE("planes that keep a body out of another keep that one from being hollow") {
    Through through(-4, 4);
    through.motion.dofs.push_back(joints::slide(Vec3::UnitY(), 0, 4));
    through.motion.dofs[0].rest = 0;
    through.motion.dofs[1].rest = 3;
    through.motion.planes = {{{0, -1}, -2.05}};
    const Nesting above = through.nesting(0.1);
    CHECK_FALSE(above.outer);
    CHECK(decided(above));
    through.motion.planes = {{{0, -1}, -1}};
    CHECK(through.nesting(0.1).outer.a);
}

TEST_CASE("random bodies that meet and part are decided, and as poses say") {
    int nested = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        CAPTURE(seed);
        std::mt19937_64 random(seed);
        const TriangleMesh a = lumpyMesh(random, 2, 0.3);
        const TriangleMesh b = transformed(lumpyMesh(random, 1, 0.2),
                                           Eigen::Affine3d(Eigen::Translation3d(uniformPoint(random, 1))) *
                                               Eigen::UniformScaling<double>(uniform(random, 0.1, 0.6)));
        Motion motion;
        motion.dofs = {joints::slide(Vec3::UnitX(), uniform(random, -1.5, 0), uniform(random, 0, 1.5)),
                       joints::turn(uniformPoint(random, 1), Vec3::UnitZ(), -0.6, 0.6)};
        const double reach = 0.05;
        const Nesting nesting = findNested(Solid(a), Solid(b), motion, reach);
        CHECK(decided(nesting));
        const MeshQuery surfaceA(a), surfaceB(b);
        bool seen = false;
        for (int i = 0; i < 900; ++i) {
            const auto value = [&](const Dof& dof, int k) {
                return dof.lower + (dof.upper - dof.lower) * k / 29;
            };
            const Pose at = pose(
                motion, std::vector<double>{value(motion.dofs[0], i % 30), value(motion.dofs[1], i / 30)});
            seen = seen || (surfaceA.inside(at * b.vertices[0]) && surfaceA.apart(surfaceB, at, reach));
        }
        nested += seen;
        if (seen) CHECK(nesting.outer.a);
    }
    CHECK(nested > 2);
    CHECK(nested < 12);
}

TEST_CASE("a body on its way through a closed one is in contact where their surfaces are and nowhere else") {
    const bool swapped = GENERATE(false, true);
    CAPTURE(swapped);
    const Through through(-4, 4);
    SceneModel scene = sceneOf(through, swapped, "0.05");
    const auto reports = bake(scene, {});
    const Pair& pair = scene.pairs[0];
    REQUIRE(pair.table);
    CHECK(pair.table->boundMiss == 0);
    CHECK(pair.table->boundEarly <= 0.1);
    const Motion motion = pairMotion(scene, pair);
    const MeshQuery a(scene.bodies[pair.bodyA].mesh), b(scene.bodies[pair.bodyB].mesh);
    int touching = 0;
    for (int i = 0; i <= 400; ++i) {
        const std::vector<double> q{-4 + 0.02 * i};
        const double distance = a.distanceTo(b, pose(motion, q));
        const bool hit = query(*pair.table, q).hit();
        if (distance == 0) CHECK(hit);
        if (hit) CHECK(distance <= pair.table->boundEarly.value());
        touching += distance == 0;
    }
    CHECK(touching > 20);
}

TEST_CASE(
    "a body that comes through an opening as a whole makes an open mesh hollow, one that looks in does not") {
    const auto open = [](Through through) { // towards +x, where the small one comes from
        std::erase_if(through.large.triangles, [&](const Tri& t) {
            return std::all_of(t.begin(), t.end(),
                               [&](int v) { return through.large.vertices[std::size_t(v)].x() > 1.6; });
        });
        return through;
    };
    CHECK(open(Through(-1, 4)).nesting(0.1).outer.a);
    // In by a hair, for a range that samples do not meet.
    Through narrow = open(Through(-1500, 1500));
    narrow.motion.dofs[0].lower -= 0.37;
    CHECK(narrow.nesting(0.1).outer.a);
    const Nesting looks = open(Through(1.6, 4)).nesting(0.1);
    CHECK_FALSE(looks.outer);
    CHECK(decided(looks));
}

TEST_CASE("a body that stands behind an opening is reported where surfaces are near, by all methods") {
    const std::string spheres = GENERATE("medial", "shrinking");
    CAPTURE(spheres);
    Through through(-0.5, 4);
    std::erase_if(through.large.triangles, [&](const Tri& t) {
        return std::all_of(t.begin(), t.end(),
                           [&](int v) { return through.large.vertices[std::size_t(v)].x() > 1.6; });
    });
    SceneModel scene = sceneOf(through, false, "0.05");
    scene.pairs[0].settings["spheres"] = spheres;
    bake(scene, {});
    const Pair& pair = scene.pairs[0];
    REQUIRE((pair.table || pair.proof));
    const PairVerdict verdict = verifyPair(scene, pair);
    INFO(verdict.reason);
    CHECK(verdict.holds());
    if (pair.table) CHECK_FALSE(query(*pair.table, std::vector{0.0}).hit());
}

TEST_CASE("a body that stays inside a closed one, surfaces apart, never collides with it") {
    SceneModel scene = sceneOf(Through(-0.5, 0.5), false, "0.05");
    bake(scene, {});
    REQUIRE(scene.pairs[0].proof);
    CHECK(scene.pairs[0].proof->clearance > 0.5);
    CHECK(scene.pairs[0].proof->clearance < 1.2);
}

namespace {

/// A ball of radius 1 about the origin, stretched.
TriangleMesh ellipsoid(const Vec3& radii) {
    return transformed(ballMesh(Vec3::Zero(), 1, 2), Eigen::Affine3d(Eigen::Scaling(radii)));
}

} // namespace

TEST_CASE("a body that has no room in another never stands inside, over however many DOFs") {
    const Solid plate(ellipsoid({2, 2, 0.4})), ball(ballMesh({0.3, 0, 0}, 0.6, 2));
    Motion motion;
    addTurns(motion, {0, 0, 3}, 4);
    addTurns(motion, {0, 3, 0}, 3);
    for (const Nesting& nesting :
         {findNested(plate, ball, motion, 0.05), findNested(ball, plate, motion, 0.05)}) {
        CHECK_FALSE(nesting.outer);
        CHECK(decided(nesting));
    }
}

TEST_CASE("turns of a body about its own middle do not hide that it stays away") {
    const Solid large(ballMesh(Vec3::Zero(), 1, 2)), small(ballMesh({5, 0, 0}, 0.3, 1));
    Motion motion;
    addTurns(motion, Vec3::Zero(), 1);
    addTurns(motion, {5, 0, 0}, 4);
    CHECK(decided(findNested(large, small, motion, 0.05)));
    // The body that turns is the larger one.
    const Solid turning(ballMesh({5, 0, 0}, 1, 2)), still(ballMesh(Vec3::Zero(), 0.3, 1));
    CHECK(decided(findNested(still, turning, motion, 0.05)));
}

TEST_CASE("what a part encloses tells that it sticks out, however the part is turned") {
    const Solid spindle(ellipsoid({4, 1, 1}));
    const Solid ball(ballMesh({3.4, 0, 0}, 0.7, 2)); // sticks out of the spindle's end
    Motion motion;
    motion.dofs = {joints::slide(Vec3::UnitX(), -0.2, 0.2)};
    addTurns(motion, {3.4, 0, 0}, 4);
    const Nesting nesting = findNested(spindle, ball, motion, 0.05);
    CHECK_FALSE(nesting.outer);
    CHECK(decided(nesting));
}

TEST_CASE("a pose inside is found over many DOFs, and only while the surfaces there are apart") {
    const Solid large(ellipsoid({1, 0.5, 0.45}));
    const Solid small(
        transformed(ellipsoid({0.8, 0.3, 0.3}), Eigen::Affine3d(Eigen::Translation3d(0, 0, 6))));
    Motion motion;
    addTurns(motion, {0, 0, 2}, 2);
    addTurns(motion, {0, 0, 4}, 2);
    addTurns(motion, {0, 0, 6}, 3);
    CHECK(findNested(large, small, motion, 0.05).outer.a);
    CHECK_FALSE(findNested(large, small, motion, 0.4).outer.a);
}

TEST_CASE("what the effort will not suffice for is given up soon, and a pose inside found all the same") {
    double done = 0;
    const auto note = [&](std::string_view, double share) { return done = std::max(done, share), true; };
    Motion chain;
    addTurns(chain, {0, 0, 2}, 2);
    addTurns(chain, {0, 0, 4}, 2);
    addTurns(chain, {0, 0, 6}, 3);
    const Solid far(transformed(ellipsoid({0.8, 0.3, 0.3}), Eigen::Affine3d(Eigen::Translation3d(0, 0, 6))));
    CHECK(findNested(Solid(ellipsoid({1, 0.5, 0.45})), far, chain, 0.05, note).outer.a);
    CHECK(done > 0.03);
    CHECK(done < 0.2);

    // Half out of the ball wherever it goes: soon shown where it does not go far, else not at all.
    const Solid ball(ballMesh(Vec3::Zero(), 1, 2)), spindle(ellipsoid({0.9, 0.3, 0.3}));
    const auto nesting = [&](double reaches) {
        Motion motion;
        for (const Vec3 axis : {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()})
            motion.dofs.push_back(joints::slide(axis, 0.7 - reaches, 0.7 + reaches));
        addTurns(motion, Vec3::Zero(), 3);
        done = 0;
        return findNested(ball, spindle, motion, 0.05, note);
    };
    CHECK(decided(nesting(0.2)));
    CHECK(done > 0.05); // longer than it takes to tell what will not end
    CHECK_FALSE(decided(nesting(0.4)));
    CHECK(done < 0.2);
}

TEST_CASE("a body crosses another all the while where one point of it stays inside and one outside") {
    TriangleMesh small = ballMesh(Vec3::Zero(), 0.3, 2);
    append(small, ellipsoid({4, 0.1, 0.1})); // goes through, beside the part that is inside
    Motion motion;
    for (const Vec3 axis : {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()})
        motion.dofs.push_back(joints::slide(axis, -0.2, 0.2));
    const Nesting nesting = findNested(Solid(ballMesh(Vec3::Zero(), 2, 3)), Solid(small), motion, 1e-4);
    CHECK_FALSE(nesting.outer);
    CHECK(decided(nesting));
}

TEST_CASE("a body whose waist sticks out of another's is not inside, though its ends are") {
    const auto waisted = [](double length, double waist, double ends) {
        TriangleMesh mesh = ballMesh(Vec3::Zero(), 1, 3);
        for (Vec3& v : mesh.vertices) {
            const double width = waist + ends * v.x() * v.x();
            v = Vec3(length * v.x(), width * v.y(), width * v.z());
        }
        return mesh;
    };
    Motion motion;
    for (const Vec3 axis : {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()})
        motion.dofs.push_back(joints::slide(axis, -0.02, 0.02));
    TriangleMesh small = waisted(2.4, 0.3, 1);
    small.triangles.pop_back(); // no ball in it tells
    const Nesting nesting = findNested(Solid(waisted(3, 0.25, 3)), Solid(small), motion, 1e-4);
    CHECK_FALSE(nesting.outer);
    CHECK(decided(nesting));
}
