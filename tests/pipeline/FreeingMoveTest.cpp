#include "bake/pipeline/FreeingMove.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

/// B turns about the Y axis between two walls' worth of angle.
Motion hinge(double lower, double upper) {
    Motion motion;
    Dof dof;
    dof.name = "turn";
    dof.axis = Vec3::UnitY();
    dof.lower = lower;
    dof.upper = upper;
    motion.dofs = {dof};
    return motion;
}

TriangleMesh together(TriangleMesh mesh, const TriangleMesh& other) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Tri& t : other.triangles) mesh.triangles.push_back(t + Tri::Constant(first));
    return mesh;
}

} // namespace

TEST_CASE("a body that overlaps at rest is freed by a shift a little larger than the overlap") {
    for (const double depth : {0.05, 0.3}) {
        INFO("overlap " << depth);
        const TriangleMesh a = boxMesh({-5, -1, -2}, {5, 1, 0}), b = boxMesh({-1, -1, -depth}, {1, 1, 2});
        const auto shifts = freeingMoves(a, b, hinge(-0.01, 0.01)).moves;
        REQUIRE_FALSE(shifts.empty());
        const FreeingMove& last = shifts.back();
        CHECK(last.freeAtRest);
        CHECK(last.free == last.poses);
        CHECK(last.shift.norm() > depth);
        CHECK(last.shift.norm() < depth + 0.02); // the margin, and what turning adds
        CHECK(last.shift.z() > depth);           // up, out of the plate
        CHECK(last.least > 0);
        CHECK(last.least <= last.atRest);
    }
}

TEST_CASE("bodies that are apart at rest need no shift, and those that nothing frees get none") {
    const TriangleMesh plate = boxMesh({-5, -1, -2}, {5, 1, 0});
    CHECK(freeingMoves(plate, boxMesh({-1, -1, 0.1}, {1, 1, 2}), hinge(-1, 1)).moves.empty());
    // Through the middle of a plate a hundred times as large.
    const TriangleMesh wall = boxMesh({-100, -100, -1}, {100, 100, 1}),
                       pin = boxMesh({-1, -1, -20}, {1, 1, 20});
    CHECK(freeingMoves(wall, pin, hinge(-0.1, 0.1)).moves.empty());
}

TEST_CASE("where bodies that are apart at rest touch at most poses, values among those are told") {
    // A bar that turns about its middle into a plate on either side: free only near rest.
    const TriangleMesh plate = boxMesh({-5, -1, -2}, {5, 1, 0}), bar = boxMesh({-4, -1, 0.1}, {4, 1, 1});
    const FreeingMoves none = freeingMoves(plate, bar, hinge(-0.02, 0.02));
    CHECK_FALSE(none.elsewhere);
    const FreeingMoves found = freeingMoves(plate, bar, hinge(-0.02, 0.5));
    CHECK(found.moves.empty());
    REQUIRE(found.elsewhere);
    CHECK(2 * found.elsewhere->touching > found.elsewhere->poses);
    CHECK(found.elsewhere->values.at(0) == Approx(0.27).margin(0.04)); // from 0.025 on
    Motion there = hinge(-0.02, 0.5);
    there.dofs[0].rest = found.elsewhere->values[0];
    CHECK_FALSE(freeingMoves(plate, bar, there).moves.empty());
}

TEST_CASE("where bodies that overlap at rest are apart at other poses, the one with most room is told") {
    // A lever that rests within a post, as where limits were turned about: turned up it is well above.
    const TriangleMesh post = boxMesh({4, -1, -3}, {5, 1, 0.2}),
                       lever = boxMesh({0, -0.5, -0.2}, {6, 0.5, 0.2});
    const FreeingMoves found = freeingMoves(post, lever, hinge(-0.8, 0.1));
    REQUIRE(found.apart);
    CHECK_FALSE(found.elsewhere);
    CHECK(found.apart->values.at(0) == Approx(-0.8));
    CHECK(found.apart->distance > 1);
    CHECK(found.apart->apart > found.apart->poses / 2);
    CHECK(found.apart->apart < found.apart->poses);
    Motion there = hinge(-0.8, 0.1);
    there.dofs[0].rest = found.apart->values[0];
    CHECK_FALSE(freeingMoves(post, lever, there).apart);
    // One that overlaps wherever it is has no such place.
    CHECK_FALSE(freeingMoves(post, boxMesh({-6, -0.5, -0.2}, {6, 0.5, 0.1}), hinge(-0.01, 0.01)).apart);
}

TEST_CASE("a joint that overlaps at rest is freed as far as what stops it elsewhere") {
    // A lever on a block that it is sunk into at one end, with a post near its other end: turning down it
    // meets the post.
    const TriangleMesh a = together(boxMesh({-1, -1, -2}, {1, 1, 0}), boxMesh({9, -1, -4}, {10, 1, -1}));
    const TriangleMesh lever = boxMesh({0, -0.5, -0.2}, {11, 0.5, 0.5});
    Motion motion = hinge(-0.4, 0.25); // up and down
    motion.dofs[0].origin = Vec3(-1, 0, 0.5);
    const auto moves = freeingMoves(a, lever, motion).moves;
    REQUIRE(moves.size() == 1);
    const FreeingMove& move = moves.front();
    CHECK(move.freeAtRest);
    CHECK(move.stops > 0);
    CHECK(move.free + move.stops + 1 >= move.poses); // all, but where contact begins
    CHECK(move.beyond.empty());
    CHECK(move.shift.norm() < 1);
}

TEST_CASE("a joint whose axis is off is freed by a smaller move of its axis than of its body") {
    // A bar that lies in a U with little room; the axis passes beside its middle, so that turning it sweeps
    // it into the walls.
    const TriangleMesh a = together(boxMesh({-2, -1, -1}, {-1, 1, 1}), boxMesh({1, -1, -1}, {2, 1, 1}));
    const TriangleMesh bar = boxMesh({-0.8, -0.5, -0.1}, {1.01, 0.5, 0.1});
    Motion motion = hinge(-0.5, 0.5);
    motion.dofs[0].origin = Vec3(0, 0, 0.4);
    FreeingOptions axes;
    axes.axes = true;
    const auto moves = freeingMoves(a, bar, motion, axes).moves;
    REQUIRE_FALSE(moves.empty());
    CHECK(moves.front().axes.norm() > 0.1);
    CHECK(moves.front().free == moves.front().poses);
    for (std::size_t k = 1; k < moves.size(); ++k) CHECK(moves[k].moved > moves[k - 1].moved);
    CHECK(moves.front().motion.dofs[0].origin.isApprox(motion.dofs[0].origin + moves.front().axes));
}

TEST_CASE("the search for moves ends when its time does, and says so") {
    const TriangleMesh a = boxMesh({-1, -1, -2}, {1, 1, 0}), b = boxMesh({-1, -1, -0.1}, {1, 1, 1});
    FreeingOptions options;
    CHECK(freeingMoves(a, b, hinge(-0.01, 0.01), options).complete);
    CHECK_FALSE(freeingMoves(a, b, hinge(-0.01, 0.01), options).moves.empty());
    options.seconds = 0;
    const FreeingMoves ended = freeingMoves(a, b, hinge(-0.01, 0.01), options);
    CHECK_FALSE(ended.complete);
    CHECK(ended.moves.empty());
}
