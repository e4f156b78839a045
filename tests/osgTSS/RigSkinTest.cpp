#include "Character.h"

#include <catch2/catch.hpp>
#include <osg/ShapeDrawable>
#include <osgTSS/Bake>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Install>

using namespace osgTSS;

namespace {

/// A rigged sleeve over two bones that its keys bend by 80 degrees in two seconds. On the first bone there is
/// a ball about the elbow, nearly as thick as the sleeve.
struct Arm : Character {
    static constexpr float elbow = 2, ball = 0.45f;

    explicit Arm(const char* words) {
        addBone("Upper", "", osg::Matrix());
        addBone("Lower", "Upper", osg::Matrix::translate(elbow, 0, 0));
        addKeys("Lower", {turn(0), turn(20), turn(40), turn(60), turn(80)});
        animation->setPlayMode(osgAnimation::Animation::ONCE);
        addBall();
        source->getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D);
        dress(
            [](const osg::Vec3& point) {
                const float share = lowerShare(point);
                return std::map<std::string, float>{{"Upper", 1 - share}, {"Lower", share}};
            },
            words);
    }

    static float lowerShare(const osg::Vec3& point) {
        return osg::clampBetween(point.x() - elbow + 0.5f, 0.f, 1.f);
    }

    /// How deep a vertex is in the ball.
    double depth() const {
        double deepest = 0;
        for (const osg::Vec3& v : drawn())
            deepest = std::max<double>(deepest, ball - (v - osg::Vec3(elbow, 0, 0)).length());
        return deepest;
    }

private:
    void addBall() {
        osg::ref_ptr<osg::ShapeDrawable> shape =
            new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(elbow, 0, 0), ball));
        shape->setUserValue("osgTSS:bone", true);
        osg::ref_ptr<osg::Geode> below = new osg::Geode;
        below->addDrawable(shape);
        bones.at("Upper")->addChild(below);
    }
};

double worst(const osg::Vec3Array& a, const osg::Vec3Array& b, const osg::Vec3Array& rest, float share) {
    double most = 0;
    for (std::size_t v = 0; v < a.size(); ++v)
        if (Arm::lowerShare(rest[v]) == share) most = std::max<double>(most, (a[v] - b[v]).length());
    return most;
}

} // namespace

TEST_CASE("The influences of a rigged mesh are the weights of its skin") {
    Arm arm("");
    ConstraintVisitor visitor;
    arm.root->accept(visitor);
    const tss::SceneModel& model = visitor.getModel();
    REQUIRE(model.skins.size() == 1);
    const tss::SkinModel& skin = model.skins[0];
    const std::size_t count = model.bodies[skin.body].mesh.vertices.size();
    CHECK(count == Limb::rings * Limb::sides + 2);
    CHECK(skin.bones.size() == 1); // the ball's
    REQUIRE(skin.weights.joints.size() == 2);
    CHECK(skin.weights.influences == 2);
    CHECK(skin.weights.weights.size() == 2 * count);
    for (std::size_t v = 0; v < count; ++v)
        CHECK(skin.weights.weights[2 * v] + skin.weights.weights[2 * v + 1] == Approx(1));
}

TEST_CASE("A rigged skin is where osgAnimation puts it where one bone holds it, and out of what lies below") {
    Arm free(nullptr), held("");
    const osg::ref_ptr<Scene> scene = osgTSS::bake(*held.root);
    const Installed done = install(*held.root, *scene);
    REQUIRE(done.skins == 1);
    REQUIRE(done.stale == 0);
    auto* shown = dynamic_cast<SkinGeometry*>(held.geode->getDrawable(0));
    REQUIRE(shown);
    CHECK(shown->getStateSet() == held.source->getStateSet());
    CHECK(shown->getRestGeometry()->getTexCoordArray(0) == held.source->getTexCoordArray(0));
    const auto& rest = static_cast<const osg::Vec3Array&>(*held.source->getVertexArray());
    held.frame(0);
    CHECK(held.drawn().asVector() == rest.asVector());

    double deepest = 0;
    for (unsigned int number = 0; number <= 48; number += 4) {
        free.frame(number);
        held.frame(number);
        deepest = std::max(deepest, free.depth());
        INFO("frame " << number);
        CHECK(held.depth() < 0.01);
        CHECK(worst(free.drawn(), held.drawn(), rest, 0) < 0.01);
        CHECK(worst(free.drawn(), held.drawn(), rest, 1) < 0.01);
        for (int ring = 0; ring < Limb::rings; ++ring)
            CHECK(held.drawn()[Limb::at(ring, 0)] == held.drawn()[Limb::at(ring, Limb::sides)]);
    }
    CHECK(deepest > 0.05);

    uninstall(*held.root);
    held.frame(49);
    free.frame(49);
    CHECK(held.drawn().asVector() == free.drawn().asVector());
}
