#include "Heard.h"
#include "LargeGraph.h"
#include "Nodes.h"
#include "Playback.h"

#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"

#include <catch2/catch.hpp>
#include <limits>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osg/Switch>
#include <osgSim/DOFTransform>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Convert>
#include <osgTSS/Install>
#include <osgTSS/JointCallback>
#include <osgTSS/JointTransform>

#include <random>

using namespace osgTSS;
using nodes::extract;

namespace {

constexpr unsigned long allLimited = 0xff800000ul;

osg::ref_ptr<osg::Node> box(const osg::Vec3& centre, float half = 0.2f) {
    return new osg::ShapeDrawable(new osg::Box(centre, 2 * half));
}

osg::ref_ptr<osgSim::DOFTransform> dof(const std::string& name) {
    osg::ref_ptr<osgSim::DOFTransform> node = new osgSim::DOFTransform;
    node->setName(name);
    node->setCurrentScale(osg::Vec3(1, 1, 1));
    node->setLimitationFlags(allLimited);
    node->setAnimationOn(false);
    return node;
}

osg::Matrixd randomRigid(std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    return osg::Matrixd::rotate(3 * unit(random), osg::Vec3d(unit(random), unit(random), unit(random) + 2)) *
           osg::Matrixd::translate(5 * unit(random), 5 * unit(random), 5 * unit(random));
}

double largestDifference(const osg::Matrixd& a, const osg::Matrixd& b) {
    double difference = 0;
    for (int i = 0; i < 16; ++i) difference = std::max(difference, std::abs(a.ptr()[i] - b.ptr()[i]));
    return difference;
}

} // namespace

TEST_CASE("an extracted DOFTransform moves as OSG moves it, for every order of turns and any put matrix") {
    const unsigned seed = GENERATE(range(0u, 40u));
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto node = dof("Turret");
    const osg::Matrixd put = randomRigid(random);
    node->setPutMatrix(put);
    node->setInversePutMatrix(osg::Matrixd::inverse(put));
    node->setHPRMultOrder(static_cast<osgSim::DOFTransform::MultOrder>(seed % 6));
    node->setMinHPR(osg::Vec3(-2, -2, -2));
    node->setMaxHPR(osg::Vec3(2, 2, 2));
    node->setMinTranslate(osg::Vec3(-3, -3, -3));
    node->setMaxTranslate(osg::Vec3(3, 3, 3));
    node->addChild(box(osg::Vec3(1, 0, 0)));
    const double scale = seed % 3 == 0 ? 0.5 : 1;
    osg::ref_ptr<osg::MatrixTransform> above =
        new osg::MatrixTransform(osg::Matrixd::scale(scale, scale, scale) * randomRigid(random));
    above->addChild(node);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(box(osg::Vec3(0, 0, 9)));
    root->addChild(above);

    const tss::SceneModel model = extract(*root);
    REQUIRE(model.joints.size() == 1);
    REQUIRE(model.joints[0].dofs.size() == 6);
    for (int pose = 0; pose < 10; ++pose) {
        osg::Vec3 hpr(unit(random), unit(random), unit(random)),
            slide(unit(random), unit(random), unit(random));
        node->setCurrentHPR(hpr * 2);
        node->setCurrentTranslate(slide * 3);
        std::vector<double> q;
        for (const tss::Dof& d : model.joints[0].dofs) {
            const int axis = d.name.back() - 'X';
            const int ofHpr[3] = {1, 2, 0};
            q.push_back(d.name.substr(0, 3) == "rot" ? node->getCurrentHPR()[ofHpr[axis]]
                                                     : node->getCurrentTranslate()[axis]);
        }
        const osg::Matrixd ours =
            osg::Matrixd::scale(scale, scale, scale) * toOsg(tss::jointPose(model.joints[0], q));
        CHECK(largestDifference(node->getWorldMatrices().at(0), ours) < 1e-6);
    }
}

TEST_CASE("locked axes are no degrees of freedom, and keep their value") {
    const auto node = dof("Gun");
    node->setMinHPR(osg::Vec3(0, -0.1f, 0));
    node->setMaxHPR(osg::Vec3(0, 0.5f, 0));
    node->setCurrentTranslate(osg::Vec3(0, 2, 0));
    node->setMinTranslate(osg::Vec3(0, 2, 0));
    node->setMaxTranslate(osg::Vec3(0, 2, 0));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(node);
    const tss::SceneModel model = extract(*root);
    REQUIRE(model.joints[0].dofs.size() == 2);
    CHECK(model.joints[0].dofs[0].name == "transY");
    CHECK(model.joints[0].dofs[0].lower == 2);
    CHECK(model.joints[0].dofs[0].upper == 2);
    CHECK(model.joints[0].dofs[1].name == "rotX");
    CHECK(model.joints[0].dofs[1].upper == 0.5f);
}

