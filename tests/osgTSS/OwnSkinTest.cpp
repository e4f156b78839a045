#include "Heard.h"
#include "Limb.h"

#include "bake/model/UnderSkin.h"

#include <catch2/catch.hpp>
#include <osgAnimation/MorphGeometry>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>
#include <osgTSS/Bake>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Install>
#include <osgTSS/SkinGeometry>

#include <sstream>

using namespace osgTSS;

namespace {

/// A limb that plays.
struct Played {
    explicit Played(Limb& limb)
        : limb(limb), scene(osgTSS::bake(*limb.root)), done(install(*limb.root, *scene)) {}

    SkinGeometry& shown() const {
        auto* found = dynamic_cast<SkinGeometry*>(limb.skinGeode->getDrawable(0));
        REQUIRE(found);
        return *found;
    }
    void frame() { playback.frame(*limb.root, number++); }

    Limb& limb;
    osg::ref_ptr<Scene> scene;
    Installed done;
    Playback playback;
    unsigned int number = 0;
};

const osg::Vec3Array& verticesOf(const osg::Geometry& geometry) {
    return static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
}

/// Where the hinge takes a point of the lower half.
osg::Vec3 turned(const Limb& limb, const osg::Vec3& point) {
    osg::Matrix matrix;
    limb.hinge->computeLocalToWorldMatrix(matrix, nullptr);
    return point * matrix;
}

} // namespace

TEST_CASE("A tagged geometry is a skin over the tagged bones and muscles, one vertex for each place") {
    Limb limb;
    ConstraintVisitor visitor;
    limb.root->accept(visitor);
    const tss::SceneModel& model = visitor.getModel();
    REQUIRE(model.skins.size() == 1);
    REQUIRE(model.muscles.size() == 1);
    CHECK(model.skins[0].bones.size() == 2);
    CHECK(model.skins[0].muscles.size() == 1);
    const tss::TriangleMesh& mesh = model.bodies[model.skins[0].body].mesh;
    CHECK(mesh.vertices.size() == Limb::rings * Limb::sides + 2);
    CHECK(model.muscles[0].muscle.maxContraction == 0.2);
    const auto& fibre = model.muscles[0].muscle.fibre;
    CHECK((fibre.back() - fibre.front()).norm() > 1.0);
}

TEST_CASE("A skin on one's own geometry looks at rest as that does, and keeps its state and its texture") {
    Limb limb;
    Played played(limb);
    REQUIRE(played.done.skins == 1);
    REQUIRE(played.done.stale == 0);
    played.frame();
    const SkinGeometry& shown = played.shown();
    CHECK(shown.getName() == "Sleeve");
    CHECK(shown.getStateSet() == limb.skin->getStateSet());
    const osg::Geometry& rest = *shown.getRestGeometry();
    CHECK(rest.getTexCoordArray(0) == limb.skin->getTexCoordArray(0));
    CHECK(rest.getPrimitiveSet(0) == limb.skin->getPrimitiveSet(0));
    CHECK(shown.getVertices()->asVector() == verticesOf(*limb.skin).asVector());
    CHECK(shown.getNormals()->asVector() ==
          static_cast<const osg::Vec3Array&>(*limb.skin->getNormalArray()).asVector());

    uninstall(*limb.root);
    CHECK(limb.skinGeode->getDrawable(0) == limb.skin);
    CHECK(limb.muscleGeode->getDrawable(0) == limb.muscle);
}

TEST_CASE("Skin follows the bones that it lies on, and a seam moves as one") {
    Limb limb;
    Played played(limb);
    limb.bend(60);
    played.frame();
    const osg::Vec3Array& now = *played.shown().getVertices();
    const osg::Vec3Array& rest = verticesOf(*limb.skin);
    double upper = 0, lower = 0, turnedBy = 0;
    for (int ring = 0; ring < Limb::rings; ++ring) {
        CHECK(now[Limb::at(ring, 0)] == now[Limb::at(ring, Limb::sides)]);
        for (int side = 0; side < Limb::sides; ++side) {
            const osg::Vec3 was = rest[Limb::at(ring, side)], is = now[Limb::at(ring, side)];
            if (was.x() < 0.7f) upper = std::max<double>(upper, (is - was).length());
            if (was.x() > 3.3f) lower = std::max<double>(lower, (is - turned(limb, was)).length());
            if (was.x() > 3.3f) turnedBy = std::max<double>(turnedBy, (is - was).length());
        }
    }
    CHECK(upper < 0.02);
    CHECK(lower < 0.02);
    CHECK(turnedBy > 1);
}

