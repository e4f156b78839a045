#include "bake/pipeline/FreeingShift.h"
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

} // namespace

TEST_CASE("a body that overlaps at rest is freed by a shift a little larger than the overlap") {
    for (const double depth : {0.05, 0.3}) {
        INFO("overlap " << depth);
        const TriangleMesh a = boxMesh({-5, -1, -2}, {5, 1, 0}), b = boxMesh({-1, -1, -depth}, {1, 1, 2});
        const auto shifts = freeingShifts(a, b, hinge(-0.01, 0.01));
        REQUIRE_FALSE(shifts.empty());
        const FreeingShift& last = shifts.back();
        CHECK(last.freeAtRest);
        CHECK(last.free == last.poses);
        CHECK(last.shift.norm() > depth);
        CHECK(last.shift.norm() < depth + 0.1);
        CHECK(last.shift.z() > depth); // up, out of the plate
        CHECK(last.least > 0);
        CHECK(last.least <= last.atRest);
        for (std::size_t k = 1; k < shifts.size(); ++k) {
            CHECK(shifts[k].free > shifts[k - 1].free);
            CHECK(shifts[k].shift.norm() > shifts[k - 1].shift.norm());
        }
    }
}

TEST_CASE("bodies that are apart at rest need no shift, and those that nothing frees get none") {
    const TriangleMesh plate = boxMesh({-5, -1, -2}, {5, 1, 0});
    CHECK(freeingShifts(plate, boxMesh({-1, -1, 0.1}, {1, 1, 2}), hinge(-1, 1)).empty());
    // Through the middle of a plate a hundred times as large.
    const TriangleMesh wall = boxMesh({-100, -100, -1}, {100, 100, 1}),
                       pin = boxMesh({-1, -1, -20}, {1, 1, 20});
    CHECK(freeingShifts(wall, pin, hinge(-0.1, 0.1)).empty());
}
