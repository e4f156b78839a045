#include "Heard.h"
#include "Playback.h"

#include "bake/model/Kinematics.h"
#include "bake/model/SourceHash.h"
#include "bake/scene/SceneLayer.h"

#include <catch2/catch.hpp>
#include <osg/AnimationPath>
#include <osg/MatrixTransform>
#include <osg/PositionAttitudeTransform>
#include <osg/ShapeDrawable>
#include <osg/ValueObject>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedRotateAxisElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateMatrixTransform>
#include <osgSim/DOFTransform>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Convert>
#include <osgTSS/Install>

#include <functional>

using namespace osgTSS;

namespace {

/// What an application would have: something fixed, and a ball that a transform below `above` moves.
struct Rig {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform;
    osg::ref_ptr<osg::Transform> moving;
    osg::Vec3d ball{1, 0, 0}; ///< in the moving transform

    explicit Rig(osg::Transform* transform) : moving(transform) {
        root->addChild(new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 0.2f)));
        root->addChild(above);
        above->addChild(moving);
        moving->setName("Moving");
        moving->addChild(new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(ball), 0.25f)));
    }
    osg::Vec3d ballInWorld() const { return ball * moving->getWorldMatrices().at(0); }
    osg::Matrixd matrix() const { return moving->getWorldMatrices().at(0); }
};

tss::SceneModel extractAndRead(osg::Node& root,
                               ConstraintVisitor::Pairs pairs = ConstraintVisitor::NEIGHBOURS) {
    ConstraintVisitor visitor(pairs);
    root.accept(visitor);
    return tss::readScene(tss::toLayer(visitor.getModel()), "extracted");
}

constexpr double obstacleRadius = 0.3, ballRadius = 0.25;

/// A table of two spheres: one in the world, one about the ball.
void addObstacle(tss::SceneModel& model, const Rig& rig, const osg::Vec3d& obstacle) {
    tss::Pair& pair = model.pairs.at(0);
    ConstraintVisitor visitor;
    rig.root->accept(visitor);
    const double scale = visitor.getBodyNodes().at(static_cast<std::size_t>(pair.bodyB)).scale;
    const double size = rig.matrix().getScale().x();
    pair.table = std::make_shared<tss::Table>(tss::makeTable({{toCore(obstacle), obstacleRadius}},
                                                             {{scale * toCore(rig.ball), ballRadius * size}},
                                                             {{0, 0}}, {}, pairMotion(model, pair)));
}

/// The same but for what limits that were found between keys of a curve cut off it.
bool alike(const osg::Matrixd& a, const osg::Matrixd& b) {
    for (int i = 0; i < 16; ++i)
        if (std::abs(a.ptr()[i] - b.ptr()[i]) > 5e-4) return false;
    return true;
}

/// Plays a rig beside one that nothing stops, told each frame what to do: the same while the way is free,
/// never nearer to the obstacle than the two radii, and both happen.
void checkStops(const std::function<Rig()>& make, const std::function<void(Rig&, unsigned int)>& ask,
                const osg::Vec3d& obstacle, unsigned int frames) {
    Rig free = make(), held = make();
    tss::SceneModel model = extractAndRead(*held.root);
    REQUIRE(model.joints.size() >= 1);
    REQUIRE(model.pairs.size() == 1);
    addObstacle(model, held, obstacle);
    const double reach = obstacleRadius + ballRadius * held.matrix().getScale().x();
    REQUIRE(install(*held.root, model).joints == 1);
    Playback a, b;
    unsigned int same = 0, stopped = 0;
    for (unsigned int frame = 0; frame < frames; ++frame) {
        ask(free, frame);
        ask(held, frame);
        a.frame(*free.root, frame);
        b.frame(*held.root, frame);
        CHECK((held.ballInWorld() - obstacle).length() > reach - 1e-5);
        if (alike(held.matrix(), free.matrix()))
            ++same;
        else
            ++stopped;
        if ((free.ballInWorld() - obstacle).length() < reach - 1e-3) CHECK(held.matrix() != free.matrix());
    }
    CHECK(same > frames / 8);
    CHECK(stopped > frames / 20);
}