TEST_CASE("A muscle that is told to shorten by a user value bulges the skin over it") {
    Limb limb;
    Played played(limb);
    played.frame();
    limb.muscle->setUserValue("osgTSS:activation", 1.0);
    played.frame();
    const osg::Vec3Array& now = *played.shown().getVertices();
    const osg::Vec3Array& rest = verticesOf(*limb.skin);
    double out = 0, far = 0;
    for (std::size_t v = 0; v < rest.size(); ++v) {
        out = std::max<double>(out, now[v].z() - rest[v].z());
        if (rest[v].x() > 3) far = std::max<double>(far, (now[v] - rest[v]).length());
    }
    const auto* belly = dynamic_cast<const SkinGeometry*>(limb.muscleGeode->getDrawable(0));
    REQUIRE(belly);
    double thicker = 0;
    for (const osg::Vec3& v : *belly->getVertices()) thicker = std::max<double>(thicker, v.z());
    CHECK(thicker > 0.43); // 0.42 at rest
    CHECK(out > 0.002);
    CHECK(far < 1e-3);
    limb.muscle->setUserValue("osgTSS:activation", 0.0);
    played.frame();
    CHECK(played.shown().getVertices()->asVector() == rest.asVector());
}

TEST_CASE("A muscle that goes to another bone is drawn from the one to the other in the same frame") {
    Limb limb(osg::Matrixd::scale(0.5, 0.5, 0.5), true);
    Played played(limb);
    CHECK(played.scene->getModel().muscles.at(0).insertionBone >= 0);
    limb.bend(40);
    played.frame();
    const auto* belly = dynamic_cast<const SkinGeometry*>(limb.muscleGeode->getDrawable(0));
    REQUIRE(belly);
    const osg::Vec3Array& now = *belly->getVertices();
    const osg::Vec3Array& rest = verticesOf(*limb.muscle);
    const std::size_t last = rest.size() - 1, first = last - 1; // the middles of its ends
    CHECK((now[first] - rest[first]).length() < 0.05);
    CHECK((now[last] - rest[last]).length() > 0.4);
    CHECK((now[last] - turned(limb, rest[last])).length() < 0.1);

    Limb other;
    other.muscle->setUserValue("osgTSS:muscle", std::string("to=Radius"));
    const Heard heard;
    ConstraintVisitor visitor;
    other.root->accept(visitor);
    CHECK(visitor.getModel().muscles.empty());
    CHECK(heard.times("no node that is tagged as a bone is called \"Radius\"") == 1);
}

TEST_CASE("A muscle that passes a bone is drawn beside it, whichever of its joints moves") {
    Limb limb;
    osg::ref_ptr<osgSim::DOFTransform> wrist =
        static_cast<osgSim::DOFTransform*>(limb.hinge->clone(osg::CopyOp::SHALLOW_COPY));
    wrist->setName("Wrist");
    wrist->removeChildren(0, wrist->getNumChildren());
    const osg::Matrixd at = osg::Matrixd::translate(4, 0, 0);
    wrist->setPutMatrix(osg::Matrixd::inverse(at));
    wrist->setInversePutMatrix(at);
    osg::ref_ptr<osg::Geode> hand = new osg::Geode;
    hand->setName("Hand");
    hand->addDrawable(Limb::tube(4.1f, 5.8f, 9, 8, 0.15f, false));
    hand->setUserValue("osgTSS:bone", true);
    wrist->addChild(hand);
    limb.hinge->addChild(wrist);
    const osg::ref_ptr<osg::Geometry> belly = Limb::tube(0.4f, 5.6f, 53, 12, 0.0f, false);
    belly->setName("Flexor");
    belly->setUserValue("osgTSS:muscle", std::string("contract=0.2 to=Hand"));
    limb.muscleGeode->setDrawable(0, belly);
    Played played(limb);
    const tss::SceneModel& model = played.scene->getModel();
    REQUIRE(model.muscles.size() == 1);
    CHECK(tss::muscleChain(model, model.muscles[0]).size() == 2);
    limb.bend(60);
    played.frame();
    const auto* shown = dynamic_cast<const SkinGeometry*>(limb.muscleGeode->getDrawable(0));
    REQUIRE(shown);
    const osg::Vec3Array &now = *shown->getVertices(), &rest = verticesOf(*belly);
    osg::Vec3 off[2]; // over the middle of the first bone and of the second, as these have moved
    int count[2] = {0, 0};
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const int bone = std::abs(rest[v].x() - 1) < 0.2f ? 0 : std::abs(rest[v].x() - 3) < 0.2f ? 1 : -1;
        if (bone < 0) continue;
        off[bone] += now[v] - (bone == 0 ? rest[v] : turned(limb, rest[v]));
        ++count[bone];
    }
    for (int bone = 0; bone < 2; ++bone) CHECK((off[bone] / float(count[bone])).length() < 0.05);
}

TEST_CASE("Samples in the file move a muscle without any application") {
    Limb limb;
    limb.muscle->setUserValue("osgTSS:activation", std::string("0:0 0.5:1 1:0"));
    Played played(limb);
    double most = 0;
    for (int frame = 0; frame < 24; ++frame) {
        played.frame();
        most = std::max(most, played.scene->getActivation(0, played.number));
    }
    CHECK(played.scene->getModel().endTimeCode == 24);
    CHECK(most == Approx(1));
}

