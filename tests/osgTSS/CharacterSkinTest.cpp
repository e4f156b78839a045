#include "Character.h"
#include "Heard.h"

#include <catch2/catch.hpp>
#include <osgAnimation/RigTransformHardware>
#include <osgAnimation/StackedScaleElement>
#include <osgTSS/Bake>
#include <osgTSS/Install>

using namespace osgTSS;

namespace {

/// Parts of the sleeve about x = 1 and about x = 2.5 are between two of three bones.
std::map<std::string, float> threeShares(const osg::Vec3& point) {
    const float b = osg::clampBetween(2 * (point.x() - 0.75f), 0.f, 1.f);
    const float c = osg::clampBetween(2 * (point.x() - 2.25f), 0.f, 1.f);
    return {{"A", 1 - b}, {"B", b * (1 - c)}, {"C", b * c}};
}

/// Three bones. at: of the root bone; bent: the second one in the file, against the pose that it is bound in.
struct Tail : Character {
    explicit Tail(float at = 0.01f, double bent = 0) {
        addBone("A", "", osg::Matrix::translate(at, 0, 0));
        addBone("B", "A", osg::Matrix::translate(1, 0, 0), turn(bent));
        addBone("C", "B", osg::Matrix::translate(2.5, 0, 0));
    }
    /// The skin: its sleeve is held; else osgAnimation draws it.
    void wear(bool skin) { dress(threeShares, skin ? "" : nullptr); }

    const osg::Vec3Array& shape() const {
        return static_cast<const osg::Vec3Array&>(*source->getVertexArray());
    }
    osg::Vec3Array& vertices() { return static_cast<osg::Vec3Array&>(*source->getVertexArray()); }
    osg::Vec3Array& normals() { return static_cast<osg::Vec3Array&>(*source->getNormalArray()); }
    osg::Vec2Array& texture() { return static_cast<osg::Vec2Array&>(*source->getTexCoordArray(0)); }
    osg::DrawElementsUInt& triangles() {
        return static_cast<osg::DrawElementsUInt&>(*source->getPrimitiveSet(0));
    }
    /// One more vertex, as another one is.
    unsigned int addLike(unsigned int vertex, const osg::Vec3& away = osg::Vec3()) {
        vertices().push_back(osg::Vec3(vertices()[vertex] + away));
        normals().push_back(osg::Vec3(normals()[vertex]));
        texture().push_back(osg::Vec2(texture()[vertex]));
        return vertices().size() - 1;
    }
    void bend() {
        addKeys("B", {turn(10), turn(40), turn(10)});
        addKeys("C", {turn(10), turn(50), turn(10)});
    }
};

osg::ref_ptr<Scene> held(Tail& tail) {
    const osg::ref_ptr<Scene> scene = osgTSS::bake(*tail.root);
    const Installed done = install(*tail.root, *scene);
    CHECK(done.skins == 1);
    CHECK(done.stale == 0);
    return scene;
}

/// Two that bend alike, of which the first one's sleeve is held.
osg::ref_ptr<Scene> bentAndHeld(Tail& skin, Tail& plain) {
    for (Tail* tail : {&skin, &plain}) {
        tail->bend();
        tail->wear(tail == &skin);
    }
    return held(skin);
}

/// The farthest in some frames that a held sleeve is from one that osgAnimation draws.
double farthest(Tail& skin, Tail& plain, unsigned int first = 0) {
    double most = 0;
    for (unsigned int number = first; number < first + 24; number += 6) {
        skin.frame(number);
        plain.frame(number);
        most = std::max(most, skin.off(plain));
    }
    return most;
}

/// The same of two that are made alike.
template <class Make>
double farthest(const Make& make) {
    Tail skin, plain;
    make(skin);
    skin.wear(true);
    make(plain);
    plain.wear(false);
    const osg::ref_ptr<Scene> scene = held(skin);
    return farthest(skin, plain);
}

} // namespace

