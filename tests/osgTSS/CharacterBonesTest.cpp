#include "Heard.h"
#include "Nodes.h"
#include "Sitter.h"

#include "bake/base/Error.h"

#include <osgAnimation/StackedRotateAxisElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgTSS/Bake>

#include <algorithm>

using namespace osgTSS;
using nodes::extract;

namespace {

osgAnimation::StackedTransform& stackOf(Sitter& sitter, const std::string& bone) {
    return dynamic_cast<osgAnimation::UpdateBone&>(*sitter.bones.at(bone)->getUpdateCallback())
        .getStackedTransforms();
}

/// The keys of a bone that turn it.
osgAnimation::QuatKeyframeContainer& keysOf(Sitter& sitter, const std::string& bone) {
    for (const auto& channel : sitter.animation->getChannels())
        if (channel->getTargetName() == bone)
            return *dynamic_cast<osgAnimation::QuatSphericalLinearChannel&>(*channel)
                        .getOrCreateSampler()
                        ->getOrCreateKeyframeContainer();
    throw tss::InputError("no keys of " + bone);
}

const tss::Joint& joint(const tss::SceneModel& model, const std::string& name) {
    for (const tss::Joint& found : model.joints)
        if (found.path.substr(found.path.rfind('/') + 1) == name) return found;
    throw tss::InputError("no joint " + name);
}

double widest(const tss::Joint& joint) {
    double most = 0;
    for (const tss::Dof& dof : joint.dofs) most = std::max(most, dof.upper - dof.lower);
    return most;
}

void checkAlike(const tss::Joint& a, const tss::Joint& b) {
    CHECK(a.frame0.isApprox(b.frame0, 1e-6));
    CHECK(a.frame1.isApprox(b.frame1, 1e-6));
    REQUIRE(a.dofs.size() == b.dofs.size());
    for (std::size_t k = 0; k < a.dofs.size(); ++k) {
        CHECK(a.dofs[k].lower == Approx(b.dofs[k].lower).margin(1e-6));
        CHECK(a.dofs[k].upper == Approx(b.dofs[k].upper).margin(1e-6));
        CHECK(a.dofs[k].rest == Approx(b.dofs[k].rest).margin(1e-6));
    }
}

} // namespace

TEST_CASE("What hangs on a root bone at the origin rests as it is bound, whatever its first key is",
          "[osgTSS]") {
    Sitter sitter;
    keysOf(sitter, "Upper").front().setValue(osg::Quat(osg::DegreesToRadians(30.0), osg::Vec3(0, 1, 0)));
    const tss::SceneModel model = extract(*sitter.root);
    const tss::Dof& turn = joint(model, "Upper").dofs.at(0);
    const double range = (turn.upper - turn.lower) / 1.1; // from where it is bound, at one end, to 60 degrees
    CHECK(range == Approx(osg::DegreesToRadians(Sitter::swing)));
    CHECK(std::min(turn.rest - turn.lower, turn.upper - turn.rest) == Approx(0.05 * range));
}

TEST_CASE("A curve that swings beyond its keys makes limits that hold all of it", "[osgTSS]") {
    Sitter sitter;
    stackOf(sitter, "Upper")
        .push_back(new osgAnimation::StackedRotateAxisElement("rotateY", osg::Vec3(0, 1, 0), 0));
    keysOf(sitter, "Upper").resize(1); // it turns no more
    osg::ref_ptr<osgAnimation::FloatCubicBezierChannel> channel = new osgAnimation::FloatCubicBezierChannel;
    channel->setName("rotateY");
    channel->setTargetName("Upper");
    using Curve = osgAnimation::FloatCubicBezier;
    auto* sampler = channel->getOrCreateSampler();
    auto* keys = sampler->getOrCreateKeyframeContainer();
    keys->push_back(osgAnimation::FloatCubicBezierKeyframe(0, Curve(0, 2, 0)));
    keys->push_back(osgAnimation::FloatCubicBezierKeyframe(2, Curve(0, 0, 0)));
    sitter.animation->addChannel(channel);
    float most = 0;
    for (int step = 0; step < 1000; ++step) {
        float angle = 0;
        sampler->getValueAt(0.002 * step, angle);
        most = std::max(most, angle);
    }
    CHECK(widest(joint(extract(*sitter.root), "Upper")) == Approx(1.1 * most).epsilon(2e-3));
}