TEST_CASE("bodies are what hangs together, also below masks and switches, and of a LOD the finest level") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("Tank");
    root->addChild(box(osg::Vec3(0, 0, 0)));
    const auto turret = dof("Turret"), gun = dof("Gun");
    turret->setMaxHPR(osg::Vec3(1, 0, 0));
    gun->setMaxHPR(osg::Vec3(0, 1, 0));
    root->addChild(turret);
    osg::ref_ptr<osg::Switch> sw = new osg::Switch;
    sw->addChild(box(osg::Vec3(0, 0, 1)), false);
    turret->addChild(sw);
    turret->addChild(gun);
    osg::ref_ptr<osg::LOD> lod = new osg::LOD;
    lod->addChild(box(osg::Vec3(9, 0, 1)), 100, 1000);
    lod->addChild(box(osg::Vec3(1, 0, 1)), 0, 100);
    gun->addChild(lod);
    lod->getChild(1)->setNodeMask(0);

    const tss::SceneModel model = extract(*root);
    REQUIRE(model.bodies.size() == 3);
    REQUIRE(model.joints.size() == 2);
    REQUIRE(model.pairs.size() == 2);
    CHECK(model.joints[0].path == "/Tank/Turret");
    for (const tss::Body& body : model.bodies) CHECK(body.mesh.triangles.size() == 12);
    CHECK(model.bodies[2].mesh.vertices.size() == 8);
    CHECK(tss::bounds(model.bodies[2].mesh).center().x() == Approx(1));
    CHECK_FALSE(model.bodies[2].visible);
    CHECK(model.bodies[0].visible);
    CHECK(model.pairs[1].bodyA == 1);
    CHECK(model.pairs[1].bodyB == 2);

    const tss::SceneModel all = extract(*root, ConstraintVisitor::ALL);
    REQUIRE(all.pairs.size() == 3);
    CHECK(all.pairs[1].joints == std::vector<int>{0, 1});
    CHECK(pairMotion(all, all.pairs[1]).dofCount() == 2);
}

TEST_CASE("mirrored geometry is taken with its outside outside") {
    osg::ref_ptr<osg::MatrixTransform> mirror = new osg::MatrixTransform(osg::Matrixd::scale(-1, 1, 1));
    mirror->addChild(box(osg::Vec3(1, 0, 0), 0.5f));
    const tss::SceneModel model = extract(*mirror);
    double volume = 0;
    const tss::TriangleMesh& mesh = model.bodies[0].mesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        volume += mesh.corner(t, 0).cross(mesh.corner(t, 1)).dot(mesh.corner(t, 2)) / 6;
    CHECK(volume == Approx(1));
}

TEST_CASE("a transform that something else moves starts a body that no pair reaches across") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(box(osg::Vec3(0, 0, -1)));
    osg::ref_ptr<osg::MatrixTransform> vehicle = new osg::MatrixTransform(osg::Matrixd::translate(3, 0, 0));
    vehicle->setUpdateCallback(new osg::NodeCallback);
    vehicle->addChild(box(osg::Vec3(0, 0, 0)));
    const auto turret = dof("Turret");
    turret->setMaxHPR(osg::Vec3(1, 0, 0));
    turret->addChild(box(osg::Vec3(0, 0, 1)));
    vehicle->addChild(turret);
    root->addChild(vehicle);
    const tss::SceneModel model = extract(*root, ConstraintVisitor::ALL);
    REQUIRE(model.pairs.size() == 1);
    CHECK(model.pairs[0].bodyA == 1);
    CHECK(model.pairs[0].bodyB == 2);
    CHECK(model.bodies[1].placement.translation().x() == 3);
}

namespace {

/// A turret whose barrel, 2 from the axis, turns about Z towards a post at angle 1.
struct Tank {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgSim::DOFTransform> turret = dof("Turret");
    tss::SceneModel model;
    double contact = 1 - 2 * std::asin(0.5 / 4);

    Tank() {
        const osg::Vec3 post(2 * std::cos(1.f), 2 * std::sin(1.f), 0);
        turret->setMinHPR(osg::Vec3(-1.5f, 0, 0));
        turret->setMaxHPR(osg::Vec3(1.5f, 0, 0));
        turret->setIncrementHPR(osg::Vec3(1, 0, 0));
        turret->addChild(box(osg::Vec3(2, 0, 0)));
        root->addChild(box(post));
        root->addChild(turret);
        model = extract(*root);
        model.pairs[0].table =
            std::make_shared<tss::Table>(tss::makeTable({{toCore(post), 0.25}}, {{tss::Vec3(2, 0, 0), 0.25}},
                                                        {{0, 0}}, {}, pairMotion(model, model.pairs[0])));
    }
};

} // namespace