TEST_CASE("A root bone that is bound at the origin is bound there, and its skin follows from there") {
    Tail skin(0), plain(0);
    const osg::ref_ptr<Scene> scene = bentAndHeld(skin, plain);
    CHECK(farthest(skin, plain) < 1e-5);
}

TEST_CASE("A bone that no key moves and that stands otherwise than it is bound bends its skin") {
    Tail skin(0.01f, 30), plain(0.01f, 30);
    for (Tail* tail : {&skin, &plain}) tail->addKeys("C", {Tail::turn(0), Tail::turn(50), Tail::turn(0)});
    skin.wear(true);
    plain.wear(false);
    const osg::ref_ptr<Scene> scene = held(skin);
    CHECK(farthest(skin, plain) < 1e-5);
}

TEST_CASE("A bone that is no joint carries its skin from where it is bound") {
    const auto tumble = [](Tail& tail) {
        std::vector<osg::Quat> turns{Tail::turn(30)};
        for (int k = 1; k <= 40; ++k) {
            osg::Quat any(std::sin(k), std::sin(2 * k + 1), std::cos(3 * k), std::cos(5 * k + 2));
            turns.push_back(any /= any.length());
        }
        tail.addKeys("B", turns);
    };
    Tail skin(0.01f, 30), plain(0.01f, 30);
    tumble(skin);
    tumble(plain);
    skin.wear(true);
    plain.wear(false);
    const Heard heard;
    const osg::ref_ptr<Scene> scene = held(skin);
    REQUIRE(heard.times("about several axes") == 1);
    CHECK(farthest(skin, plain) < 1e-5);
    // Made anew while it moves.
    const osg::ref_ptr<Scene> again = held(skin);
    CHECK(farthest(skin, plain, 30) < 1e-5);
}

TEST_CASE("A bone whose keys change its size is named as one whose skin does not") {
    Tail tail;
    tail.bend();
    auto& update = dynamic_cast<osgAnimation::UpdateBone&>(*tail.bones["B"]->getUpdateCallback());
    update.getStackedTransforms().push_back(
        new osgAnimation::StackedScaleElement("scale", osg::Vec3(1, 1, 1)));
    osg::ref_ptr<osgAnimation::Vec3LinearChannel> channel = new osgAnimation::Vec3LinearChannel;
    channel->setName("scale");
    channel->setTargetName("B");
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    keys->push_back(osgAnimation::Vec3Keyframe(0, osg::Vec3(1, 1, 1)));
    keys->push_back(osgAnimation::Vec3Keyframe(1, osg::Vec3(2, 2, 2)));
    tail.animation->addChannel(channel);
    tail.wear(true);
    const Heard heard;
    const osg::ref_ptr<Scene> scene = osgTSS::bake(*tail.root);
    CHECK(heard.times("its keys change its size, which its skin does not follow") == 1);
}

TEST_CASE("A bone that is hidden goes on to carry its skin, and so does one that is taken out") {
    Tail skin, plain;
    const osg::ref_ptr<Scene> scene = bentAndHeld(skin, plain);
    CHECK(farthest(skin, plain) < 1e-5);
    for (Tail* tail : {&skin, &plain}) tail->bones["B"]->setNodeMask(0);
    CHECK(farthest(skin, plain, 24) < 1e-5);
    for (Tail* tail : {&skin, &plain}) tail->bones["B"]->setNodeMask(~0u);
    skin.frame(54);
    const std::vector<osg::Vec3> before = skin.drawn().asVector();
    osg::ref_ptr<osg::Node> out = skin.bones["B"];
    for (const bool kept : {true, false}) {
        skin.bones["A"]->removeChild(skin.bones["B"]);
        if (!kept) out = nullptr;
        skin.frame(kept ? 55 : 56);
        CHECK(skin.drawn().asVector() == before);
    }
}

