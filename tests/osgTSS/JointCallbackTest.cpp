#include "Playback.h"
#include "Scenes.h"

#include <catch2/catch.hpp>
#include <osg/MatrixTransform>
#include <osgTSS/CreateGraph>
#include <osgTSS/DriveCallback>
#include <osgTSS/Install>
#include <osgTSS/JointCallback>
#include <osgTSS/JointTransform>

using namespace osgTSS;

namespace {

struct Rig {
    osg::ref_ptr<Scene> scene;
    osg::ref_ptr<osg::Group> root;
    JointTransform* joint = nullptr;

    explicit Rig(const tss::SceneModel& model, Clock::Source clock = Clock::FRAME_NUMBER) {
        scene = new Scene(std::make_shared<tss::SceneModel>(model), clock);
        root = createGraph(*scene);
        joint = find<JointTransform>(*root, "Hinge");
    }
};

/// Writes a value, before or after it lets the others go on.
class Writer : public osg::Callback {
public:
    Writer(double value, bool late) : _value(value), _late(late) {}
    bool run(osg::Object* object, osg::Object* data) override {
        auto* joint = dynamic_cast<JointTransform*>(object);
        if (!_late) joint->setValue(0, _value);
        const bool result = traverse(object, data);
        if (_late) joint->setValue(0, _value);
        return result;
    }

private:
    double _value;
    bool _late;
};

} // namespace

TEST_CASE("without a table the joint follows its drive") {
    Rig rig(scenes::hinge(false));
    const Installed installed = install(*rig.root, *rig.scene);
    CHECK(installed.joints == 0);
    CHECK(installed.unbaked == 1);
    Playback playback;
    for (unsigned int frame = 0; frame <= 30; ++frame) {
        playback.frame(*rig.root, frame);
        const double time = frame % 24;
        CHECK(rig.joint->getValue(0) == Approx(1.4 * (time <= 12 ? time : 24 - time) / 12));
    }
}

TEST_CASE("with a table the joint stops at contact and comes back") {
    Rig rig(scenes::hinge());
    CHECK(install(*rig.root, *rig.scene).joints == 1);
    Playback playback;
    double farthest = 0;
    for (unsigned int frame = 0; frame <= 48; ++frame) {
        playback.frame(*rig.root, frame);
        const double time = frame % 24, asked = 1.4 * (time <= 12 ? time : 24 - time) / 12;
        CHECK(rig.joint->getValue(0) < scenes::contactAngle() + 1e-6);
        CHECK(rig.joint->getAskedValues()[0] == Approx(asked));
        if (asked < scenes::contactAngle() - 1e-3) CHECK(rig.joint->getValue(0) == Approx(asked));
        farthest = std::max(farthest, rig.joint->getValue(0));
    }
    CHECK(farthest == Approx(scenes::contactAngle()).margin(1e-3));
}

TEST_CASE("the joint resolves after whatever animates it, early or late, added before or after") {
    for (const bool late : {false, true})
        for (const bool before : {false, true}) {
            CAPTURE(late, before);
            tss::SceneModel model = scenes::hinge();
            model.joints[0].drives.clear();
            Rig rig(model);
            if (before) rig.joint->addUpdateCallback(new Writer(1.2, late));
            install(*rig.root, *rig.scene);
            if (!before) rig.joint->addUpdateCallback(new Writer(1.2, late));
            Playback playback;
            playback.frames(*rig.root, 1, 3);
            CHECK(rig.joint->getValue(0) == Approx(scenes::contactAngle()).margin(1e-3));
            CHECK(rig.joint->getValue(0) < scenes::contactAngle() + 1e-6);
        }
}

TEST_CASE("a wish is remembered, not the place where it was stopped") {
    tss::SceneModel model = scenes::hinge();
    model.joints[0].drives.clear();
    Rig rig(model);
    install(*rig.root, *rig.scene);
    Playback playback;
    rig.joint->setValue(0, 1.3);
    playback.frames(*rig.root, 1, 2);
    CHECK(rig.joint->getValue(0) < scenes::contactAngle() + 1e-6);
    CHECK(rig.joint->getAskedValues()[0] == 1.3);
}

TEST_CASE("nothing is installed for a pair proven never to collide") {
    tss::SceneModel model = scenes::hinge(false);
    model.pairs[0].proof = std::make_shared<tss::NeverCollides>();
    Rig rig(model);
    osg::Callback* drive = rig.joint->getUpdateCallback();
    const Installed installed = install(*rig.root, *rig.scene);
    CHECK(installed.joints == 0);
    CHECK(installed.proven == 1);
    CHECK(installed.unbaked == 0);
    CHECK(rig.joint->getUpdateCallback() == drive);
    CHECK_FALSE(drive->getNestedCallback());
}

