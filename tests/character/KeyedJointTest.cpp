#include "bake/character/KeyedJoint.h"

#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <random>

using namespace tss;

namespace {

constexpr double keyedDegree = std::numbers::pi / 180;

Pose turnedBy(double angle, const Vec3& axis, const Vec3& about) {
    return Pose(Eigen::Translation3d(about) * Eigen::AngleAxisd(angle, axis.normalized()) *
                Eigen::Translation3d(-about));
}

/// How far the joint's poses at its own values are from the keys.
double keyedJointError(const KeyedPoses& poses, const KeyedJoint& keyed) {
    double worst = 0;
    for (std::size_t k = 0; k < poses.samples.size(); ++k) {
        std::vector<double> values;
        for (const auto& track : keyed.values) values.push_back(track[k]);
        const Pose known = jointPose(keyed.joint, values);
        worst = std::max(worst, (known.matrix() - poses.samples[k].pose.matrix()).cwiseAbs().maxCoeff());
    }
    return worst;
}

} // namespace

TEST_CASE("keys about one axis make a hinge through it, with their range and a twentieth more as limits") {
    KeyedPoses poses;
    for (const double degrees : {10.0, -20.0, 0.0, 30.0})
        poses.samples.push_back(
            {turnedBy(degrees * keyedDegree, {1, 2, 2}, {5, 0, 1}), poses.samples.empty()});
    poses.rest = 2;
    poses.size = 5;
    const KeyedJoint keyed = keyedJoint(poses);
    REQUIRE(keyed.joint.dofs.size() == 1);
    const Dof& turn = keyed.joint.dofs[0];
    CHECK(turn.kind == DofKind::Rotation);
    CHECK(turn.upper - turn.lower == Approx(55 * keyedDegree));
    CHECK(std::abs(turn.rest - (turn.lower + turn.upper) / 2) == Approx(5 * keyedDegree));
    CHECK(keyedJointError(poses, keyed) < 1e-9);
}

TEST_CASE("random turns and slides of a bone are met by its joint at each key") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int round = 0; round < 20; ++round) {
        KeyedPoses poses;
        for (int k = 0; k < 30; ++k) {
            const Vec3 axis(uniform(random), uniform(random), uniform(random));
            Pose pose = turnedBy(1.2 * uniform(random), axis, Vec3::Zero());
            pose.translation() = Vec3(uniform(random), 3 + 0.1 * uniform(random), 0);
            poses.samples.push_back({pose, k == 0});
        }
        poses.size = 3;
        const KeyedJoint keyed = keyedJoint(poses);
        CHECK(keyed.joint.dofs.size() >= 5);
        CHECK(keyedJointError(poses, keyed) < 1e-9);
    }
}

TEST_CASE("keys that turn far about every axis are refused, and where any turn is asked for are met") {
    KeyedPoses poses;
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
        for (int k = 0; k <= 24; ++k) // all the way round each
            poses.samples.push_back({turnedBy(15 * k * keyedDegree, axis, Vec3::Zero()), k == 0});
    CHECK_THROWS_WITH(keyedJoint(poses), Catch::Contains("turn too far about several axes"));
    poses.anyTurn = true;
    const KeyedJoint keyed = keyedJoint(poses);
    CHECK(keyedJointError(poses, keyed) < 1e-9);
    for (const auto& track : keyed.values) // no jumps from one key of a run to the next
        for (std::size_t k = 1; k < track.size(); ++k)
            if (!poses.samples[k].first) CHECK(std::abs(track[k] - track[k - 1]) < 100 * keyedDegree);
}