TEST_CASE("What an animation does not move of a bone is where the others begin, not where it is now",
          "[osgTSS]") {
    Sitter sitter;
    auto* slide = new osgAnimation::StackedTranslateElement("translate", osg::Vec3());
    stackOf(sitter, "Upper").push_back(slide);
    osg::ref_ptr<osgAnimation::Vec3LinearChannel> channel = new osgAnimation::Vec3LinearChannel;
    channel->setName("translate");
    channel->setTargetName("Upper");
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    for (int k = 0; k < 3; ++k)
        keys->push_back(osgAnimation::Vec3Keyframe(k, osg::Vec3(0.05f * float(k), 0, 0)));
    osg::ref_ptr<osgAnimation::Animation> other = new osgAnimation::Animation;
    other->setName("slide");
    other->addChannel(channel);
    sitter.manager->registerAnimation(other);
    const tss::SceneModel before = extract(*sitter.root);
    slide->setTranslate(osg::Vec3(0.1f, 0, 0));
    checkAlike(joint(extract(*sitter.root), "Upper"), joint(before, "Upper"));
}

TEST_CASE("Of two characters whose bones have the same names each has its own keys", "[osgTSS]") {
    Sitter one, other;
    keysOf(other, "Upper")[1].setValue(osg::Quat(osg::DegreesToRadians(-50.0), osg::Vec3(0, 0, 1)));
    const tss::Joint first = joint(extract(*one.root), "Upper"),
                     second = joint(extract(*other.root), "Upper");
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(one.root);
    both->addChild(other.root);
    const tss::SceneModel model = extract(*both);
    checkAlike(joint(model, "Upper"), first);
    checkAlike(joint(model, "Upper2"), second);
}

TEST_CASE("A table of one character serves two that are alike", "[osgTSS]") {
    Sitter one, other;
    const osg::ref_ptr<Scene> scene = osgTSS::bake(*one.root, BakeOptions("tolerance=0.05"));
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    const osg::ref_ptr<osg::MatrixTransform> beside =
        new osg::MatrixTransform(osg::Matrix::translate(0, 3, 0));
    beside->addChild(other.root);
    both->addChild(one.root);
    both->addChild(beside);
    CHECK(install(*both, *scene).stale == 0);
    one.play();
    other.play();
    Playback playback;
    for (unsigned int frame = 0; frame < 96; ++frame) {
        playback.frame(*both, frame);
        INFO("frame " << frame);
        CHECK(one.depth() == 0);
        CHECK(other.depth() == 0);
    }
}

TEST_CASE("A mesh that comes to a skeleton later is drawn as its bones are held", "[osgTSS]") {
    Sitter sitter;
    const osg::ref_ptr<Scene> scene = osgTSS::bake(*sitter.root, BakeOptions("tolerance=0.05"));
    REQUIRE(install(*sitter.root, *scene).joints >= 1);
    sitter.play();
    Playback playback;
    playback.frames(*sitter.root, 0, 5);
    const osg::ref_ptr<osgAnimation::RigGeometry> late = new osgAnimation::RigGeometry;
    late->setSourceGeometry(sitter.rig->getSourceGeometry());
    late->setInfluenceMap(sitter.rig->getInfluenceMap());
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(late);
    sitter.skeleton->addChild(geode);
    for (unsigned int frame = 6; frame < 96; ++frame) {
        playback.frame(*sitter.root, frame);
        INFO("frame " << frame);
        const auto& drawn = static_cast<const osg::Vec3Array&>(*late->getVertexArray());
        CHECK(std::vector<osg::Vec3>(drawn.begin(), drawn.end()) == sitter.drawn());
    }
}
