#include "SkinShapes.h"
#include "tests/Shapes.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;

namespace {

constexpr double thickness = 0.15;

Muscle rigid(TriangleMesh mesh) {
    Muscle bone;
    bone.surface = std::move(mesh);
    bone.fibre = {{0, 0, 0}, {0, 0, 1}};
    bone.activationUpper = 0;
    return bone;
}

TriangleMesh flat() {
    return skins::vaultedSheet(32, 1, 0, 0);
}

/// A flat skin, its outer side up, held by a plate below it, and a second bone that moves along z by `travel`
/// and holds none of the skin.
struct Pressed {
    skins::Couple couple;
    SkinParameters parameters;
    std::vector<Pose> moved{Pose::Identity(), Pose::Identity()};

    Pressed(TriangleMesh skin, TriangleMesh bone, double travel)
        : couple(skins::couple(std::move(skin),
                               {rigid(boxMesh({-1, -1, -1}, {1, 1, -0.3})), rigid(std::move(bone))},
                               thickness)) {
        const std::size_t count = couple.skin.vertices.size();
        parameters.shares = {std::vector<double>(count, 1), std::vector<double>(count, 0)};
        moved[1].translation().z() = travel;
        parameters.swings = {BoneSwing{moved}};
    }
};

} // namespace

TEST_CASE("a bone before the outer side of a skin, as a tooth is before a lip's lining, presses it in") {
    constexpr double radius = 0.3, gap = 0.05, travel = -0.2;
    const Pressed pressed(flat(), ballMesh({0, 0, radius + gap}, radius, 4), travel);
    const auto rig = pressed.couple.rig(pressed.parameters);
    SkinResponse response(rig);
    response.update(std::vector<double>{0, 0}, pressed.moved);
    const Vec3 centre(0, 0, radius + gap + travel);
    double deepest = 0, lowest = 0;
    for (const Vec3& x : response.positions()) {
        deepest = std::max(deepest, radius - (x - centre).norm());
        lowest = std::min(lowest, x.z());
    }
    CHECK(deepest < 0.02);
    CHECK(lowest == Approx(gap + travel).margin(0.01));
    response.update(std::vector<double>{0, 0});
    CHECK(skins::exactlyAtRest(response));
}

TEST_CASE("what of a bone is before the skin at rest does not draw it along when it goes away") {
    Pressed pressed(flat(), boxMesh({-0.5, -0.5, 0.02}, {0.5, 0.5, 0.1}), -0.15);
    const std::vector<Pose> away{Pose::Identity(), Pose(Eigen::Translation3d(0, 0, 0.1))};
    pressed.parameters.swings.push_back(BoneSwing{away});
    SkinResponse response(pressed.couple.rig(pressed.parameters));
    response.update(std::vector<double>{0, 0}, away);
    CHECK(skins::exactlyAtRest(response));
}

TEST_CASE(
    "skin that its bone has carried past the far side of a thin muscle is not taken for deep inside of it") {
    Muscle plate = rigid(boxMesh({-0.6, -0.6, -0.03}, {0.6, 0.6, -0.01}));
    plate.fibre = {{-0.6, 0, -0.02}, {0.6, 0, -0.02}};
    plate.activationUpper = 1;
    plate.maxContraction = 0.1;
    const skins::Couple couple =
        skins::couple(flat(), {std::move(plate), rigid(boxMesh({-1, -1, -2}, {1, 1, -1}))}, thickness);
    const std::size_t count = couple.skin.vertices.size();
    SkinParameters parameters;
    parameters.frames = {-1, 0};
    parameters.shares = {std::vector<double>(count, 1)};
    parameters.attach.assign(count, 0);
    const std::vector<Pose> down{Pose::Identity(), Pose(Eigen::Translation3d(0, 0, -0.3))};
    parameters.swings = {BoneSwing{down}};
    const auto rig = std::make_shared<SkinRig>(*couple.rig(parameters));
    std::erase_if(rig->rows, [](const SkinRow& row) { return row.kind != SkinContactKind::SkinOnBody; });
    SkinResponse response(rig);
    std::vector<Pose> little = down;
    little[1].translation().z() = -0.015; // within the plate
    CHECK(response.update(std::vector<double>{0, 0}, little).pushed > 0.004);
    CHECK(response.update(std::vector<double>{0, 0}, down).pushed == 0);
}

namespace {

/// How much deeper than at rest the skin is in a ball of radius 0.3 beside it that moves by 0.05 towards it,
/// in the skin's own plane.
double deeperInBall(double middle) {
    constexpr double radius = 0.3, travel = -0.05;
    const std::vector<Pose> moved{Pose::Identity(), Pose(Eigen::Translation3d(travel, 0, 0))};
    Pressed pressed(flat(), ballMesh({middle, 0, 0}, radius, 4), 0);
    pressed.parameters.swings = {BoneSwing{moved}};
    SkinResponse response(pressed.couple.rig(pressed.parameters));
    response.update(std::vector<double>{0, 0}, moved);
    double deepest = 0;
    for (std::size_t v = 0; v < response.positions().size(); ++v) {
        const Vec3 &rest = response.rig().rest[v], &now = response.positions()[v];
        const double before = std::max(radius - (rest - Vec3(middle, 0, 0)).norm(), 0.0);
        deepest = std::max(deepest, radius - (now - Vec3(middle + travel, 0, 0)).norm() - before);
    }
    response.update(std::vector<double>{0, 0});
    CHECK(skins::exactlyAtRest(response));
    return deepest;
}

} // namespace

TEST_CASE("a bone that comes at the rim of a skin edge on presses it back") {
    CHECK(deeperInBall(1.32) < 0.005);
}

TEST_CASE("skin that is in a bone at rest goes no deeper into it, whichever way it faces") {
    CHECK(deeperInBall(1.2) < 0.005);
}

TEST_CASE("where eight joints move at once, each of their ways is looked at wherever it was sampled") {
    constexpr double radius = 0.1, arm = 1, out = 0.01;
    constexpr int samples = 16, under = 5; // of them: where the ball comes to the skin, and to it alone
    const Vec3 axis(0, 0, -radius - arm), start = axis + Vec3(arm, -2.0 * under / samples, 0);
    const skins::Couple couple = skins::couple(
        flat(), {rigid(boxMesh({-1, -1, -0.5}, {1, 1, -0.3})), rigid(ballMesh(start, radius, 4))}, 0.01);
    SkinParameters parameters;
    parameters.shares = {std::vector<double>(couple.skin.vertices.size(), 1),
                         std::vector<double>(couple.skin.vertices.size(), 0)};
    BoneSwing still, way;
    for (int s = 1; s <= samples; ++s) {
        const Eigen::AngleAxisd turn(-M_PI / 2 * s / under, Vec3::UnitY());
        const Pose moved = Eigen::Translation3d(0, 2.0 * s / samples, 0) * Eigen::Translation3d(axis) * turn *
                           Eigen::Translation3d(-axis);
        still.emplace_back(2, Pose::Identity());
        way.push_back({Pose::Identity(), moved});
    }
    parameters.together.assign(16, still);
    parameters.together.back() = way;
    SkinResponse response(couple.rig(parameters));
    std::vector<Pose> there = way[under - 1];
    there[1].pretranslate(out * Vec3::UnitZ());
    response.update(std::vector<double>{0, 0}, there);
    double highest = 0;
    for (const Vec3& x : response.positions()) highest = std::max(highest, x.z());
    CHECK(highest == Approx(out).margin(0.002));
}