osg::ref_ptr<osg::AnimationPath> arc(osg::AnimationPath::LoopMode mode) {
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    path->setLoopMode(mode);
    for (int key = 0; key <= 8; ++key)
        path->insert(1 + 0.5 * key,
                     osg::AnimationPath::ControlPoint(osg::Vec3d(0.1 * key, 0, 0.05 * key * key),
                                                      osg::Quat(-1 + 0.3 * key, osg::Vec3d(0, 0.2, 1))));
    return path;
}

void still(Rig&, unsigned int) {}

} // namespace

TEST_CASE(
    "an animation path is a joint along its keys, for MatrixTransforms and PositionAttitudeTransforms") {
    const bool attitude = GENERATE(false, true);
    osg::ref_ptr<osg::AnimationPathCallback> animation =
        new osg::AnimationPathCallback(arc(osg::AnimationPath::LOOP), 0, 1.25);
    animation->setPivotPoint(osg::Vec3d(0.5, 0.1, 0));
    Rig rig(attitude ? static_cast<osg::Transform*>(new osg::PositionAttitudeTransform)
                     : new osg::MatrixTransform);
    rig.moving->setUpdateCallback(animation);
    rig.above->setMatrix(osg::Matrixd::scale(2, 2, 2) * osg::Matrixd::rotate(0.4, 1, 2, 3) *
                         osg::Matrixd::translate(1, 2, 3));
    const tss::SceneModel model = extractAndRead(*rig.root);
    REQUIRE(model.joints.size() == 1);
    REQUIRE(model.joints[0].dofs.size() == 1);
    CHECK(model.joints[0].dofs[0].lower == 1);
    CHECK(model.joints[0].dofs[0].upper == 5);
    Playback playback;
    for (unsigned int frame = 0; frame < 70; ++frame) {
        playback.frame(*rig.root, frame);
        const double time = std::fmod(frame / 24.0 * 1.25 - 1 + 400, 4) + 1;
        const osg::Matrixd ours =
            osg::Matrixd::scale(2, 2, 2) * toOsg(tss::jointPose(model.joints[0], std::vector{time}));
        const osg::Matrixd theirs = rig.matrix();
        for (int i = 0; i < 16; ++i) CHECK(ours.ptr()[i] == Approx(theirs.ptr()[i]).margin(2e-5));
    }
}

TEST_CASE("an animated path is held at contact and goes on where the way is free") {
    const auto mode =
        GENERATE(osg::AnimationPath::LOOP, osg::AnimationPath::SWING, osg::AnimationPath::NO_LOOPING);
    const auto make = [&] {
        Rig rig(new osg::MatrixTransform);
        rig.moving->setUpdateCallback(new osg::AnimationPathCallback(arc(mode)));
        return rig;
    };
    Rig probe = make();
    Playback playback;
    playback.frames(*probe.root, 0, 80);
    checkStops(make, still, probe.ballInWorld() + osg::Vec3d(0, 0.2, 0.1), 24 * 16);
}

TEST_CASE("a path that is exchanged or gets other keys leaves its proof, by name") {
    Rig rig(new osg::MatrixTransform);
    osg::ref_ptr<osg::AnimationPathCallback> animation =
        new osg::AnimationPathCallback(arc(osg::AnimationPath::LOOP));
    rig.moving->setUpdateCallback(animation);
    tss::SceneModel model = extractAndRead(*rig.root);
    REQUIRE(model.pairs.size() == 1);
    model.pairs[0].proof = std::make_shared<tss::NeverCollides>();
    model.pairs[0].sourceHash = tss::sourceHash(model, model.pairs[0]);
    REQUIRE(install(*rig.root, model).proven == 1);
    Playback playback;
    const bool exchanged = GENERATE(true, false);
    {
        const Heard heard;
        playback.frames(*rig.root, 0, 3);
        CHECK(heard.times("animation path") == 0);
    }
    if (exchanged)
        animation->setAnimationPath(arc(osg::AnimationPath::SWING));
    else
        animation->getAnimationPath()->insert(9, osg::AnimationPath::ControlPoint(osg::Vec3d(9, 0, 0)));
    const Heard heard;
    playback.frames(*rig.root, 3, 6);
    CHECK(heard.times("its animation path is another one") == 1);
}

