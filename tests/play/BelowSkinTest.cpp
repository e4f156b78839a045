#include "bake/play/BelowSkin.h"
#include "tests/BentEllipsoid.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <random>

using namespace tss;

namespace {

/// A muscle that contracts, and a bone that cannot.
BelowSkin muscleAndBone() {
    Muscle muscle = test::bentEllipsoid({});
    muscle.maxContraction = 0.4;
    Muscle bone = test::bentEllipsoid({.origin = {-1, 0, 0.5}, .insertion = {1, 0, 0.5}});
    bone.maxContraction = 0;
    return BelowSkin(
        {std::make_shared<const MuscleDeformer>(muscle), std::make_shared<const MuscleDeformer>(bone)},
        std::vector<UnderSkin>(2));
}

} // namespace

TEST_CASE("depths below a skin are the same with what is remembered of the last step") {
    const BelowSkin below = muscleAndBone();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1.2, 1.2), step(-0.02, 0.02);
    std::vector<Vec3> points;
    for (int k = 0; k < 400; ++k) points.emplace_back(place(random), place(random) / 3, place(random) / 2);
    DepthMemory memory;
    std::vector<char> wasInside(points.size(), 0);
    int crossed = 0;
    for (int s = 0; s < 60; ++s) {
        // The muscle is drawn together and let go, with pauses; the bone swings.
        const std::vector<double> activations{s % 3 ? std::abs(std::sin(0.1 * (s - s % 2))) : 0.5, 0};
        const double angle = 0.3 * std::sin(0.2 * s);
        const std::vector<Pose> poses{Pose::Identity(), Pose(Eigen::AngleAxisd(angle, Vec3::UnitY()))};
        const std::vector<double> now = below.at(activations, poses, memory).depths(points, &memory);
        CHECK(now == below.at(activations, poses).depths(points));
        for (std::size_t k = 0; k < points.size(); ++k) {
            crossed += s > 0 && wasInside[k] != (now[k] > 0);
            wasInside[k] = now[k] > 0;
            points[k] += Vec3(step(random), step(random), step(random));
        }
    }
    CHECK(crossed > 100);
}

TEST_CASE("a shape that has not changed serves again, and one that has does not") {
    const BelowSkin below = muscleAndBone();
    const std::vector<Vec3> points{{0, 0, 0}, {0, 0, 0.5}, {0, 0, 3}};
    DepthMemory memory;
    below.at(std::vector{0.3, 0.0}, {}, memory).depths(points, &memory);
    const auto muscle = memory.shapes.at(0).solid, bone = memory.shapes.at(1).solid;
    below.at(std::vector{0.3, 0.0}, {}, memory).depths(points, &memory);
    CHECK(memory.shapes[0].solid == muscle);
    CHECK(memory.shapes[0].sides[0].free > 0.1);
    below.at(std::vector{0.4, 0.0}, {}, memory).depths(points, &memory);
    CHECK(memory.shapes[0].solid != muscle);
    CHECK(memory.shapes[1].solid == bone);
}