TEST_CASE("A copy that was made while a character was bent is drawn as it stands from its first frame") {
    Tail first(0.5f), second(0.5f);
    first.bend();
    second.bend();
    first.wear(true);
    second.wear(true);
    const osg::ref_ptr<Scene> scene = held(first);
    install(*second.root, *scene);
    first.frame(0);
    first.frame(12);
    const osg::ref_ptr<osg::Group> copy = osg::clone(first.root.get(), osg::CopyOp::DEEP_COPY_ALL);
    auto* shown = find<SkinGeometry>(*copy);
    REQUIRE(shown);
    auto* bone = find<osgAnimation::Bone>(*copy, "B");
    // As it is bound: nothing has moved since rest.
    find<osgAnimation::Bone>(*copy, "C")->setUpdateCallback(nullptr);
    bone->setUpdateCallback(nullptr);
    bone->setMatrix(osg::Matrix::translate(0.5, 0, 0));
    find<osgAnimation::Bone>(*copy, "C")->setMatrix(osg::Matrix::translate(1.5, 0, 0));
    Playback playback;
    playback.frame(*copy, 0);
    double off = 0;
    for (std::size_t v = 0; v < first.shape().size(); ++v)
        off = std::max<double>(off, ((*shown->getVertices())[v] - first.shape()[v]).length());
    CHECK(off < 1e-5);
}

TEST_CASE("A rigged mesh is no muscle, by name, and goes on to be drawn") {
    Tail held, plain;
    held.bend();
    plain.bend();
    held.wear(false);
    plain.wear(false);
    held.rig->setUserValue("osgTSS:muscle", std::string("contract=0.2"));
    const osg::ref_ptr<osg::Geometry> outer = Limb::tube(0, Limb::length, 17, 12, 0.8f, false);
    outer->setUserValue("osgTSS:skin", true);
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(outer);
    held.skeleton->addChild(geode);
    const Heard heard;
    const osg::ref_ptr<Scene> scene = osgTSS::bake(*held.root);
    CHECK(heard.times("Sleeve: it is no muscle") == 1);
    install(*held.root, *scene);
    CHECK(farthest(held, plain) < 1e-5);
}

TEST_CASE("Of several entries at a vertex's place the one that is drawn says which bones hold it") {
    // As where several meshes share an array, of which others come first.
    Tail skin, plain;
    for (Tail* tail : {&skin, &plain}) {
        tail->bend();
        const unsigned int count = tail->vertices().size();
        for (unsigned int v = 0; v < count; ++v) tail->addLike(v);
        for (auto& corner : tail->triangles()) corner += count;
        tail->wear(tail == &skin);
        for (auto& [bone, influence] : *tail->influences)
            std::erase_if(influence, [&](const auto& held) { return held.first < count; });
    }
    const osg::ref_ptr<Scene> scene = held(skin);
    CHECK(farthest(skin, plain) < 1e-5);
}

TEST_CASE("What is drawn of a skin as lines goes with the surface that it stands on") {
    const double off = farthest([](Tail& tail) {
        tail.bend();
        const osg::ref_ptr<osg::DrawElementsUInt> hair = new osg::DrawElementsUInt(GL_LINES);
        for (int side = 0; side < Limb::sides; ++side) {
            const unsigned int root = Limb::at(28, side);
            hair->push_back(tail.addLike(root));
            hair->push_back(tail.addLike(root, tail.normals()[root] * 0.3f));
        }
        tail.source->addPrimitiveSet(hair);
    });
    CHECK(off < 1e-4);
}

