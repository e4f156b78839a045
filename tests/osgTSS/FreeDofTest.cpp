#include "Heard.h"
#include "Nodes.h"

#include <osg/ValueObject>
#include <osgTSS/LimitsCallback>

using namespace osgTSS;
using namespace nodes;

namespace {

/// A turret whose barrel, 2 from the axis, meets a post at this angle; nothing is limited.
struct Turret {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgSim::DOFTransform> turret = dof("Turret", 0);
    tss::SceneModel model;
    double post, contact = 2 * std::asin(0.5 / 4);

    explicit Turret(double angle, const std::string& limits = "rotX:0:0 rotY:0:0") : post(angle) {
        if (!limits.empty()) turret->setUserValue("osgTSS:limits", limits);
        turret->addChild(box(osg::Vec3(2, 0, 0)));
        root->addChild(box(at()));
        root->addChild(turret);
        model = extract(*root);
    }
    osg::Vec3 at() const { return {float(2 * std::cos(post)), float(2 * std::sin(post)), 0}; }
    void giveTable() {
        model.pairs.at(0).table =
            std::make_shared<tss::Table>(tss::makeTable({{toCore(at()), 0.25}}, {{tss::Vec3(2, 0, 0), 0.25}},
                                                        {{0, 0}}, {}, pairMotion(model, model.pairs[0])));
    }
    float turn(float heading) {
        turret->setCurrentHPR(osg::Vec3(heading, 0, 0));
        playback.frame(*root, ++frame);
        return turret->getCurrentHPR()[0];
    }
    Playback playback;
    unsigned int frame = 0;
};

} // namespace

TEST_CASE("an axis that a DOFTransform does not limit turns all the way round") {
    for (float range : {0.0f, 0.2f}) {
        CAPTURE(range);
        const auto node = dof("Wheel", 0);
        node->setMinHPR(osg::Vec3(-range, -range, -range));
        node->setMaxHPR(osg::Vec3(range, range, range));
        osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(node);
        const tss::SceneModel model = extract(*root);
        REQUIRE(model.joints.size() == 1);
        REQUIRE(model.joints[0].dofs.size() == 3); // it stays where it could slide without end
        for (const tss::Dof& dof : model.joints[0].dofs) {
            CHECK(dof.kind == tss::DofKind::Rotation);
            CHECK(dof.lower == Approx(-osg::PI));
            CHECK(dof.upper == Approx(osg::PI));
        }
    }
}

TEST_CASE("limits that the application gives hold where the node has none") {
    const auto node = dof("Lift", 0);
    node->setUserValue("osgTSS:limits", std::string("rotX:-20:30 rotY:0:0 rotZ:0:0 transZ:0:5"));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(node);
    const tss::SceneModel model = extract(*root);
    REQUIRE(model.joints.at(0).dofs.size() == 2);
    CHECK(model.joints[0].dofs[0].name == "transZ");
    CHECK(model.joints[0].dofs[0].upper == 5);
    CHECK(model.joints[0].dofs[1].name == "rotX");
    CHECK(model.joints[0].dofs[1].lower == Approx(osg::DegreesToRadians(-20.0)));

    // Those that are written in it, where they are taken at their word.
    node->setUserValue("osgTSS:limits", std::string("written rotX:-20:30"));
    node->setMinHPR(osg::Vec3(-0.2f, 0, 0));
    node->setMaxHPR(osg::Vec3(0.2f, 0, 0));
    const tss::SceneModel written = extract(*root);
    REQUIRE(written.joints.at(0).dofs.size() == 2);
    CHECK(written.joints[0].dofs[0].name == "rotX");
    CHECK(written.joints[0].dofs[1].upper == 0.2f);
}