TEST_CASE("a path that scales unequally moves its own body, and is said to be no joint") {
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    path->insert(0, osg::AnimationPath::ControlPoint(osg::Vec3d()));
    path->insert(1, osg::AnimationPath::ControlPoint(osg::Vec3d(), osg::Quat(), osg::Vec3d(2, 2, 2)));
    Rig rig(new osg::MatrixTransform);
    rig.moving->setUpdateCallback(new osg::AnimationPathCallback(path));
    const tss::SceneModel model = extractAndRead(*rig.root);
    CHECK(model.joints.empty());
    CHECK(model.bodies.size() == 2);
}

TEST_CASE("scales that differ by rounding alone are one, of a path and of a DOFTransform") {
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    const osg::Vec3d almost(0.99999982, 1, 1.0000002);
    path->insert(0, osg::AnimationPath::ControlPoint(osg::Vec3d(), osg::Quat(), almost));
    path->insert(1, osg::AnimationPath::ControlPoint(osg::Vec3d(0, 0, 1), osg::Quat(), osg::Vec3d(1, 1, 1)));
    Rig rig(new osg::MatrixTransform);
    rig.moving->setUpdateCallback(new osg::AnimationPathCallback(path));
    CHECK(extractAndRead(*rig.root).joints.size() == 1);

    osg::ref_ptr<osgSim::DOFTransform> node = new osgSim::DOFTransform;
    node->setMaxHPR(osg::Vec3(1, 0, 0));
    Rig hinge(node.get());
    for (const auto& [scale, joints] : {std::pair{2.0000004f, 1u}, {2.01f, 0u}}) {
        node->setCurrentScale(osg::Vec3(2, scale, 2));
        CHECK(extractAndRead(*hinge.root).joints.size() == joints);
    }
}

namespace {

using namespace osgAnimation;

template <class ChannelType, class Value>
osg::ref_ptr<ChannelType> channel(const std::string& element,
                                  const std::vector<std::pair<double, Value>>& keys) {
    osg::ref_ptr<ChannelType> made = new ChannelType;
    made->setTargetName("arm");
    made->setName(element);
    auto* container = made->getOrCreateSampler()->getOrCreateKeyframeContainer();
    for (const auto& [time, value] : keys)
        container->push_back(typename ChannelType::KeyframeContainerType::KeyType(time, value));
    return made;
}

/// Elements that do not share a frame: a turn about a slanting axis, a fixed step, a slide, a quaternion.
Rig stacked() {
    Rig rig(new osg::MatrixTransform);
    osg::ref_ptr<UpdateMatrixTransform> update = new UpdateMatrixTransform("arm");
    StackedTransform& stack = update->getStackedTransforms();
    stack.push_back(new StackedTranslateElement("base", osg::Vec3(0.5f, 0, 0.25f)));
    stack.push_back(new StackedRotateAxisElement("swing", osg::Vec3(0, 0.6f, 0.8f), 0));
    stack.push_back(new StackedTranslateElement("step", osg::Vec3(0, 0, 0.5f)));
    stack.push_back(new StackedQuaternionElement("wrist", osg::Quat()));
    stack.push_back(new StackedTranslateElement("reach", osg::Vec3()));
    rig.moving->setUpdateCallback(update);
    rig.moving->setDataVariance(osg::Object::DYNAMIC);

    osg::ref_ptr<Animation> animation = new Animation;
    animation->setPlayMode(Animation::PPONG);
    animation->addChannel(channel<FloatLinearChannel, float>("swing", {{0, -1.0f}, {2, 1.5f}, {3, 1.0f}}));
    animation->addChannel(channel<Vec3CubicBezierChannel, Vec3CubicBezier>(
        "reach", {{0, Vec3CubicBezier(osg::Vec3(), osg::Vec3(), osg::Vec3(0.8f, 0, 0))},
                  {3, Vec3CubicBezier(osg::Vec3(0.3f, 0, 0), osg::Vec3(-0.4f, 0, 0), osg::Vec3())}}));
    animation->addChannel(channel<QuatSphericalLinearChannel, osg::Quat>(
        "wrist", {{0, osg::Quat()},
                  {1, osg::Quat(2, osg::Vec3d(0, 1, 0))},
                  {3, osg::Quat(2, osg::Vec3d(0, 1, 0)) * osg::Quat(0.5, osg::Vec3d(1, 0, 0))}}));
    osg::ref_ptr<BasicAnimationManager> manager = new BasicAnimationManager;
    manager->registerAnimation(animation);
    rig.root->setUpdateCallback(manager);
    manager->playAnimation(animation);
    return rig;
}

} // namespace