TEST_CASE("Vertices at one place that different bones hold are told of") {
    // As closed lips: two tubes that end in one ring.
    Tail tail;
    tail.bend();
    tail.source = Limb::tube(0, 2, 17, Limb::sides, Limb::radius, true);
    const osg::ref_ptr<osg::Geometry> other = Limb::tube(2, 4, 17, Limb::sides, Limb::radius, true);
    const auto& more = static_cast<const osg::Vec3Array&>(*other->getVertexArray());
    const unsigned int count = tail.vertices().size();
    for (const osg::Vec3& vertex : more) tail.vertices()[tail.addLike(0)] = vertex;
    for (const unsigned int corner : static_cast<osg::DrawElementsUInt&>(*other->getPrimitiveSet(0)))
        tail.triangles().push_back(count + corner);
    tail.dress([](const osg::Vec3&) { return std::map<std::string, float>{{"A", 1.f}}; }, "");
    auto& first = (*tail.influences)["A"];
    auto& second = (*tail.influences)["B"];
    second.assign(first.begin() + count, first.end());
    second.setName("B");
    first.resize(count);
    const Heard heard;
    const osg::ref_ptr<Scene> scene = osgTSS::bake(*tail.root);
    CHECK(heard.times("at 17 places of it stand vertices that different bones hold") == 1);
}

TEST_CASE("A character that is walked about by a transform above its skeleton stays whole") {
    const bool tagged = GENERATE(false, true);
    Tail skin, plain;
    std::vector<osg::ref_ptr<osg::MatrixTransform>> places;
    for (Tail* tail : {&skin, &plain}) {
        tail->bend();
        tail->wear(tail == &skin);
        places.push_back(new osg::MatrixTransform);
        if (tagged) places.back()->setUserValue("osgTSS:moved", true);
        tail->root->removeChild(tail->skeleton);
        places.back()->addChild(tail->skeleton);
        tail->root->addChild(places.back());
    }
    const osg::ref_ptr<Scene> scene = held(skin);
    for (unsigned int number = 0; number < 24; number += 6) {
        for (const auto& place : places) place->setMatrix(osg::Matrix::translate(0.1 * number, 0, 0));
        skin.frame(number);
        plain.frame(number);
        CAPTURE(number);
        CHECK(skin.off(plain) < 1e-5);
    }
}

TEST_CASE("A skin in the place of a mesh that hardware deforms has none of its program") {
    Tail tail;
    tail.bend();
    tail.wear(true);
    tail.source->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    const osg::ref_ptr<osgAnimation::RigTransformHardware> hardware = new osgAnimation::RigTransformHardware;
    hardware->setShader(new osg::Shader(osg::Shader::VERTEX, "void main() { gl_Position = ftransform(); }"));
    tail.rig->setRigTransformImplementation(hardware);
    tail.frame(0);
    tail.frame(1);
    const osg::StateSet* rigged = tail.rig->getStateSet();
    REQUIRE(rigged);
    REQUIRE(rigged->getAttribute(osg::StateAttribute::PROGRAM));
    const osg::ref_ptr<Scene> scene = held(tail);
    const osg::StateSet* state = tail.geode->getDrawable(0)->getStateSet();
    REQUIRE(state);
    CHECK(state->getAttribute(osg::StateAttribute::PROGRAM) == nullptr);
    CHECK(state->getMode(GL_BLEND) == osg::StateAttribute::ON);
    uninstall(*tail.root);
    CHECK(tail.geode->getDrawable(0)->getStateSet() == rigged);
    CHECK(rigged->getAttribute(osg::StateAttribute::PROGRAM));
}

TEST_CASE("A copy of a character's nodes and drawables has a mesh of its own when both are put back") {
    Tail tail;
    tail.bend();
    tail.wear(true);
    const osg::ref_ptr<Scene> scene = held(tail);
    const osg::ref_ptr<osg::Group> copy = osg::clone(
        tail.root.get(), osg::CopyOp(osg::CopyOp::DEEP_COPY_NODES | osg::CopyOp::DEEP_COPY_DRAWABLES |
                                     osg::CopyOp::DEEP_COPY_CALLBACKS));
    uninstall(*copy);
    uninstall(*tail.root);
    auto* mesh = find<osgAnimation::RigGeometry>(*copy);
    REQUIRE(mesh);
    CHECK(mesh != tail.rig.get());
    CHECK(find<osgAnimation::RigGeometry>(*tail.root) == tail.rig.get());
}
