#include "Limb.h"

#include <catch2/catch.hpp>
#include <osg/Material>
#include <osgAnimation/MorphGeometry>
#include <osgTSS/Bake>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Install>
#include <osgTSS/SkinGeometry>

using namespace osgTSS;

namespace {

constexpr float bone = 0.35f;

/// A sleeve about a bone that a morph target draws in to less than the bone is thick.
struct Squeeze {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    osg::ref_ptr<osg::Geometry> rest = sleeve(0.5f);
    osg::ref_ptr<osgAnimation::MorphGeometry> morph = new osgAnimation::MorphGeometry(*sleeve(0.5f));
    Playback playback;
    unsigned int number = 0;

    explicit Squeeze(osgAnimation::MorphGeometry::Method method) {
        const osg::ref_ptr<osg::Geometry> target = sleeve(0.2f);
        if (method == osgAnimation::MorphGeometry::RELATIVE) {
            auto& offsets = static_cast<osg::Vec3Array&>(*target->getVertexArray());
            for (std::size_t v = 0; v < offsets.size(); ++v) offsets[v] -= at(*rest)[v];
        }
        morph->setName("Sleeve");
        morph->setMethod(method);
        morph->setMorphNormals(false);
        morph->addMorphTarget(target, 0);
        morph->setUpdateCallback(new osgAnimation::UpdateMorphGeometry);
        morph->setUserValue("osgTSS:skin", true);
        geode->addDrawable(morph);
        root->addChild(geode);
        const osg::ref_ptr<osg::Geode> inside = new osg::Geode;
        inside->setName("Bone");
        inside->setUserValue("osgTSS:bone", true);
        inside->addDrawable(Limb::tube(1.5f, 2.5f, 9, 16, bone, false));
        root->addChild(inside);
    }

    static osg::ref_ptr<osg::Geometry> sleeve(float radius) {
        return Limb::tube(0, Limb::length, Limb::rings, Limb::sides, radius, true);
    }
    static const osg::Vec3Array& at(const osg::Geometry& geometry) {
        return static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
    }

    void frame(float weight) {
        morph->setWeight(0, weight);
        playback.frame(*root, number++);
    }
    SkinGeometry* shown() const {
        for (unsigned int k = 0; k < geode->getNumDrawables(); ++k)
            if (auto* found = dynamic_cast<SkinGeometry*>(geode->getDrawable(k))) return found;
        return nullptr;
    }
};

/// The nearest that a ring amid the bone comes to its axis.
float thinnest(const osg::Vec3Array& vertices) {
    float least = 1;
    for (int side = 0; side <= Limb::sides; ++side) {
        const osg::Vec3& v = vertices[Limb::at(Limb::rings / 2, side)];
        least = std::min(least, osg::Vec2(v.y(), v.z()).length());
    }
    return least;
}

float farthest(const osg::Vec3Array& a, const osg::Vec3Array& b) {
    float most = 0;
    for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, (a[v] - b[v]).length());
    return most;
}

} // namespace

TEST_CASE("A mesh of morph targets is a skin: what they make of it is kept out of what lies below") {
    const auto method =
        GENERATE(osgAnimation::MorphGeometry::NORMALIZED, osgAnimation::MorphGeometry::RELATIVE);
    Squeeze free(method), held(method);
    const osg::ref_ptr<Scene> scene = osgTSS::bake(*held.root);
    const Installed done = install(*held.root, *scene);
    REQUIRE(done.skins == 1);
    REQUIRE(done.stale == 0);
    SkinGeometry* shown = held.shown();
    REQUIRE(shown);
    CHECK(held.morph->getNodeMask() == 0);
    CHECK(shown->getRestGeometry()->getTexCoordArray(0) == held.morph->getTexCoordArray(0));

    held.frame(0);
    CHECK(shown->getVertices()->asVector() == Squeeze::at(*held.rest).asVector());
    for (const float weight : {0.2f, 0.4f}) { // 0.44 and 0.38 thick: nothing meets
        free.frame(weight);
        held.frame(weight);
        CHECK(farthest(*shown->getVertices(), Squeeze::at(*free.morph)) < 1e-4f);
    }
    for (const float weight : {0.6f, 1.0f}) {
        free.frame(weight);
        held.frame(weight);
        CAPTURE(weight);
        CHECK(thinnest(Squeeze::at(*free.morph)) < bone - 0.02f);
        CHECK(thinnest(*shown->getVertices()) > bone - 0.02f);
        CHECK((*shown->getVertices())[Limb::at(2, 3)].length() ==
              Approx(Squeeze::at(*free.morph)[Limb::at(2, 3)].length()).margin(0.02)); // far from the bone
        for (int ring = 0; ring < Limb::rings; ++ring)
            CHECK((*shown->getVertices())[Limb::at(ring, 0)] ==
                  (*shown->getVertices())[Limb::at(ring, Limb::sides)]);
    }
    held.frame(0);
    CHECK(shown->getVertices()->asVector() == Squeeze::at(*held.rest).asVector());

    held.frame(1);
    CHECK(install(*held.root, *scene).skins == 1); // once more, while it is drawn in
    REQUIRE(held.shown());
    held.frame(1);
    CHECK(thinnest(*held.shown()->getVertices()) > bone - 0.02f);

    uninstall(*held.root);
    CHECK(held.shown() == nullptr);
    CHECK(held.geode->getNumDrawables() == 1);
    CHECK(held.morph->getNodeMask() == ~0u);
    held.frame(1);
    free.frame(1);
    CHECK(Squeeze::at(*held.morph).asVector() == Squeeze::at(*free.morph).asVector());
}

TEST_CASE("A copy of a face that plays is moved by its own weights, and is itself put back") {
    Squeeze original(osgAnimation::MorphGeometry::NORMALIZED);
    const osg::ref_ptr<Scene> scene = osgTSS::bake(*original.root);
    REQUIRE(install(*original.root, *scene).skins == 1);
    original.frame(0);
    const unsigned int all = osg::CopyOp::DEEP_COPY_ALL, some = osg::CopyOp::DEEP_COPY_NODES |
                                                                osg::CopyOp::DEEP_COPY_DRAWABLES |
                                                                osg::CopyOp::DEEP_COPY_CALLBACKS;
    const osg::ref_ptr<osg::Group> copy =
        osg::clone(original.root.get(), osg::CopyOp(GENERATE_COPY(all, some)));
    auto* morph = find<osgAnimation::MorphGeometry>(*copy);
    auto* shown = find<SkinGeometry>(*copy);
    REQUIRE(morph);
    REQUIRE(shown);
    REQUIRE(morph != original.morph);
    morph->setWeight(0, 1);
    original.playback.frame(*copy, 1);
    CHECK(thinnest(*shown->getVertices()) < 0.42f);
    CHECK(thinnest(*shown->getVertices()) > bone - 0.02f);
    uninstall(*copy);
    CHECK(morph->getNodeMask() == ~0u);
    CHECK(find<SkinGeometry>(*copy) == nullptr);
    CHECK(original.morph->getNodeMask() == 0);
}