TEST_CASE("a stack of osgAnimation becomes joints whose limits are the range of the keys") {
    Rig rig = stacked();
    const tss::SceneModel model = extractAndRead(*rig.root);
    REQUIRE(model.joints.size() == 2); // the step between them is fixed
    std::vector<const tss::Dof*> dofs;
    for (const tss::Joint& joint : model.joints)
        for (const tss::Dof& dof : joint.dofs) dofs.push_back(&dof);
    REQUIRE(dofs.size() == 7);
    CHECK(dofs[0]->name == "swing");
    CHECK(dofs[0]->lower == Approx(-1));
    CHECK(dofs[0]->upper == Approx(1.5));
    CHECK(dofs[4]->name == "reach.x");
    CHECK(dofs[4]->upper > 0.3);
    CHECK(model.pairs.size() == 1);
    CHECK(model.pairs[0].joints.size() == model.joints.size());
}

TEST_CASE("a stack of osgAnimation is held at contact and goes on where the way is free") {
    Rig probe = stacked();
    Playback playback;
    playback.frames(*probe.root, 0, 84);
    // Off the way, so that the arm is pushed aside and finds back; in the way it would stay behind it.
    checkStops(stacked, still, probe.ballInWorld() + osg::Vec3d(-0.35, 0, 0.25), 24 * 12);
}

TEST_CASE("a transform that the application tagged and sets is held at contact, and its wish remembered") {
    const bool attitude = GENERATE(false, true);
    const double scale = GENERATE(1.0, 0.5, -1.0);
    const auto make = [&] {
        Rig rig(attitude ? static_cast<osg::Transform*>(new osg::PositionAttitudeTransform)
                         : new osg::MatrixTransform);
        rig.moving->setUserValue("osgTSS:dofs", std::string("transX:-1:1 rotZ:-90:90 rotY:-30:30"));
        rig.moving->setUserValue("osgTSS:pivot", osg::Vec3d(0.25, 0, 0));
        rig.above->setMatrix(osg::Matrixd::scale(scale, scale, scale) * osg::Matrixd::translate(0, 1, 0));
        return rig;
    };
    const auto ask = [&](Rig& rig, unsigned int frame) {
        const double t = frame / 40.0;
        const osg::Quat turn = osg::Quat(0.4 * std::sin(3 * t), osg::Y_AXIS) *
                               osg::Quat(1.2 * std::sin(2 * t), osg::Z_AXIS); // rows: Y first
        const osg::Vec3d slide(0.3 * std::sin(t), 0, 0), pivot(0.25, 0, 0);
        if (auto* matrix = dynamic_cast<osg::MatrixTransform*>(rig.moving.get()))
            matrix->setMatrix(osg::Matrixd::translate(-pivot) * osg::Matrixd::rotate(turn) *
                              osg::Matrixd::translate(pivot + slide));
        auto* transform = dynamic_cast<osg::PositionAttitudeTransform*>(rig.moving.get());
        if (!transform) return;
        transform->setPivotPoint(pivot);
        transform->setPosition(pivot + slide);
        transform->setAttitude(turn);
    };
    if (scale < 0) {
        // The mirror turns the obstacle's place round, too.
        checkStops(make, ask, osg::Vec3d(-0.9, 0.5, 0), 400);
    } else {
        checkStops(make, ask, osg::Vec3d(0, 1, 0) + osg::Vec3d(0.8, 0.9, 0) * scale, 400);
    }
}

TEST_CASE("a tag that cannot be served is no joint, and the path and what was expected are told") {
    for (const std::string tag :
         {"", "rotZ", "rotQ:0:1", "rotZ:5:10", "rotZ:0:1 transX:0:1", "rotX:0:1 rotX:0:2"}) {
        CAPTURE(tag);
        Rig rig(new osg::MatrixTransform);
        rig.moving->setUserValue("osgTSS:dofs", tag);
        const Heard heard;
        CHECK(extractAndRead(*rig.root).joints.empty());
        CHECK(heard.times("Moving") == 1);
        CHECK(heard.times("osgTSS:dofs") == 1);
    }
}

