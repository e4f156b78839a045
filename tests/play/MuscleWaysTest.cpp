#include "bake/play/MuscleWays.h"

#include "bake/model/AddPair.h"
#include "bake/model/Kinematics.h"
#include "bake/model/UnderSkin.h"
#include "bake/motion/MuscleSpan.h"
#include "bake/motion/MuscleVolume.h"
#include "bake/play/SkinSetup.h"
#include "tests/BentEllipsoid.h"
#include "tests/Joints.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

constexpr double degree = M_PI / 180;

/// Three bones in a row with a hinge between each two, and a muscle from the first to the last over them.
SceneModel overTwoJoints(double lower, double upper) {
    SceneModel scene;
    const std::vector<std::pair<double, double>> spans{{-150, -35}, {-25, 25}, {35, 150}};
    for (const auto& [from, to] : spans) {
        Body bone;
        bone.path = "/Limb/Bone" + std::to_string(scene.bodies.size());
        bone.mesh = boxMesh({from, -15, -30}, {to, 15, 0});
        scene.bodies.push_back(bone);
    }
    for (int k = 0; k < 2; ++k) {
        Motion motion;
        motion.dofs = {joints::turn({k == 0 ? -30.0 : 30.0, 0, -15}, Vec3::UnitY(), lower, upper)};
        addJoints(scene, k, k + 1, motion, k == 0 ? "First" : "Second");
    }
    test::BentEllipsoid shape;
    shape.origin = {-100, 0, 5};
    shape.insertion = {100, 0, 5};
    shape.bend = 25;
    shape.halfWidth = shape.halfHeight = 10;
    MuscleModel muscle;
    muscle.path = "/Limb/Muscle";
    muscle.muscle = test::bentEllipsoid(shape);
    Body belly;
    belly.path = "/Limb/Belly";
    belly.mesh = muscle.muscle.surface;
    scene.bodies.push_back(belly);
    muscle.body = 3;
    muscle.bone = 0;
    muscle.insertionBone = 2;
    scene.muscles = {muscle};
    return scene;
}

ChainMotion motionAt(const SceneModel& scene, const std::vector<double>& values) {
    const MuscleModel& muscle = scene.muscles[0];
    return muscleMotion(scene, muscle, muscleChain(scene, muscle), posedBodies(scene, values));
}

} // namespace

TEST_CASE("a muscle over two joints goes on where they turn its bones by more than half a turn together") {
    const SceneModel scene = overTwoJoints(0, 110 * degree);
    CHECK_FALSE(muscleWays(scene, scene.muscles[0]).unclear);
    const MuscleDeformer muscle(muscleOf(scene, scene.muscles[0]));
    const auto at = [&](double angle) {
        return MuscleShape(muscle).vertices(0.5, motionAt(scene, {angle, angle}));
    };
    std::vector<Vec3> before = at(0);
    for (double angle = 1; angle <= 110; ++angle) {
        const std::vector<Vec3> now = at(angle * degree);
        double most = 0;
        for (std::size_t v = 0; v < now.size(); ++v) most = std::max(most, (now[v] - before[v]).norm());
        INFO("both by " << angle << " degrees");
        CHECK(most < 8); // the last bone's end moves by 150 a radian and joint
        before = now;
    }
}

TEST_CASE("a muscle follows the bone that it lies on where that never moves against its origin's bone") {
    SceneModel scene = overTwoJoints(0, 100 * degree);
    scene.joints[0].dofs.clear(); // the bone in the middle is fixed to the first one
    scene.bodies[0].mesh = boxMesh({-150, -15, -30}, {-90, 15, 0});
    scene.bodies[1].mesh = boxMesh({-85, -15, -30}, {25, 15, 0});
    SceneModel whole = scene;
    whole.bodies[0].mesh = boxMesh({-150, -15, -30}, {25, 15, 0});
    const auto largest = [](const SceneModel& of, double until) {
        const Muscle muscle = muscleOf(of, of.muscles[0]);
        double most = 0;
        for (std::size_t v = 0; v < muscle.surface.vertices.size(); ++v)
            if (muscle.surface.vertices[v].x() < until) most = std::max(most, muscle.chainShares[v]);
        return most;
    };
    CHECK(largest(scene, -20) == Approx(largest(whole, -20)).epsilon(1e-3));
    CHECK(largest(scene, 100) > 0.9);
    // One that a joint moves is no such bone.
    scene.joints[0].dofs = overTwoJoints(0, 100 * degree).joints[0].dofs;
    CHECK(largest(scene, -20) > 1.2 * largest(whole, -20));
}