namespace {

/// The largest distance, in the geometry's own frame, between a limb that moves and the same below a matrix.
double changedBy(const osg::Matrixd& matrix, double degrees, float activation) {
    Limb limb, other(matrix);
    Played a(limb), b(other);
    REQUIRE(b.done.skins == 1);
    for (Limb* each : {&limb, &other}) {
        each->bend(degrees);
        each->muscle->setUserValue("osgTSS:activation", activation);
    }
    a.frame();
    b.frame();
    const osg::Vec3Array &one = *a.shown().getVertices(), &two = *b.shown().getVertices();
    double worst = 0;
    for (std::size_t v = 0; v < one.size(); ++v) worst = std::max<double>(worst, (one[v] - two[v]).length());
    return worst;
}

} // namespace

TEST_CASE("Scales, turns and mirrors above a skin change nothing of its shape") {
    const osg::Matrixd elsewhere =
        osg::Matrixd::rotate(0.5, osg::Vec3d(1, 2, 3)) * osg::Matrixd::translate(3, 4, 5);
    const osg::Matrixd mirror = osg::Matrixd::scale(-0.01, 0.01, 0.01) * elsewhere;
    CHECK(changedBy(osg::Matrixd::scale(1.0 / 128, 1.0 / 128, 1.0 / 128), 45, 0.5f) == 0);
    CHECK(changedBy(mirror, 0, 1) < 1e-5);
    // Inside the bend, where the skin does not fit, rounding decides which contacts are resolved first.
    CHECK(changedBy(mirror, 45, 0.5f) < 0.05);
}

TEST_CASE("A skin on one's own geometry is saved and read, and goes on to play") {
    Limb limb;
    Played played(limb);
    osgDB::ReaderWriter* format = osgDB::Registry::instance()->getReaderWriterForExtension("osgb");
    REQUIRE(format);
    std::stringstream file(std::ios::in | std::ios::out | std::ios::binary);
    REQUIRE(format->writeNode(*limb.root, file).success());
    osg::ref_ptr<osg::Node> read = format->readNode(file).getNode();
    REQUIRE(read);
    auto* again = find<SkinGeometry>(*read, "Sleeve");
    auto* hinge = find<osgSim::DOFTransform>(*read, "Hinge");
    REQUIRE(again);
    REQUIRE(hinge);
    limb.bend(50);
    hinge->setCurrentHPR(limb.hinge->getCurrentHPR());
    Playback playback;
    playback.frame(*read, 0);
    played.frame();
    CHECK(again->getVertices()->asVector() == played.shown().getVertices()->asVector());
}

TEST_CASE("Words that a skin does not know cost that skin, by name") {
    Limb limb;
    limb.skin->setUserValue("osgTSS:skin", std::string("thickness=much"));
    const Heard heard;
    ConstraintVisitor visitor;
    limb.root->accept(visitor);
    CHECK(visitor.getModel().skins.empty());
    CHECK(heard.times("Sleeve: it is no skin") == 1);
}

TEST_CASE("A mesh of morph targets that is tagged as a muscle stays as it is, and is told of") {
    Limb limb;
    osg::ref_ptr<osgAnimation::MorphGeometry> morph = new osgAnimation::MorphGeometry(*limb.skin);
    morph->setUserDataContainer(nullptr); // the sleeve's
    morph->setName("Face");
    morph->setUserValue("osgTSS:muscle", true);
    limb.place->addChild(morph);
    const Heard heard;
    ConstraintVisitor visitor;
    limb.root->accept(visitor);
    CHECK(visitor.getModel().skins.size() == 1);
    CHECK(heard.times("Face: it is no muscle: expected a shape of its own, and it has morph targets") == 1);
}

TEST_CASE("A skin whose geometry has changed since it was baked does not play, and is told of") {
    Limb limb;
    const osg::ref_ptr<Scene> scene = osgTSS::bake(*limb.root);
    auto& vertices = static_cast<osg::Vec3Array&>(*limb.skin->getVertexArray());
    vertices[Limb::at(5, 3)] *= 1.1f;
    const Heard heard;
    const Installed done = install(*limb.root, *scene);
    CHECK(done.skins == 0);
    CHECK(done.stale == 1);
    CHECK(heard.times("another mesh") == 1);
    CHECK(limb.skinGeode->getDrawable(0) == limb.skin);
}

TEST_CASE("A muscle hears of its activation on the node that stands there under its name, too") {
    Limb limb;
    Played played(limb);
    limb.muscle->setUserValue("osgTSS:activation", 0.0);
    played.frame();
    auto* shown = find<SkinGeometry>(*limb.root, "Biceps");
    REQUIRE(shown);
    const std::vector<osg::Vec3> slack = shown->getVertices()->asVector();
    shown->setUserValue("osgTSS:activation", 1.0);
    played.frame();
    const std::vector<osg::Vec3> tight = shown->getVertices()->asVector();
    CHECK(tight != slack);
    limb.muscle->setUserValue("osgTSS:activation", 0.5); // what is said last counts
    played.frame();
    CHECK(shown->getVertices()->asVector() != tight);
    CHECK(shown->getVertices()->asVector() != slack);
}
