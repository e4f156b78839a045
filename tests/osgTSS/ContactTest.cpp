#include "Nodes.h"
#include "Playback.h"
#include "Scenes.h"

#include <catch2/catch.hpp>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Convert>
#include <osgTSS/CreateGraph>
#include <osgTSS/Install>
#include <osgTSS/JointTransform>

using namespace osgTSS;

namespace {

struct Listen : ContactCallback {
    void operator()(const Contact& contact, osg::NodeVisitor&) override { heard.push_back(contact); }
    std::vector<Contact> heard;
};

} // namespace

TEST_CASE("a contact is told as it begins, stays and ends, with its place in the world") {
    osg::ref_ptr<Scene> scene =
        new Scene(std::make_shared<tss::SceneModel>(scenes::hinge()), Clock::FRAME_NUMBER);
    osg::ref_ptr<osg::Group> graph = createGraph(*scene);
    install(*graph, *scene);
    osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrixd::scale(2, 2, 2) * osg::Matrixd::translate(0, 100, 0));
    place->addChild(graph);
    osg::ref_ptr<Listen> listen = new Listen;
    scene->setContactCallback(listen);
    Playback playback;
    playback.frames(*place, 0, 24);

    REQUIRE(listen->heard.size() >= 3);
    CHECK(listen->heard.front().event == Contact::BEGIN);
    CHECK(listen->heard.back().event == Contact::END);
    for (std::size_t k = 1; k + 1 < listen->heard.size(); ++k) CHECK(listen->heard[k].event == Contact::STAY);
    const Contact& contact = listen->heard[1];
    CHECK(contact.pairPath == "/Rig/Hinge");
    CHECK(contact.bodyA == "/Rig/Frame");
    CHECK(contact.bodyB == "/Rig/Arm");
    REQUIRE(contact.nodeA);
    CHECK(contact.nodeA->getName() == "Frame");
    CHECK(contact.nodeB->getName() == "Arm");
    CHECK(contact.gap < 1e-3);
    // Half way between the two spheres, in the world's own units.
    const double a = scenes::stopAngle, b = scenes::contactAngle();
    const osg::Vec3d stop(2 * std::cos(a), 0, -2 * std::sin(a)), arm(2 * std::cos(b), 0, -2 * std::sin(b));
    const osg::Vec3d at = ((stop + arm) / 2 + osg::Vec3d(5, 0, 0)) * 2 + osg::Vec3d(0, 100, 0);
    CHECK((contact.point - at).length() < 2e-3);
    osg::Vec3d normal = arm - stop;
    normal.normalize();
    CHECK((contact.normal - normal).length() < 2e-3);
}

TEST_CASE("the normal of a contact is one of the surface where scales above differ between axes") {
    osg::Vec3d normals[2];
    const osg::Matrixd places[] = {osg::Matrixd(),
                                   osg::Matrixd::rotate(0.7, 0, 1, 0) * osg::Matrixd::scale(1, 1, 4)};
    for (int k = 0; k < 2; ++k) {
        osg::ref_ptr<Scene> scene =
            new Scene(std::make_shared<tss::SceneModel>(scenes::hinge()), Clock::FRAME_NUMBER);
        osg::ref_ptr<osg::Group> graph = createGraph(*scene);
        install(*graph, *scene);
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(places[k]);
        place->addChild(graph);
        osg::ref_ptr<Listen> listen = new Listen;
        scene->setContactCallback(listen);
        Playback().frames(*place, 0, 12);
        REQUIRE(!listen->heard.empty());
        normals[k] = listen->heard.front().normal;
    }
    // What lies in the surface, as the place carries it, is at right angles to the normal there.
    for (const osg::Vec3d& along : {osg::Vec3d(0, 1, 0) ^ normals[0], osg::Vec3d(0, 1, 0)}) {
        const osg::Vec3d carried = osg::Matrixd::transform3x3(along, places[1]);
        CHECK(normals[1] * carried == Approx(0).margin(1e-6));
    }
    CHECK(normals[1].length() == Approx(1));
    CHECK(normals[1] * osg::Matrixd::transform3x3(normals[0], places[1]) > 0);
}