TEST_CASE("of the bones that joints pass those count that move by themselves and have a mesh") {
    const SceneModel scene = overTwoJoints(0, 100 * degree);
    const auto chainOf = [](const SceneModel& of) { return muscleChain(of, of.muscles[0]); };
    CHECK(chainOf(scene) == std::vector<int>{1, 2});
    SceneModel other = scene;
    std::swap(other.muscles[0].bone, other.muscles[0].insertionBone);
    CHECK(chainOf(other) == std::vector<int>{1, 0});
    other = scene;
    other.joints[0].dofs.clear(); // moves as the first bone
    CHECK(chainOf(other) == std::vector<int>{2});
    other = scene;
    other.joints[1].dofs.clear(); // as the last
    CHECK(chainOf(other) == std::vector<int>{2});
    other = scene;
    other.bodies[1].mesh = {};
    CHECK(chainOf(other) == std::vector<int>{2});
    other = scene;
    other.bodies[2].mesh = {}; // the fibre tells how it goes from end to end
    CHECK(chainOf(other) == std::vector<int>{2});
    other = scene;
    other.joints[0].enabled = false;
    CHECK(chainOf(other) == std::vector<int>{2});
    other = scene;
    other.muscles[0].insertionBone = -1;
    CHECK(chainOf(other).empty());
}

TEST_CASE("a muscle stays beside each bone that it passes, and keeps its volume") {
    const SceneModel scene = overTwoJoints(0, 100 * degree);
    CHECK(muscleChain(scene, scene.muscles[0]) == std::vector<int>{1, 2});
    const MuscleDeformer muscle(muscleOf(scene, scene.muscles[0]));
    const std::vector<Vec3>& rest = muscle.muscle().surface.vertices;
    for (const std::vector<double>& values : {std::vector<double>{0, 90}, {90, 0}, {60, 60}, {100, 100}}) {
        CAPTURE(values[0], values[1]);
        const std::vector<double> angles{values[0] * degree, values[1] * degree};
        const ChainMotion moved = motionAt(scene, angles);
        const std::vector<Vec3> now = MuscleShape(muscle).vertices(0, moved);
        CHECK(enclosedVolume(now, muscle.closedTriangles()) == Approx(muscle.restVolume()).epsilon(1e-6));
        // Over the middle of the bone that it passes, and at both ends, it goes with what is below it.
        Vec3 off[3] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        int count[3] = {0, 0, 0};
        for (std::size_t v = 0; v < rest.size(); ++v) {
            const double x = rest[v].x();
            const int at = x < -70 ? 0 : x > 70 ? 2 : std::abs(x) < 10 ? 1 : -1;
            if (at < 0) continue;
            const Pose bone = at == 0 ? Pose::Identity() : moved[static_cast<std::size_t>(at - 1)];
            off[at] += now[v] - bone * rest[v];
            ++count[at];
        }
        for (int at = 0; at < 3; ++at) CHECK((off[at] / count[at]).norm() < 4.5);
    }
}

TEST_CASE("where a joint turns a muscle by more than half a turn either way it is said to be unclear") {
    SceneModel scene = overTwoJoints(-200 * degree, 200 * degree);
    CHECK(muscleWays(scene, scene.muscles[0]).unclear);
    scene = overTwoJoints(-110 * degree, 110 * degree); // together farther, each by itself not
    CHECK_FALSE(muscleWays(scene, scene.muscles[0]).unclear);
    for (const Eigen::Vector4d& side : muscleWays(scene, scene.muscles[0]).sides)
        CHECK(side == Eigen::Vector4d(0, 0, 0, 1));
}
