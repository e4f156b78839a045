#include "osgTSS/src/joints/AnimationChannels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <osg/NodeCallback>
#include <osg/NodeVisitor>
#include <osgAnimation/BasicAnimationManager>
#include <osgTSS/PlayAnimations>
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

class PlayInTurn : public osg::NodeCallback {
public:
    explicit PlayInTurn(std::vector<Turns> turns) : _turns(std::move(turns)) {}

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override {
        if (const osg::FrameStamp* stamp = visitor->getFrameStamp()) {
            if (_start < 0) _start = stamp->getSimulationTime();
            for (Turns& turns : _turns) turns.play(std::max(0.0, stamp->getSimulationTime() - _start));
        }
        traverse(node, visitor);
    }

private:
    std::vector<Turns> _turns;
    double _start = -1;
};

/// Nothing for a manager that is playing, or has nothing to play.
std::optional<Turns> turnsOf(osgAnimation::BasicAnimationManager& manager) {
    Turns turns;
    turns.manager = &manager;
    double end = 0;
    for (const auto& animation : manager.getAnimationList()) {
        if (manager.isPlaying(animation.get())) return std::nullopt;
        turns.ends.push_back(end += std::max(0.0, animation->computeDurationFromChannels()));
    }
    if (!(end > 0 && std::isfinite(end))) return std::nullopt;
    return turns;
}

} // namespace

double playAnimations(osg::Node& root) {
    std::vector<Turns> found;
    double longest = 0;
    for (osgAnimation::AnimationManagerBase* any : animationManagers(root)) {
        auto* manager = dynamic_cast<osgAnimation::BasicAnimationManager*>(any);
        std::optional<Turns> turns = manager ? turnsOf(*manager) : std::nullopt;
        if (!turns) continue;
        manager->playAnimation(manager->getAnimationList().front());
        longest = std::max(longest, turns->round());
        found.push_back(std::move(*turns));
    }
    if (!found.empty()) root.addUpdateCallback(new PlayInTurn(std::move(found)));
    return longest;
}

} // namespace osgTSS
