// What an application does to a graph, or has done, that a table must not be taken for.
#include "Heard.h"
#include "Nodes.h"

#include <osg/LOD>
#include <osg/PositionAttitudeTransform>
#include <osg/ValueObject>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Channel>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateMatrixTransform>
#include <osgTSS/Bake>
#include <osgTSS/JointTransform>

using namespace osgTSS;

namespace {

/// A block at 5 that stops a slide at 4.
struct SlideYard {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgSim::DOFTransform> slide = nodes::dof("Slide");
    Playback playback;
    unsigned int frame = 0;

    SlideYard() {
        root->setName("Yard");
        root->addChild(nodes::box(osg::Vec3(5, 0, 0), 0.5f));
        slide->setMaxTranslate(osg::Vec3(10, 0, 0));
        slide->addChild(nodes::box(osg::Vec3(), 0.5f));
        root->addChild(slide);
    }
    Installed install() {
        tss::SceneModel model = nodes::extract(*root);
        nodes::giveTable(model, 0, osg::Vec3(5, 0, 0), osg::Vec3(), 0.5);
        return osgTSS::install(*root, model);
    }
    float x() const { return slide->getCurrentTranslate()[0]; }
};

/// Moves the slide, when the others have run or before.
struct LateMover : osg::NodeCallback {
    LateMover(osgSim::DOFTransform& slide, bool late) : slide(&slide), late(late) {}
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override {
        if (late) traverse(node, visitor);
        slide->setCurrentTranslate(osg::Vec3(asked, 0, 0));
        if (!late) traverse(node, visitor);
    }
    osg::ref_ptr<osgSim::DOFTransform> slide;
    bool late;
    float asked = 0;
};

Installed baked(osg::Node& root, const std::string& words = "tolerance=0.02") {
    return install(root, *bake(root, BakeOptions(words)));
}

} // namespace

TEST_CASE("a joint that is moved after it was held is held again in the same update") {
    for (const bool late : {false, true}) {
        CAPTURE(late);
        SlideYard yard;
        REQUIRE(yard.install().joints == 1);
        const osg::ref_ptr<LateMover> mover = new LateMover(*yard.slide, late);
        const osg::ref_ptr<osg::Group> behind = new osg::Group;
        yard.root->addChild(behind);
        (late ? yard.root.get() : behind.get())->addUpdateCallback(mover);
        for (unsigned int frame = 0; frame < 40; ++frame) {
            mover->asked = 0.25f * float(frame);
            yard.playback.frame(*yard.root, frame);
            CHECK(yard.x() == Approx(std::min(mover->asked, 4.f)).margin(1e-3));
        }
        mover->asked = 1;
        yard.playback.frame(*yard.root, 40);
        CHECK(yard.x() == Approx(1));
    }
}

TEST_CASE("a callback that replaces the one that holds a joint is told of") {
    SlideYard yard;
    REQUIRE(yard.install().joints == 1);
    yard.playback.frames(*yard.root, 0, 3);
    const Heard heard;
    yard.slide->setUpdateCallback(new LateMover(*yard.slide, false));
    yard.playback.frames(*yard.root, 4, 8);
    CHECK(heard.times("was taken from it") == 1);
}

TEST_CASE("what is taken off a copy of a graph stays on the graph") {
    SlideYard yard;
    const osg::ref_ptr<LateMover> mover = new LateMover(*yard.slide, false);
    yard.slide->addUpdateCallback(mover);
    REQUIRE(yard.install().joints == 1);
    const osg::ref_ptr<osg::Group> copy = osg::clone(yard.root.get(), osg::CopyOp::DEEP_COPY_NODES);
    uninstall(*copy);
    mover->asked = 9;
    yard.playback.frames(*yard.root, 0, 3);
    CHECK(yard.x() == Approx(4).margin(1e-3));
}

TEST_CASE("levels of detail that are drawn together are one body") {
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::LOD> lod = new osg::LOD;
    lod->addChild(nodes::box(osg::Vec3(3, 0, 0.6f), 0.05f), 0, 100); // bolts
    lod->addChild(nodes::box(osg::Vec3(3, 0, 0), 0.5f), 0, 1e6f);    // what they are on
    lod->addChild(nodes::box(osg::Vec3(3, 0, 5), 0.5f), 1e6f, 2e6f);
    root->addChild(lod);
    const auto slide = nodes::dof("Slide");
    slide->setMaxTranslate(osg::Vec3(5, 0, 0));
    slide->addChild(nodes::box(osg::Vec3(), 0.5f));
    root->addChild(slide);
    const tss::SceneModel model = nodes::extract(*root);
    CHECK(model.bodies[0].mesh.triangles.size() == 24);
    REQUIRE(baked(*root).joints == 1);
    slide->setCurrentTranslate(osg::Vec3(3, 0, 0));
    Playback().frame(*root, 0);
    CHECK(slide->getCurrentTranslate()[0] < 2);
}