TEST_CASE("contacts of an extracted graph name its nodes") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("Rig");
    root->addChild(new osg::ShapeDrawable(new osg::Box(osg::Vec3(3, 0, 0), 0.5f)));
    osg::ref_ptr<osg::MatrixTransform> half = new osg::MatrixTransform(osg::Matrixd::scale(0.5, 0.5, 0.5));
    osg::ref_ptr<JointTransform> joint = new JointTransform;
    joint->setName("Slide");
    joint->addTranslation('X', 0, 10);
    joint->addChild(new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 0.5f)));
    half->addChild(joint);
    root->addChild(half);
    ConstraintVisitor visitor;
    root->accept(visitor);
    auto model = std::make_shared<tss::SceneModel>(visitor.getModel());
    model->pairs.at(0).table =
        std::make_shared<tss::Table>(tss::makeTable({{tss::Vec3(3, 0, 0), 0.5}}, {{tss::Vec3(0, 0, 0), 0.25}},
                                                    {{0, 0}}, {}, pairMotion(*model, model->pairs[0])));
    osg::ref_ptr<Scene> scene = new Scene(model);
    install(*root, *scene);
    osg::ref_ptr<Listen> listen = new Listen;
    scene->setContactCallback(listen);
    joint->setValue(0, 9);
    Playback playback;
    playback.frames(*root, 0, 1);
    REQUIRE(listen->heard.size() == 2);
    CHECK(listen->heard[0].nodeA == root);
    CHECK(listen->heard[0].nodeB == joint);
    CHECK(listen->heard[0].point.x() == Approx(2.5).margin(1e-3));
    CHECK(listen->heard[0].normal.x() == Approx(-1));
    CHECK(joint->getValue(0) == Approx(2.25 / 0.5).margin(2e-3));
}

TEST_CASE("who is told of a contact may take the tables from the graph") {
    struct TakeAway : ContactCallback {
        void operator()(const Contact&, osg::NodeVisitor&) override {
            ++told;
            uninstall(*root);
            scene->setContactCallback(nullptr);
        }
        osg::Node* root = nullptr;
        Scene* scene = nullptr;
        int told = 0;
    };
    osg::ref_ptr<Scene> scene =
        new Scene(std::make_shared<tss::SceneModel>(scenes::hinge()), Clock::FRAME_NUMBER);
    osg::ref_ptr<osg::Group> graph = createGraph(*scene);
    install(*graph, *scene);
    osg::ref_ptr<TakeAway> listen = new TakeAway;
    listen->root = graph;
    listen->scene = scene;
    scene->setContactCallback(listen);
    Playback playback;
    playback.frames(*graph, 0, 24);
    CHECK(listen->told == 1);
    CHECK(listen->referenceCount() == 1);
}

TEST_CASE("a contact goes on when another joint is let go, and ends when its own is") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("Rig");
    root->addChild(nodes::box(osg::Vec3(3, 0, 0), 0.5f));
    std::vector<osg::ref_ptr<osgSim::DOFTransform>> slides;
    for (const char* name : {"A", "B"}) {
        slides.push_back(nodes::dof(name));
        slides.back()->setMaxTranslate(osg::Vec3(5, 0, 0));
        slides.back()->addChild(nodes::box(osg::Vec3(0, slides.size() > 1 ? 4 : 0, 0), 0.5f));
        root->addChild(slides.back());
    }
    tss::SceneModel model = nodes::extract(*root);
    REQUIRE(model.pairs.size() == 2);
    for (std::size_t pair = 0; pair < 2; ++pair)
        nodes::giveTable(model, pair, osg::Vec3(3, 0, 0), osg::Vec3(0, 0, 0), 0.5);
    osg::ref_ptr<Scene> scene = new Scene(std::make_shared<tss::SceneModel>(model));
    CHECK(install(*root, *scene).joints == 2);
    osg::ref_ptr<Listen> listen = new Listen;
    scene->setContactCallback(listen);
    Playback playback;
    const auto frame = [&](double scaleA, double scaleB) {
        static unsigned int number = 0;
        slides[0]->setCurrentTranslate(osg::Vec3(4, 0, 0));
        slides[0]->setCurrentScale(osg::Vec3(1, 1, 1) * scaleA);
        slides[1]->setCurrentScale(osg::Vec3(1, 1, 1) * scaleB);
        listen->heard.clear();
        playback.frame(*root, ++number);
        std::string events;
        for (const Contact& contact : listen->heard)
            events += contact.event == Contact::BEGIN ? "b" : contact.event == Contact::STAY ? "s" : "e";
        return events;
    };
    CHECK(frame(1, 1) == "b");
    CHECK(frame(1, 1) == "s");
    CHECK(frame(1, 1.5) == "s"); // B is let go
    CHECK(frame(1, 1) == "s");
    CHECK(frame(1.5, 1) == "e"); // A is
    CHECK(frame(1.5, 1) == "");
}