TEST_CASE("uninstalling leaves the other callbacks and lets the joint through") {
    Rig rig(scenes::hinge());
    install(*rig.root, *rig.scene);
    install(*rig.root, *rig.scene); // twice is once
    CHECK(dynamic_cast<JointCallback*>(rig.joint->getUpdateCallback()));
    CHECK(dynamic_cast<DriveCallback*>(rig.joint->getUpdateCallback()->getNestedCallback()));
    uninstall(*rig.root);
    REQUIRE(dynamic_cast<DriveCallback*>(rig.joint->getUpdateCallback()));
    CHECK_FALSE(rig.joint->getUpdateCallback()->getNestedCallback());
    Playback playback;
    playback.frames(*rig.root, 0, 12);
    CHECK(rig.joint->getValue(0) == Approx(1.4));
}

TEST_CASE("a graph under two parents is resolved once a frame, to the same states") {
    Rig alone(scenes::hinge()), shared(scenes::hinge());
    install(*alone.root, *alone.scene);
    install(*shared.root, *shared.scene);
    osg::ref_ptr<osg::Group> world = new osg::Group;
    for (double x : {0.0, 10.0}) {
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(osg::Matrixd::translate(x, 0, 0));
        place->addChild(shared.root);
        world->addChild(place);
    }
    Playback a, b;
    for (unsigned int frame = 0; frame <= 30; ++frame) {
        a.frame(*alone.root, frame);
        b.frame(*world, frame);
        CHECK(alone.joint->getValues() == shared.joint->getValues());
    }
}

TEST_CASE("shallow copies of a graph share a callback and still have states of their own") {
    tss::SceneModel model = scenes::hinge();
    model.joints[0].drives.clear();
    Rig rig(model);
    install(*rig.root, *rig.scene);
    osg::ref_ptr<osg::Group> copy = osg::clone(rig.root.get(), osg::CopyOp::DEEP_COPY_NODES);
    auto* other = find<JointTransform>(*copy, "Hinge");
    REQUIRE(other != rig.joint);
    REQUIRE(other->getUpdateCallback() == rig.joint->getUpdateCallback());
    osg::ref_ptr<osg::Group> world = new osg::Group;
    world->addChild(rig.root);
    world->addChild(copy);
    Playback playback;
    playback.frame(*world, 0);
    rig.joint->setValue(0, 0.3);
    other->setValue(0, 1.3);
    playback.frames(*world, 1, 2);
    CHECK(rig.joint->getValue(0) == Approx(0.3));
    CHECK(other->getValue(0) == Approx(scenes::contactAngle()).margin(1e-3));
    copy = nullptr;
    world->removeChild(1);
    playback.frames(*world, 3, 4);
    CHECK(rig.joint->getValue(0) == Approx(0.3));
}

TEST_CASE("a deep copy of everything plays by itself") {
    Rig rig(scenes::hinge());
    install(*rig.root, *rig.scene);
    osg::ref_ptr<osg::Group> copy = osg::clone(rig.root.get(), osg::CopyOp::DEEP_COPY_ALL);
    auto* other = find<JointTransform>(*copy, "Hinge");
    REQUIRE(other->getUpdateCallback() != rig.joint->getUpdateCallback());
    rig.root = nullptr;
    Playback playback;
    playback.frames(*copy, 0, 12);
    CHECK(other->getValue(0) == Approx(scenes::contactAngle()).margin(1e-3));
}

TEST_CASE("the state depends on what was asked frame by frame, also when time jumps back") {
    Rig rig(scenes::hinge()), again(scenes::hinge());
    install(*rig.root, *rig.scene);
    install(*again.root, *again.scene);
    Playback a, b;
    for (unsigned int frame : {0u, 5u, 12u, 11u, 3u, 20u, 24u, 2u, 12u, 12u, 12u, 0u}) {
        a.frame(*rig.root, frame);
        b.frame(*again.root, frame);
        CHECK(rig.joint->getValues() == again.joint->getValues());
        CHECK(rig.joint->getValue(0) < scenes::contactAngle() + 1e-6);
    }
}

TEST_CASE("simulation time loops over the scene's time codes") {
    Clock clock;
    clock.start = 10;
    clock.end = 58;
    osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(0.5);
    stamp->setFrameNumber(100);
    CHECK(clock.timeCode(*stamp) == Approx(22));
    stamp->setSimulationTime(2.5);
    CHECK(clock.timeCode(*stamp) == Approx(22));
    stamp->setSimulationTime(-0.5);
    CHECK(clock.timeCode(*stamp) == Approx(46));
    clock.source = Clock::FRAME_NUMBER;
    CHECK(clock.timeCode(*stamp) == Approx(14));
}
