#include "bake/base/Error.h"
#include "bake/model/AddPair.h"
#include "bake/model/CheckIndices.h"
#include "bake/scene/SceneFile.h"

#include "tests/Joints.h"
#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

/// Each index of the scene in turn is one that the scene does not have: the prim must be named.
void expectRefused(const SceneModel& scene, const std::string& path) {
    CAPTURE(path);
    CHECK_THROWS_WITH(checkIndices(scene), Catch::Contains("<" + path + ">: expected the index of a "));
    CHECK_THROWS_WITH(saveScene(scene, "scene.tss"),
                      Catch::Contains("(<" + path + ">): expected the index of a "));
}

template <class Part>
void spoil(std::vector<Part> SceneModel::*parts, int Part::*index) {
    const SceneModel scene = samples::everything();
    REQUIRE(!(scene.*parts).empty());
    for (const int none : {1000, -2}) {
        SceneModel spoilt = scene;
        (spoilt.*parts)[0].*index = none;
        expectRefused(spoilt, (spoilt.*parts)[0].path);
    }
}

template <class Part>
void spoil(std::vector<Part> SceneModel::*parts, std::vector<int> Part::*indices) {
    SceneModel spoilt = samples::everything();
    REQUIRE(!(spoilt.*parts).empty());
    ((spoilt.*parts)[0].*indices).push_back(1000);
    expectRefused(spoilt, (spoilt.*parts)[0].path);
}

} // namespace

TEST_CASE("a scene made in memory whose indices lead nowhere is refused with the prim") {
    CHECK_NOTHROW(checkIndices(samples::everything()));
    spoil(&SceneModel::joints, &Joint::body0);
    spoil(&SceneModel::joints, &Joint::body1);
    spoil(&SceneModel::pairs, &Pair::bodyA);
    spoil(&SceneModel::pairs, &Pair::bodyB);
    spoil(&SceneModel::pairs, &Pair::joints);
    spoil(&SceneModel::muscles, &MuscleModel::body);
    spoil(&SceneModel::muscles, &MuscleModel::bone);
    spoil(&SceneModel::muscles, &MuscleModel::insertionBone);
    spoil(&SceneModel::skins, &SkinModel::body);
    spoil(&SceneModel::skins, &SkinModel::muscles);
    spoil(&SceneModel::skins, &SkinModel::bones);
    SceneModel painted = samples::everything();
    painted.skins.at(0).weights.joints.push_back(-1);
    expectRefused(painted, painted.skins[0].path);
}

TEST_CASE("a pair of bodies that the scene does not have is not added") {
    SceneModel scene;
    scene.bodies.resize(2);
    scene.bodies[0].path = "/Scene/A";
    scene.bodies[1].path = "/Scene/B";
    Motion motion;
    motion.dofs = {joints::slide(Vec3::UnitX(), 0, 5)};
    for (const auto& [a, b] : {std::pair(0, 2), {2, 1}, {-1, 1}, {0, -1}, {1, 1}}) {
        CAPTURE(a, b);
        CHECK_THROWS_AS(addPair(scene, a, b, motion, "Slide"), InputError);
        CHECK(scene.joints.empty());
        CHECK(scene.pairs.empty());
    }
    CHECK_NOTHROW(addJoints(scene, -1, 1, motion, "Slide"));
}