TEST_CASE("a DOFTransform of an application stops at contact after extraction and install") {
    Tank tank;
    CHECK(install(*tank.root, tank.model).joints == 1);
    Playback playback;
    tank.turret->setCurrentHPR(osg::Vec3(1.3f, 0, 0));
    playback.frame(*tank.root, 1);
    CHECK(tank.turret->getCurrentHPR()[0] == Approx(tank.contact).margin(1e-3));
    tank.turret->setCurrentHPR(osg::Vec3(-0.5f, 0, 0));
    playback.frame(*tank.root, 2);
    CHECK(tank.turret->getCurrentHPR()[0] == Approx(-0.5));
}

TEST_CASE("a DOFTransform whose put matrix changes is let go, by name") {
    Tank tank;
    install(*tank.root, tank.model);
    Playback playback;
    playback.frame(*tank.root, 1);
    const Heard heard;
    tank.turret->setPutMatrix(osg::Matrix::translate(0, 0, 1));
    tank.turret->setCurrentHPR(osg::Vec3(1.3f, 0, 0));
    playback.frame(*tank.root, 2);
    CHECK(heard.times("Turret: its put matrix has changed; its tables know nothing there") == 1);
    CHECK(tank.turret->getCurrentHPR()[0] == 1.3f);
}

TEST_CASE("a joint that is asked for what is no number stays where it is, and is kept apart after it") {
    for (const float none :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Tank tank;
        install(*tank.root, tank.model);
        Playback playback;
        tank.turret->setCurrentHPR(osg::Vec3(-0.5f, 0, 0));
        playback.frame(*tank.root, 1);
        tank.turret->setCurrentHPR(osg::Vec3(none, 0, 0));
        playback.frame(*tank.root, 2);
        CHECK(tank.turret->getCurrentHPR()[0] == -0.5f);
        tank.turret->setCurrentHPR(osg::Vec3(1.3f, 0, 0));
        playback.frame(*tank.root, 3);
        CHECK(tank.turret->getCurrentHPR()[0] == Approx(tank.contact).margin(1e-3));
    }
}

TEST_CASE(
    "a DOFTransform's own animation goes on as if nothing stood in its way, and is only shown stopped") {
    Tank free, stopped;
    install(*stopped.root, stopped.model);
    free.turret->setAnimationOn(true);
    stopped.turret->setAnimationOn(true);
    Playback a, b;
    int stops = 0, frees = 0;
    for (unsigned int frame = 0; frame < 24 * 12; ++frame) {
        a.frame(*free.root, frame);
        b.frame(*stopped.root, frame);
        const double asked = free.turret->getCurrentHPR()[0], shown = stopped.turret->getCurrentHPR()[0];
        if (asked < stopped.contact - 1e-3) {
            CHECK(shown == Approx(asked).margin(1e-5));
            ++frees;
        } else {
            CHECK(shown < stopped.contact + 1e-5);
            ++stops;
        }
    }
    CHECK(stops > 20);
    CHECK(frees > 100);
}

TEST_CASE("a JointTransform of an application needs no path to be extracted and installed on") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<JointTransform> joint = new JointTransform;
    joint->setName("Slide");
    joint->addTranslation('X', 0, 5);
    joint->addChild(box(osg::Vec3(0, 0, 0)));
    root->addChild(box(osg::Vec3(3, 0, 0)));
    root->addChild(joint);
    tss::SceneModel model = extract(*root);
    REQUIRE(model.pairs.size() == 1);
    model.pairs[0].table =
        std::make_shared<tss::Table>(tss::makeTable({{tss::Vec3(3, 0, 0), 0.5}}, {{tss::Vec3(0, 0, 0), 0.5}},
                                                    {{0, 0}}, {}, pairMotion(model, model.pairs[0])));
    install(*root, model);
    joint->setValue(0, 4);
    Playback playback;
    playback.frame(*root, 1);
    CHECK(joint->getValue(0) == Approx(2).margin(1e-3));
    CHECK(toWorld(*joint, osg::Vec3d()).x() == Approx(2).margin(1e-3));
}

TEST_CASE("a graph of ten thousand nodes gives its two hundred joints") {
    const osg::ref_ptr<osg::Group> root = largeGraph(10000, 200);
    const tss::SceneModel model = extract(*root);
    CHECK(model.joints.size() == 200);
    CHECK(model.pairs.size() == 200);
    for (const tss::Body& body : model.bodies) CHECK_FALSE(body.mesh.empty());
}