TEST_CASE("DOFTransforms that turn all the way round about several axes are named") {
    const Heard heard;
    osg::ref_ptr<osg::Group> root = new osg::Group;
    for (const auto& [name, limits] : {std::pair("Free", ""),
                                       {"Wheel", "rotX:0:0 rotY:0:0"},
                                       {"Written", "written"},
                                       {"Given", "rotX:0:1 rotY:0:1"}}) {
        const auto node = dof(name, 0);
        node->setUserValue("osgTSS:limits", std::string(limits));
        root->addChild(node);
    }
    extract(*root);
    CHECK(heard.times("turn all the way round about several axes") == 1);
    CHECK(heard.times("Free (rot") == 1);
    for (const char* name : {"Wheel (rot", "Written (rot", "Given (rot"}) CHECK(heard.times(name) == 0);
}

TEST_CASE("a DOFTransform without limits turns on and on, and is stopped at contact on both sides") {
    Turret it(0);
    REQUIRE(it.model.joints.at(0).dofs.size() == 1);
    it.giveTable();
    REQUIRE(it.turret->getCurrentHPR() == osg::Vec3());
    it.turret->setCurrentHPR(osg::Vec3(1, 0, 0));
    REQUIRE(install(*it.root, it.model).joints == 1);
    for (float asked = 1; asked < 6; asked += 0.25f) CHECK(it.turn(asked) == asked);
    const double stop = 2 * osg::PI - it.contact;
    for (float asked = 6; asked < 6.28f; asked += 0.1f)
        CHECK(it.turn(asked) == Approx(std::min<double>(asked, stop)).margin(1e-3));
    for (float asked = 6; asked > 0.5f; asked -= 0.25f) CHECK(it.turn(asked) == Approx(asked).margin(1e-5));
    CHECK(it.turn(0.1f) == Approx(it.contact).margin(1e-3));
}

TEST_CASE("tables let a joint go while it stands where they know nothing, and hold it again after that") {
    Turret it(1);
    it.giveTable();
    REQUIRE(install(*it.root, it.model).joints == 1);
    CHECK(it.turn(0.9f) == Approx(1 - it.contact).margin(1e-3));
    it.turn(0);
    it.turret->setCurrentTranslate(osg::Vec3(0, 0, 3)); // slides without limits: was taken to stay
    CHECK(it.turn(1) == 1);
    CHECK(it.turret->getCurrentTranslate() == osg::Vec3(0, 0, 3));
    CHECK(it.turn(0) == 0);
    it.turret->setCurrentTranslate(osg::Vec3());
    CHECK(it.turn(0.9f) == Approx(1 - it.contact).margin(1e-3));
}

TEST_CASE("a joint that leaves the limits of its proof is told of once") {
    Turret it(1, "rotX:0:0 rotY:0:0 rotZ:-10:10");
    it.model.pairs.at(0).proof = std::make_shared<tss::NeverCollides>();
    const Installed installed = install(*it.root, it.model);
    CHECK(installed.proven == 1);
    CHECK(installed.joints == 0);
    auto* limits = dynamic_cast<LimitsCallback*>(it.root->getUpdateCallback());
    REQUIRE(limits);
    CHECK(it.turn(0.1f) == 0.1f);
    CHECK(limits->getNumWarnings() == 0);
    CHECK(it.turn(0.5f) == 0.5f);
    CHECK(limits->getNumWarnings() == 1);
    it.turn(0.6f);
    CHECK(limits->getNumWarnings() == 1);
}

TEST_CASE("a joint that is asked beyond the limits of its table stops at them and is told of once") {
    Turret it(1, "rotX:0:0 rotY:0:0 rotZ:-10:10");
    it.giveTable();
    REQUIRE(install(*it.root, it.model).joints == 1);
    const double limit = osg::DegreesToRadians(10.0);
    Heard heard;
    CHECK(it.turn(0.1f) == Approx(0.1));
    CHECK(heard.times("beyond the limits") == 0);
    CHECK(it.turn(0.5f) == Approx(limit));
    CHECK(it.turn(0.6f) == Approx(limit));
    CHECK(it.turn(-0.4f) == Approx(-limit));
    CHECK(heard.times("beyond the limits") == 1);
}
