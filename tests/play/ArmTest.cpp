#include "bake/play/JointPlan.h"
#include "bake/play/MechanismQuery.h"
#include "bake/table/Query.h"
#include "tests/play/Mechanisms.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace mechanisms;

namespace {

/// Links of balls, each turning against the one before about an axis square to that one's; a table for all
/// pairs but neighbours, of all their balls.
SceneModel arm(int joints, int balls) {
    constexpr double length = 1, radius = 0.12;
    SphereSet link;
    for (int k = 0; k < balls; ++k) link.push_back({{0, 0, length * k / (balls - 1)}, radius});
    std::vector<SpherePair> all;
    for (std::uint32_t i = 0; i < link.size(); ++i)
        for (std::uint32_t j = 0; j < link.size(); ++j) all.push_back({i, j});
    SceneModel scene;
    scene.bodies.resize(std::size_t(joints) + 1);
    for (int k = 0; k <= joints; ++k) scene.bodies[k].path = "/Scene/Link" + std::to_string(k);
    for (int k = 0; k < joints; ++k) {
        Joint joint;
        joint.path = "/Scene/Joint" + std::to_string(k);
        joint.body0 = k;
        joint.body1 = k + 1;
        joint.frame0.translation() = Vec3(0, 0, length);
        Dof dof;
        dof.name = "turn";
        dof.axis = Vec3::Unit(k % 2);
        dof.lower = -2.4;
        dof.upper = 2.4;
        joint.dofs = {dof};
        joint.drives.resize(1);
        scene.joints.push_back(joint);
    }
    for (int a = 0; a <= joints; ++a)
        for (int b = a + 2; b <= joints; ++b) {
            Pair pair;
            pair.path = "/Scene/Pair" + std::to_string(a) + "_" + std::to_string(b);
            pair.bodyA = a;
            pair.bodyB = b;
            pair.joints = findChain(scene.joints, a, b).value();
            pair.table = std::make_shared<Table>(makeTable(link, link, all, {}, pairMotion(scene, pair)));
            scene.pairs.push_back(pair);
        }
    return scene;
}

double smallestGap(const SceneModel& scene, const std::vector<double>& values) {
    double least = 1e300;
    for (const Pair& pair : scene.pairs)
        least = std::min(least, query(*pair.table, ownValues(scene, pair, values)).gap);
    return least;
}

/// Pulled towards configurations that touch, in small steps and jumps.
void drive(int joints, int balls, int steps) {
    const SceneModel scene = arm(joints, balls);
    std::vector<std::string> paths;
    for (const Pair& pair : scene.pairs) paths.push_back(pair.path);
    std::vector<std::string> warnings;
    const auto plan = makeJointPlan(scene, paths, &warnings);
    REQUIRE(warnings.empty());
    REQUIRE(plan->groups.size() == 1);
    REQUIRE(plan->valueCount == std::size_t(joints));
    for (int k = 0; k < joints; ++k) REQUIRE(plan->joints[k] == k); // so that values are in file order
    std::vector<JointWorkspace> ws = workspaces(*plan);
    const MechanismQuery mechanism(scene);
    MechanismWorkspace room = mechanism.workspace();

    Random random(5);
    std::vector<double> q(std::size_t(joints), 0.0), hand = q;
    REQUIRE(smallestGap(scene, q) > 0);
    int held = 0, slid = 0;
    for (int i = 0; i < steps; ++i) {
        CAPTURE(i);
        if (i % 80 == 0) do
                hand = anyValues(random, scene);
            while (mechanism.ask(hand.data(), room).verdict != MechanismAnswer::Verdict::Contact);
        const double share = i % 500 == 499 ? 1 : 0.02;
        std::vector<double> asked = q;
        for (std::size_t k = 0; k < q.size(); ++k) asked[k] += share * (hand[k] - q[k]);
        const JointStatus status = resolve(*plan, q, asked, ws)[0].status;
        held += status != JointStatus::Free;
        slid += status == JointStatus::Slid;
        q = asked;
        REQUIRE(smallestGap(scene, q) > 0);
    }
    CAPTURE(held, slid);
    CHECK(20 * held > steps);
    CHECK(slid > 0);
}

} // namespace

TEST_CASE("an arm of seven joints that is driven into itself never goes through") {
    drive(7, 9, 1500);
}

TEST_CASE("an arm of seven joints that is driven into itself never goes through in 100,000 steps",
          "[.long]") {
    drive(7, 9, 100000);
}
