#include "bake/report/Accuracy.h"

#include "tests/Joints.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::compare;
using namespace tss::reporting;

namespace {

/// Says contact for values up to one.
std::unique_ptr<CollisionMethod> upTo(double most) {
    return makeMethod({}, [most](const PoseQuery& query) { return query.q[0] <= most; });
}

/// B slides along x out of A, which it leaves at 1: apart by q - 1, and deep by 1 - q where that is small.
ComparedPair sliding(TriangleMesh a, TriangleMesh b) {
    ComparedPair problem{std::move(a), std::move(b), {}, {}, {}, {}, {}, {}};
    problem.motion.dofs = {joints::slide(Vec3::UnitX(), 0, 3)};
    return problem;
}

ComparedPair boxes() {
    return sliding(boxMesh({0, 0, 0}, {1, 1, 1}), boxMesh({0, 0.25, 0.25}, {1, 0.75, 0.75}));
}

} // namespace

TEST_CASE("missed and early contact is measured by how deep and how far apart the meshes are") {
    const ComparedPair problem = boxes();
    const MeshTruth truth(problem.meshA, problem.meshB);
    const JudgedPoses poses(problem, truth, {{0.95}, {0.92}, {0.85}, {1.1}, {1.15}, {1.5}, {2}});
    REQUIRE(poses.leftOut() == 0);
    CHECK(poses.touching() == 3);
    CHECK(poses.freeWithin(0.2) == 2);
    const ErrorFigures late = measureError(*upTo(0.9), poses, 100, 100);
    CHECK(late.poses == 7);
    CHECK(late.touching == 3);
    CHECK(late.missed == 2);
    CHECK(late.early == 0);
    CHECK(late.deepestMiss == Approx(0.08));
    CHECK(late.meanMiss == Approx(0.065));
    CHECK_FALSE(late.sampled);
    const ErrorFigures early = measureError(*upTo(1.2), poses, 100, 100);
    CHECK(early.missed == 0);
    CHECK(early.early == 2);
    CHECK(early.farthestEarly == Approx(0.15));
    CHECK(early.meanEarly == Approx(0.125));
    const ErrorFigures some = measureError(*upTo(0.9), poses, 1, 100);
    CHECK(some.poses == 1);
    CHECK(some.meanMiss == Approx(0.05));
    CHECK(measureError(*upTo(0.9), poses, 100, 1).sampled);
}

TEST_CASE("first contact is off by what a method is late or early on the way to it") {
    const ComparedPair problem = boxes();
    const MeshTruth truth(problem.meshA, problem.meshB);
    const JudgedPoses poses(problem, truth, {{3}, {0.5}, {2}, {0.75}});
    const std::vector<ClosingMotion> motions = closingMotions(problem, truth, poses, 10, 7);
    REQUIRE(motions.size() == 2);
    CHECK(motions[0].contact == Approx(0.8).epsilon(1e-6));
    CHECK(motions[1].contact == Approx(0.8).epsilon(1e-6));
    CHECK(closingMotions(problem, truth, poses, 1, 7).size() == 1);
    const FirstContact late = measureFirstContact(problem, *upTo(0.9), motions, 7);
    CHECK(late.motions == 2);
    CHECK(late.never == 0);
    CHECK(late.worstAngle == Approx(0.1).epsilon(1e-5)); // of a slide: a length
    CHECK(late.meanAngle == Approx(0.1).epsilon(1e-5));
    CHECK(late.worstLength == Approx(0.1).epsilon(1e-5));
    CHECK(late.latest == Approx(0.1).epsilon(1e-5));
    CHECK(late.earliest == 0);
    const FirstContact early = measureFirstContact(problem, *upTo(1.2), motions, 7);
    CHECK(early.earliest == Approx(0.2).epsilon(1e-5));
    CHECK(early.latest == 0);
    const FirstContact half = measureFirstContact(problem, *upTo(0.6), motions, 7);
    CHECK(half.never == 1); // the second way ends before that
    CHECK(half.meanAngle == Approx(0.4).epsilon(1e-5));
}

TEST_CASE("poses at which one body is wholly in the other are left out") {
    const ComparedPair problem =
        sliding(boxMesh({-1, -1, -1}, {1, 1, 1}), boxMesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}));
    const MeshTruth truth(problem.meshA, problem.meshB);
    const JudgedPoses poses(problem, truth, {{0}, {0.5}, {1}, {2}});
    CHECK(poses.leftOut() == 2);
    CHECK(poses.queries().size() == 2);
    CHECK(poses.touches(0));
    CHECK(poses.clearance(1) == Approx(0.9));
}
