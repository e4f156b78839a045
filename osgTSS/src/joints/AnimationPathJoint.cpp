#include "JointKinds.h"

#include "osgTSS/src/CallbackOf.h"

#include "bake/base/Error.h"

#include <osg/MatrixTransform>
#include <osg/PositionAttitudeTransform>
#include <osg/observer_ptr>
#include <osgTSS/Convert>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace osgTSS {

namespace {

/// A time of the animation as the path maps it between its ends.
double along(const osg::AnimationPath& path, double time) {
    const double first = path.getFirstTime(), period = path.getPeriod();
    const double rounds = (time - first) / (path.getLoopMode() == osg::AnimationPath::SWING ? 2 : 1) / period;
    double part = rounds - std::floor(rounds);
    switch (path.getLoopMode()) {
    case osg::AnimationPath::SWING:
        return first + 2 * std::min(part, 1 - part) * period;
    case osg::AnimationPath::LOOP:
        return first + part * period;
    case osg::AnimationPath::NO_LOOPING:
        break;
    }
    return std::clamp(time, first, path.getLastTime());
}

tss::TimeSamples oneRound(const osg::AnimationPathCallback& animation, double rate) {
    const osg::AnimationPath& path = *animation.getAnimationPath();
    const double speed = animation.getTimeMultiplier();
    if (!(speed > 0)) return {};
    const double codes = path.getPeriod() * rate / speed;
    tss::TimeSamples samples{{0, codes}, {path.getFirstTime(), path.getLastTime()}};
    if (path.getLoopMode() == osg::AnimationPath::SWING) {
        samples.times.push_back(2 * codes);
        samples.values.push_back(path.getFirstTime());
    }
    return samples;
}

/// Its callback places it by the time alone: nothing is lost by what is shown.
class AnimationPathNode : public JointNode {
public:
    AnimationPathNode(osg::Node& node, osg::AnimationPathCallback& animation)
        : _node(&node), _animation(&animation), _path(animation.getAnimationPath()),
          _points(_path->getTimeControlPointMap()), _pivot(animation.getPivotPoint()),
          _shown(_path->getFirstTime()) {}

    bool valid() const override {
        return _node.valid() && _animation.valid() && _animation->getAnimationPath() &&
               _animation->getAnimationPath()->getPeriod() > 0;
    }
    std::optional<Stray> stray() const override {
        if (!valid() ||
            (_animation->getAnimationPath() == _path && sameKeys() && _animation->getPivotPoint() == _pivot))
            return std::nullopt;
        return Stray{"its animation path is another one", true};
    }

    std::vector<double> asked() const override {
        // Paused, or not begun: the callback leaves the node where it is.
        if (_animation->getPause() || _animation->_firstTime == DBL_MAX) return shown();
        return {along(*_animation->getAnimationPath(), _animation->getAnimationTime())};
    }
    std::vector<double> shown() const override { return {_shown}; }

    void show(const std::vector<double>& values) override {
        const bool asIs = values == asked(); // the callback has placed the node there
        _shown = values[0];
        if (asIs) return;
        osg::AnimationPath::ControlPoint point;
        if (!_animation->getAnimationPath()->getInterpolatedControlPoint(inside(_shown), point)) return;
        if (auto* matrix = dynamic_cast<osg::MatrixTransform*>(_node.get())) {
            osg::Matrixd at;
            point.getMatrix(at);
            matrix->setMatrix(osg::Matrixd::translate(-_animation->getPivotPoint()) * at);
        } else if (auto* transform = dynamic_cast<osg::PositionAttitudeTransform*>(_node.get())) {
            transform->setPosition(point.getPosition());
            transform->setAttitude(point.getRotation());
        }
    }

private:
    /// Looks at one key of the path a call, in turn.
    bool sameKeys() const {
        const osg::AnimationPath::TimeControlPointMap& now = _path->getTimeControlPointMap();
        if (now.size() != _points.size()) return false;
        if (_next == _points.end()) _next = _points.begin();
        const auto& [time, point] = *_next++;
        const auto found = now.find(time);
        return found != now.end() && found->second.getPosition() == point.getPosition() &&
               found->second.getRotation() == point.getRotation() &&
               found->second.getScale() == point.getScale();
    }

    /// A loop takes its last moment for its first.
    double inside(double time) const {
        const osg::AnimationPath& path = *_animation->getAnimationPath();
        return path.getLoopMode() == osg::AnimationPath::LOOP && time >= path.getLastTime()
                   ? std::nextafter(path.getLastTime(), path.getFirstTime())
                   : time;
    }

    osg::observer_ptr<osg::Node> _node;
    osg::observer_ptr<osg::AnimationPathCallback> _animation;
    osg::ref_ptr<const osg::AnimationPath> _path;    ///< that its tables were made for
    osg::AnimationPath::TimeControlPointMap _points; ///< of it, as they were then
    mutable osg::AnimationPath::TimeControlPointMap::const_iterator _next = _points.begin();
    osg::Vec3d _pivot;
    double _shown;
};

} // namespace

osg::AnimationPathCallback* animationPathOf(osg::Node& node) {
    auto* found = callbackOf<osg::AnimationPathCallback>(node.getUpdateCallback());
    return found && found->getAnimationPath() && found->getAnimationPath()->getPeriod() > 0 ? found : nullptr;
}

FoundJoints animationPathJoint(const osg::AnimationPathCallback& animation, double timeCodesPerSecond) {
    if (animation.getUseInverseMatrix())
        throw tss::InputError("its path is used inverted: expected it to place what is below");
    const osg::AnimationPath& path = *animation.getAnimationPath();
    FoundJoints found;
    found.scale = evenScale(path.getTimeControlPointMap().begin()->second.getScale(), found.off);
    tss::Dof dof;
    dof.name = "path0";
    dof.kind = tss::DofKind::Path;
    for (const auto& [time, point] : path.getTimeControlPointMap()) {
        const double scale = evenScale(point.getScale(), found.off), grown = std::abs(scale - found.scale);
        if (scale == 0 || grown > fewDigits * std::abs(found.scale))
            throw tss::InputError(
                "its path scales: expected a scale that is the same in all directions and at all times");
        found.off = std::max(found.off, grown / std::abs(found.scale));
        const osg::Quat& r = point.getRotation();
        tss::PathRow row;
        row.value = time;
        row.translation = toCore(point.getPosition());
        row.rotation = Eigen::Quaterniond(r.w(), r.x(), r.y(), r.z()).normalized();
        dof.path.push_back(row);
    }
    dof.lower = dof.rest = path.getFirstTime();
    dof.upper = path.getLastTime();
    tss::Joint joint;
    joint.frame1.translation() = found.scale * toCore(animation.getPivotPoint());
    joint.dofs = {dof};
    joint.drives = {oneRound(animation, timeCodesPerSecond)};
    found.joints = {joint};
    return found;
}

std::unique_ptr<JointNode> makeAnimationPathNode(osg::Node& node, const tss::Joint& joint) {
    osg::AnimationPathCallback* animation = animationPathOf(node);
    if (!animation || joint.dofs.size() != 1 || joint.dofs[0].kind != tss::DofKind::Path) return nullptr;
    return std::make_unique<AnimationPathNode>(node, *animation);
}

} // namespace osgTSS
