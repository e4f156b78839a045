#include "bake/base/Error.h"
#include "osgTSS/src/CallbackOf.h"
#include "osgTSS/src/EachNode.h"
#include "osgTSS/src/UserValues.h"
#include "osgTSS/src/joints/AnimationChannels.h"
#include "osgTSS/src/joints/DofState.h"
#include "osgTSS/src/joints/JointKinds.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <osg/AnimationPath>
#include <osg/NodeCallback>
#include <osg/NodeVisitor>
#include <osg/observer_ptr>
#include <osgAnimation/BasicAnimationManager>
#include <osgTSS/PlayAnimations>
#include <set>
#include <vector>

namespace osgTSS {

namespace {

/// The animations of one manager.
struct Turns {
    osg::observer_ptr<osgAnimation::BasicAnimationManager> manager;
    std::vector<double> ends; ///< when each ends, seconds from the start of the round
    std::size_t now = 0;

    double round() const { return ends.back(); }

    void play(double seconds) {
        osg::ref_ptr<osgAnimation::BasicAnimationManager> playing;
        if (!manager.lock(playing)) return;
        const osgAnimation::AnimationList& list = playing->getAnimationList();
        const double time = std::fmod(seconds, round());
        const auto then = static_cast<std::size_t>(std::ranges::upper_bound(ends, time) - ends.begin());
        const std::size_t next = std::min(then, ends.size() - 1);
        if (list.size() != ends.size() || next == now) return; // the application has others now
        playing->stopAnimation(list[now]);
        playing->playAnimation(list[next]);
        now = next;
    }
};

/// A DOFTransform that nothing moves.
struct Swing {
    osg::observer_ptr<osgSim::DOFTransform> node;
    std::vector<tss::Dof> dofs;
};

constexpr double swingSeconds = 8;

class PlayInTurn : public osg::NodeCallback {
public:
    PlayInTurn(std::vector<Turns> turns, std::vector<Swing> swings)
        : _turns(std::move(turns)), _swings(std::move(swings)) {}

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override {
        if (const osg::FrameStamp* stamp = visitor->getFrameStamp()) {
            if (_start < 0) _start = stamp->getSimulationTime();
            const double seconds = std::max(0.0, stamp->getSimulationTime() - _start);
            for (Turns& turns : _turns) turns.play(seconds);
            int which = 0;
            for (const Swing& swing : _swings)
                if (osg::ref_ptr<osgSim::DOFTransform> moved; swing.node.lock(moved))
                    swingDofs(
                        *moved, swing.dofs, [&] { return 1 + which++ % 3; }, seconds / swingSeconds);
        }
        traverse(node, visitor);
    }

private:
    std::vector<Turns> _turns;
    std::vector<Swing> _swings;
    double _start = -1;
};

double durationOf(osgAnimation::Animation& animation) {
    return std::max(0.0, animation.computeDurationFromChannels());
}

/// The duration of the longest animation that a manager plays already, seconds; 0: it plays none.
double playedBy(osgAnimation::BasicAnimationManager& manager) {
    double longest = 0;
    for (const auto& animation : manager.getAnimationList())
        if (manager.isPlaying(animation.get())) longest = std::max(longest, durationOf(*animation));
    return longest;
}

/// Nothing for a manager that has nothing to play.
std::optional<Turns> turnsOf(osgAnimation::BasicAnimationManager& manager) {
    Turns turns;
    turns.manager = &manager;
    double end = 0;
    for (const auto& animation : manager.getAnimationList())
        turns.ends.push_back(end += durationOf(*animation));
    if (!(end > 0 && std::isfinite(end))) return std::nullopt;
    return turns;
}

/// The swing of a DOFTransform that could move and that nothing moves; nothing for another.
std::optional<Swing> swingOf(osgSim::DOFTransform& node) {
    if (hasFlag(node, "osgTSS:static") || node.getAnimationOn() || node.getUpdateCallback())
        return std::nullopt;
    try {
        std::vector<tss::Dof> dofs = dofTransformJoint(node, 1).joints.front().dofs;
        const auto moves = [](const tss::Dof& dof) { return dof.lower < dof.upper; };
        if (std::ranges::any_of(dofs, moves)) return Swing{&node, std::move(dofs)};
    } catch (const tss::InputError&) { // it is no joint, as was said on loading
    }
    return std::nullopt;
}

/// The duration of the path that a node moves along, seconds; 0: there is none.
double roundOf(osg::Node& node) {
    const auto* found = callbackOf<osg::AnimationPathCallback>(node.getUpdateCallback());
    if (!found || !found->getAnimationPath()) return 0;
    const bool swings = found->getAnimationPath()->getLoopMode() == osg::AnimationPath::SWING;
    const double round =
        (swings ? 2 : 1) * found->getAnimationPath()->getPeriod() / std::abs(found->getTimeMultiplier());
    return std::isfinite(round) ? round : 0;
}

} // namespace

double playAnimations(osg::Node& root) {
    std::vector<Turns> found;
    std::vector<Swing> swings;
    std::set<osg::Node*> seen; // some have several parents
    double longest = 0;
    eachNode(root, [&](osg::Node& node) {
        if (!seen.insert(&node).second) return;
        longest = std::max(longest, roundOf(node));
        auto* dofs = dynamic_cast<osgSim::DOFTransform*>(&node);
        if (std::optional<Swing> swing = dofs ? swingOf(*dofs) : std::nullopt)
            swings.push_back(std::move(*swing));
    });
    for (osgAnimation::AnimationManagerBase* any : animationManagers(root)) {
        auto* manager = dynamic_cast<osgAnimation::BasicAnimationManager*>(any);
        if (!manager) continue;
        if (const double played = playedBy(*manager); played > 0) {
            longest = std::max(longest, played);
            continue;
        }
        std::optional<Turns> turns = turnsOf(*manager);
        if (!turns) continue;
        manager->playAnimation(manager->getAnimationList().front());
        longest = std::max(longest, turns->round());
        found.push_back(std::move(*turns));
    }
    if (!swings.empty()) longest = std::max(longest, swingSeconds);
    if (!found.empty() || !swings.empty())
        root.addUpdateCallback(new PlayInTurn(std::move(found), std::move(swings)));
    return longest;
}

} // namespace osgTSS