TEST_CASE("a level of detail whose joints are not served is told of") {
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::LOD> lod = new osg::LOD;
    lod->addChild(nodes::box(osg::Vec3(), 0.5f), 0, 10);
    lod->addChild(nodes::dof("Coarse"), 10, 20);
    root->addChild(lod);
    const Heard heard;
    nodes::extract(*root);
    CHECK(heard.times("coarser level \"Coarse\"") == 1);
}

TEST_CASE("an element of a stack whose scale is animated is no part of a joint") {
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(nodes::box(osg::Vec3(3, 0, 0), 0.5f));
    const osg::ref_ptr<osg::MatrixTransform> mover = new osg::MatrixTransform;
    mover->setName("Mover");
    const osg::ref_ptr<osgAnimation::UpdateMatrixTransform> stack =
        new osgAnimation::UpdateMatrixTransform("Mover");
    stack->getStackedTransforms().push_back(
        new osgAnimation::StackedTranslateElement("translate", osg::Vec3()));
    stack->getStackedTransforms().push_back(
        new osgAnimation::StackedScaleElement("scale", osg::Vec3(1, 1, 1)));
    mover->setUpdateCallback(stack);
    mover->addChild(nodes::box(osg::Vec3(), 0.5f));
    root->addChild(mover);
    const osg::ref_ptr<osgAnimation::BasicAnimationManager> manager = new osgAnimation::BasicAnimationManager;
    const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    for (const auto& [element, to] :
         {std::pair("translate", osg::Vec3(1.5f, 0, 0)), std::pair("scale", osg::Vec3(3, 3, 3))}) {
        const osg::ref_ptr<osgAnimation::Vec3LinearChannel> channel = new osgAnimation::Vec3LinearChannel;
        channel->setTargetName("Mover");
        channel->setName(element);
        auto& keys = *channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
        keys.push_back(osgAnimation::Vec3Keyframe(0, osg::Vec3(1, 1, 1)));
        keys.push_back(osgAnimation::Vec3Keyframe(1, to));
        animation->addChannel(channel);
    }
    manager->registerAnimation(animation);
    root->setUpdateCallback(manager);
    const Heard heard;
    CHECK(nodes::extract(*root).pairs.empty());
    CHECK(heard.times("it moves, but is no joint: a channel animates its element scale") == 1);
}

TEST_CASE("a mirror that is stopped stays the mirror it is") {
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(nodes::box(osg::Vec3(3, 0, 0), 0.5f));
    const osg::ref_ptr<osg::PositionAttitudeTransform> part = new osg::PositionAttitudeTransform;
    part->setName("Part");
    part->setScale(osg::Vec3d(-1, 1, 1));
    part->setUserValue("osgTSS:dofs", std::string("transX:-5:5"));
    part->addChild(nodes::box(osg::Vec3(0, 0.7f, 0), 0.5f));
    root->addChild(part);
    REQUIRE(baked(*root).joints == 1);
    part->setPosition(osg::Vec3d(3, 0, 0));
    Playback().frame(*root, 0);
    CHECK(part->getPosition().x() < 2.1);
    CHECK(toWorld(*part, osg::Vec3d(0, 0.7, 0)).y() == Approx(0.7)); // below the part
}

TEST_CASE("two and three turns of a tagged node go as far as their limits, beyond a quarter turn too") {
    for (const std::string dofs : {"rotX:-20:20 rotY:-5:150", "rotX:-20:20 rotY:-5:150 rotZ:-20:20"}) {
        CAPTURE(dofs);
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(nodes::box(osg::Vec3(0, 0, -3), 0.2f));
        const osg::ref_ptr<osg::MatrixTransform> arm = new osg::MatrixTransform;
        arm->setName("Arm");
        arm->setUserValue("osgTSS:dofs", dofs);
        arm->addChild(nodes::box(osg::Vec3(0, 0, 3.2f), 0.2f));
        root->addChild(arm);
        REQUIRE(baked(*root, "tolerance=0.1 budget=2").stale == 0);
        const Heard heard;
        for (double degrees = 0; degrees <= 145; degrees += 5) {
            const osg::Matrix asked = osg::Matrix::rotate(osg::DegreesToRadians(degrees), 0, 1, 0) *
                                      osg::Matrix::rotate(osg::DegreesToRadians(5.), 1, 0, 0);
            arm->setMatrix(asked);
            Playback().frame(*root, static_cast<unsigned int>(degrees));
            for (int i = 0; i < 16; ++i)
                CHECK(arm->getMatrix().ptr()[i] == Approx(asked.ptr()[i]).margin(1e-9));
        }
        CHECK(heard.times("beyond the limits") == 0);
        CHECK(heard.times("stands as none") == 0);
    }
}

