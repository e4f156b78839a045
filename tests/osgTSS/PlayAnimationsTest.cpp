// Animations of a file that nothing plays.
#include <algorithm>
#include <catch2/catch.hpp>
#include <osg/AnimationPath>
#include <osg/Group>
#include <osg/MatrixTransform>
#include <osg/ValueObject>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Channel>
#include <osgSim/DOFTransform>
#include <osgTSS/PlayAnimations>
#include <osgUtil/UpdateVisitor>
#include <vector>

namespace {

osg::ref_ptr<osgAnimation::Animation> animation(const std::string& name, double seconds) {
    osg::ref_ptr<osgAnimation::FloatLinearChannel> channel = new osgAnimation::FloatLinearChannel;
    channel->setName("x");
    channel->setTargetName("nobody");
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    keys->push_back(osgAnimation::FloatKeyframe(0, 0));
    keys->push_back(osgAnimation::FloatKeyframe(seconds, 1));
    osg::ref_ptr<osgAnimation::Animation> made = new osgAnimation::Animation;
    made->setName(name);
    made->addChannel(channel);
    return made;
}

struct Animated {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgAnimation::BasicAnimationManager> manager = new osgAnimation::BasicAnimationManager;

    Animated() {
        osg::ref_ptr<osg::Group> below = new osg::Group;
        below->setUpdateCallback(manager);
        root->addChild(below);
        for (const auto& [name, seconds] : {std::pair("walk", 1.0), {"run", 2.0}, {"jump", 0.5}})
            manager->registerAnimation(animation(name, seconds));
    }

    std::string playingAt(double time) {
        osg::ref_ptr<osgUtil::UpdateVisitor> update = new osgUtil::UpdateVisitor;
        osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setSimulationTime(time);
        update->setFrameStamp(stamp);
        update->setTraversalNumber(++frame);
        root->accept(*update);
        std::string names;
        for (const auto& one : manager->getAnimationList())
            if (manager->isPlaying(one.get())) names += one->getName() + " ";
        return names;
    }

    unsigned int frame = 0;
};

} // namespace

TEST_CASE("animations that nothing plays are played one after the other, round and round") {
    Animated graph;
    CHECK(osgTSS::playAnimations(*graph.root) == Approx(3.5));
    // From whenever the first traversal is.
    CHECK(graph.playingAt(10) == "walk ");
    CHECK(graph.playingAt(10.9) == "walk ");
    CHECK(graph.playingAt(11.1) == "run ");
    CHECK(graph.playingAt(12.9) == "run ");
    CHECK(graph.playingAt(13.2) == "jump ");
    CHECK(graph.playingAt(13.6) == "walk ");
    CHECK(graph.playingAt(18.2) == "run ");
}

TEST_CASE("what the application plays is left to it") {
    Animated graph;
    graph.manager->playAnimation(graph.manager->getAnimationList()[1]);
    CHECK(osgTSS::playAnimations(*graph.root) == Approx(2)); // of what plays
    CHECK_FALSE(graph.root->getUpdateCallback());
    CHECK(graph.playingAt(5) == "run ");
    osg::ref_ptr<osg::Group> empty = new osg::Group;
    CHECK(osgTSS::playAnimations(*empty) == 0);
    osg::ref_ptr<osg::MatrixTransform> moved = new osg::MatrixTransform;
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    path->insert(1, osg::AnimationPath::ControlPoint(osg::Vec3d()));
    path->insert(4, osg::AnimationPath::ControlPoint(osg::Vec3d(1, 0, 0)));
    moved->setUpdateCallback(new osg::AnimationPathCallback(path, 0, 2));
    empty->addChild(moved);
    CHECK(osgTSS::playAnimations(*empty) == Approx(1.5));
    path->setLoopMode(osg::AnimationPath::SWING);
    CHECK(osgTSS::playAnimations(*empty) == Approx(3));
}

TEST_CASE("DOFTransforms that nothing moves go up and down between their limits, others stay") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<osg::ref_ptr<osgSim::DOFTransform>> nodes;
    for (int k = 0; k < 4; ++k) {
        osg::ref_ptr<osgSim::DOFTransform> node = new osgSim::DOFTransform;
        node->setCurrentScale(osg::Vec3(1, 1, 1));
        node->setLimitationFlags(0xff800000u);
        node->setMinHPR(osg::Vec3(-0.5f, 0, 0));
        node->setMaxHPR(osg::Vec3(1, 0, 0));
        node->setAnimationOn(false);
        root->addChild(node);
        nodes.push_back(node);
    }
    nodes[1]->setUserValue("osgTSS:static", true);
    nodes[2]->setUpdateCallback(new osg::NodeCallback);
    nodes[3]->setCurrentScale(osg::Vec3(1, 2, 3)); // no joint
    CHECK(osgTSS::playAnimations(*root) == Approx(8));
    osgUtil::UpdateVisitor update;
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    update.setFrameStamp(stamp);
    float least = 1e9f, most = -1e9f;
    for (unsigned int frame = 0; frame <= 192; ++frame) {
        stamp->setSimulationTime(7 + frame / 24.0);
        stamp->setFrameNumber(frame);
        update.setTraversalNumber(frame);
        root->accept(update);
        const float heading = nodes[0]->getCurrentHPR()[0];
        if (frame % 192 == 0) CHECK(heading == Approx(0).margin(1e-5));
        least = std::min(least, heading);
        most = std::max(most, heading);
        for (int k = 1; k < 4; ++k) REQUIRE(nodes[k]->getCurrentHPR() == osg::Vec3());
    }
    CHECK(least == Approx(-0.5).margin(0.01));
    CHECK(most == Approx(1).margin(0.01));
}
