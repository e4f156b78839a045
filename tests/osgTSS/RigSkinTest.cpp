#include "Limb.h"

#include <catch2/catch.hpp>
#include <osg/ShapeDrawable>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/UpdateBone>
#include <osgTSS/Bake>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Install>
#include <osgTSS/SkinGeometry>

#include <map>

using namespace osgTSS;

namespace {

/// A rigged sleeve over two bones that its keys bend by 80 degrees in two seconds. On the first bone there is
/// a ball about the elbow, nearly as thick as the sleeve.
struct Arm {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    osg::ref_ptr<osg::Geometry> source =
        Limb::tube(0, Limb::length, Limb::rings, Limb::sides, Limb::radius, true);
    osgAnimation::Bone *upper, *lower;
    Playback playback;

    static constexpr float elbow = 2, ball = 0.45f;

    explicit Arm(const char* words) {
        root->addChild(skeleton);
        skeleton->setDefaultUpdateCallback();
        upper = addBone("Upper", nullptr, osg::Vec3());
        lower = addBone("Lower", upper, osg::Vec3(elbow, 0, 0));
        addKeys();
        addBall();
        osg::ref_ptr<osgAnimation::VertexInfluenceMap> influences = new osgAnimation::VertexInfluenceMap;
        const auto& vertices = static_cast<const osg::Vec3Array&>(*source->getVertexArray());
        for (unsigned int v = 0; v < vertices.size(); ++v) {
            const float share = lowerShare(vertices[v]);
            if (share < 1) (*influences)["Upper"].emplace_back(v, 1 - share);
            if (share > 0) (*influences)["Lower"].emplace_back(v, share);
        }
        for (auto& [name, influence] : *influences) influence.setName(name);
        source->getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D);
        rig->setName("Sleeve");
        rig->setSourceGeometry(source);
        rig->setInfluenceMap(influences);
        if (words) rig->setUserValue("osgTSS:skin", std::string(words));
        geode->addDrawable(rig);
        skeleton->addChild(geode);
    }

    static float lowerShare(const osg::Vec3& point) {
        return osg::clampBetween(point.x() - elbow + 0.5f, 0.f, 1.f);
    }

    void frame(unsigned int number) { playback.frame(*root, number); }

    /// What is drawn.
    const osg::Vec3Array& drawn() const {
        auto* skin = dynamic_cast<SkinGeometry*>(geode->getDrawable(0));
        return skin ? *skin->getVertices() : static_cast<const osg::Vec3Array&>(*rig->getVertexArray());
    }

    /// How deep a vertex is in the ball.
    double depth() const {
        double deepest = 0;
        for (const osg::Vec3& v : drawn())
            deepest = std::max<double>(deepest, ball - (v - osg::Vec3(elbow, 0, 0)).length());
        return deepest;
    }

private:
    osgAnimation::Bone* addBone(const std::string& name, osgAnimation::Bone* parent, const osg::Vec3& at) {
        osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
        const osg::Matrix inSkeleton = osg::Matrix::translate(at);
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrix::inverse(inSkeleton));
        bone->setMatrixInSkeletonSpace(inSkeleton);
        bone->setMatrix(inSkeleton);
        osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(name);
        update->getStackedTransforms().push_back(
            new osgAnimation::StackedMatrixElement("bindmatrix", inSkeleton));
        update->getStackedTransforms().push_back(
            new osgAnimation::StackedQuaternionElement("quaternion", osg::Quat()));
        bone->setUpdateCallback(update);
        (parent ? static_cast<osg::Group&>(*parent) : *skeleton).addChild(bone);
        return bone;
    }

    void addKeys() {
        osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> channel =
            new osgAnimation::QuatSphericalLinearChannel;
        channel->setName("quaternion");
        channel->setTargetName("Lower");
        auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
        for (int k = 0; k <= 4; ++k)
            keys->push_back(osgAnimation::QuatKeyframe(
                0.5 * k, osg::Quat(osg::DegreesToRadians(20.0 * k), osg::Vec3(0, 1, 0))));
        osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
        animation->addChannel(channel);
        animation->setPlayMode(osgAnimation::Animation::ONCE);
        osg::ref_ptr<osgAnimation::BasicAnimationManager> manager = new osgAnimation::BasicAnimationManager;
        manager->registerAnimation(animation);
        manager->playAnimation(animation);
        root->addUpdateCallback(manager);
    }

    void addBall() {
        osg::ref_ptr<osg::ShapeDrawable> shape =
            new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(elbow, 0, 0), ball));
        shape->setUserValue("osgTSS:bone", true);
        osg::ref_ptr<osg::Geode> below = new osg::Geode;
        below->addDrawable(shape);
        upper->addChild(below);
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