TEST_CASE("what is moved between install() and the first update is told of, and what is not is not") {
    SlideYard yard, other;
    REQUIRE(yard.install().joints == 1);
    REQUIRE(other.install().joints == 1);
    const Heard heard;
    yard.playback.frames(*yard.root, 0, 3);
    CHECK(heard.times("does not fit the graph") == 0);
    const osg::ref_ptr<osg::MatrixTransform> nearer =
        new osg::MatrixTransform(osg::Matrix::translate(-2, 0, 0));
    nearer->addChild(other.root->getChild(0));
    other.root->replaceChild(other.root->getChild(0), nearer);
    other.playback.frames(*other.root, 0, 3);
    CHECK(heard.times("does not fit the graph") == 1);
}

TEST_CASE("a joint whose scale changes between install() and the first update is let go and told of") {
    SlideYard yard;
    REQUIRE(yard.install().joints == 1);
    yard.slide->setCurrentScale(osg::Vec3(2, 2, 2));
    const Heard heard;
    for (yard.frame = 0; yard.frame < 10; ++yard.frame) {
        yard.slide->setCurrentTranslate(osg::Vec3(float(yard.frame), 0, 0));
        yard.playback.frame(*yard.root, yard.frame);
    }
    CHECK(heard.times("its scale has changed; its tables know nothing there") == 1);
    CHECK(yard.x() == 9);
}

TEST_CASE("a joint whose scale has changed stays let go when another node is taken out") {
    SlideYard yard;
    const auto other = nodes::dof("Other");
    other->setMaxTranslate(osg::Vec3(0, 10, 0));
    other->addChild(nodes::box(osg::Vec3(0, -5, 0), 0.5f));
    yard.root->addChild(other);
    tss::SceneModel model = nodes::extract(*yard.root, ConstraintVisitor::ALL);
    for (std::size_t pair = 0; pair < model.pairs.size(); ++pair)
        nodes::giveTable(model, pair, osg::Vec3(5, 0, 0), osg::Vec3(), 0.5);
    REQUIRE(osgTSS::install(*yard.root, model).joints == model.pairs.size());
    yard.playback.frames(*yard.root, 0, 3);
    yard.slide->setCurrentScale(osg::Vec3(2, 2, 2));
    yard.playback.frames(*yard.root, 4, 6);
    yard.root->removeChild(other);
    const Heard heard;
    yard.playback.frames(*yard.root, 7, 8);
    yard.slide->setCurrentTranslate(osg::Vec3(9, 0, 0));
    yard.playback.frames(*yard.root, 9, 10);
    CHECK(yard.x() == 9);
    CHECK(heard.times("its scale has changed") == 0); // said already
}

TEST_CASE("a machine of JointTransforms is looked at below whatever root it hangs") {
    const osg::ref_ptr<osg::Group> tank = new osg::Group, world = new osg::Group;
    tank->setName("Tank");
    world->setName("World");
    world->addChild(tank);
    tank->addChild(nodes::box(osg::Vec3(3, 0, 0), 0.5f));
    const osg::ref_ptr<JointTransform> slide = new JointTransform;
    slide->setName("Slide");
    slide->addTranslation('X', 0, 1.6, 0);
    slide->addChild(nodes::box(osg::Vec3(), 0.5f));
    tank->addChild(slide);
    const auto scene = bake(*tank, BakeOptions("tolerance=0.02"));
    REQUIRE(install(*tank, *scene).proven == 1);
    CHECK(install(*world, *scene).proven == 1);
    slide->setChild(0, nodes::box(osg::Vec3(), 1.2f));
    CHECK(install(*world, *scene).stale == 1);
}

TEST_CASE("a graph whose parts are off by more than a proof has to spare is not taken for it") {
    const auto ship = [](double above) {
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->setName("Ship");
        root->addChild(new osg::ShapeDrawable(new osg::Box(osg::Vec3(0, 0, -0.5f), 100, 100, 1)));
        const osg::ref_ptr<osg::MatrixTransform> on =
            new osg::MatrixTransform(osg::Matrix::translate(0, 0, above));
        const auto slide = nodes::dof("Slide");
        slide->setMaxTranslate(osg::Vec3(10, 0, 0));
        slide->addChild(nodes::box(osg::Vec3(0, 0, 0.5f), 0.5f));
        on->addChild(slide);
        root->addChild(on);
        return root;
    };
    const auto high = ship(0.005);
    const auto scene = bake(*high, BakeOptions("tolerance=0.001"));
    REQUIRE(install(*high, *scene).proven == 1);
    CHECK(install(*ship(0.0050001), *scene).proven == 1);
    CHECK(install(*ship(-0.007), *scene).stale == 1);
}