TEST_CASE("a DOFTransform as OpenSceneGraph makes it, of scale 0, is no joint, and what helps is told") {
    Rig rig(new osgSim::DOFTransform);
    const Heard heard;
    CHECK(extractAndRead(*rig.root).joints.empty());
    CHECK(heard.times("Moving: it moves, but is no joint") == 1);
    CHECK(heard.times("setCurrentScale(osg::Vec3(1, 1, 1))") == 1);
}

TEST_CASE("any two tagged bodies make a pair, and others do not") {
    osg::ref_ptr<osg::Group> root = new osg::Group;
    for (int i = 0; i < 4; ++i) {
        osg::ref_ptr<osg::MatrixTransform> arm =
            new osg::MatrixTransform(osg::Matrixd::translate(3 * i, 0, 0));
        arm->setName("Arm" + std::to_string(i));
        arm->setUserValue("osgTSS:dofs", std::string("rotZ:-90:90"));
        if (i != 1) arm->setUserValue("osgTSS:collides", std::string(i < 3 ? "left" : "right"));
        arm->addChild(new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(1, 0, 0), 0.25f)));
        root->addChild(arm);
    }
    const tss::SceneModel model = extractAndRead(*root, ConstraintVisitor::TAGGED);
    REQUIRE(model.pairs.size() == 1);
    CHECK(model.bodies[model.pairs[0].bodyA].displayName == "Arm0");
    CHECK(model.bodies[model.pairs[0].bodyB].displayName == "Arm2");
    CHECK(extractAndRead(*root, ConstraintVisitor::SIBLINGS).pairs.size() == 6);
}

TEST_CASE("a mirrored joint turns and slides as the graph does") {
    osg::ref_ptr<osgSim::DOFTransform> dof = new osgSim::DOFTransform;
    dof->setCurrentScale(osg::Vec3(2, 2, 2));
    dof->setAnimationOn(false);
    dof->setMinHPR(osg::Vec3(-1, -1, -1));
    dof->setMaxHPR(osg::Vec3(1, 1, 1));
    dof->setMinTranslate(osg::Vec3(-1, -1, -1));
    dof->setMaxTranslate(osg::Vec3(1, 1, 1));
    const osg::Matrixd put = osg::Matrixd::rotate(0.3, 1, 1, 0) * osg::Matrixd::translate(0.5, 0, 1);
    dof->setPutMatrix(put);
    dof->setInversePutMatrix(osg::Matrixd::inverse(put));
    Rig rig(dof);
    rig.above->setMatrix(osg::Matrixd::scale(-1.5, 1.5, 1.5) * osg::Matrixd::rotate(1, 0, 1, 1) *
                         osg::Matrixd::translate(0, 0, 3));
    ConstraintVisitor visitor;
    rig.root->accept(visitor);
    const tss::SceneModel model = visitor.getModel();
    REQUIRE(model.joints.size() == 1);
    const double scale = visitor.getBodyNodes()[1].scale;
    CHECK(scale == Approx(-3));
    for (int pose = 0; pose < 20; ++pose) {
        dof->setCurrentHPR(osg::Vec3(std::sin(pose), std::sin(2 * pose), std::sin(3 * pose)));
        dof->setCurrentTranslate(osg::Vec3(std::cos(pose), std::cos(2 * pose), std::cos(3 * pose)));
        std::vector<double> q;
        for (const tss::Dof& d : model.joints[0].dofs) {
            const int axis = d.name.back() - 'X';
            const int ofHpr[3] = {1, 2, 0};
            q.push_back(d.name.substr(0, 3) == "rot" ? dof->getCurrentHPR()[ofHpr[axis]]
                                                     : dof->getCurrentTranslate()[axis]);
        }
        const osg::Matrixd ours =
            osg::Matrixd::scale(scale, scale, scale) * toOsg(tss::jointPose(model.joints[0], q));
        const osg::Matrixd theirs = rig.matrix();
        for (int i = 0; i < 16; ++i) CHECK(ours.ptr()[i] == Approx(theirs.ptr()[i]).margin(2e-6));
    }
}
