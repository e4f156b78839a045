#include "AnimationChannels.h"

#include "bake/base/Order.h"
#include "osgTSS/src/CallbackOf.h"
#include "osgTSS/src/EachNode.h"

#include <algorithm>

namespace osgTSS {

namespace {

using namespace osgAnimation;

template <class... Containers>
void timesOf(const KeyframeContainer& container, std::vector<double>& times) {
    const auto add = [&](const auto* keys) {
        if (!keys) return false;
        for (const auto& key : *keys) times.push_back(key.getTime());
        return true;
    };
    (add(dynamic_cast<const Containers*>(&container)) || ...);
}

/// The node itself first.
void addAbove(const osg::Node& node, std::vector<const osg::Node*>& above) {
    if (std::ranges::find(above, &node) != above.end()) return;
    above.push_back(&node);
    for (unsigned int k = 0; k < node.getNumParents(); ++k) addAbove(*node.getParent(k), above);
}

} // namespace

std::vector<AnimationManagerBase*> animationManagers(osg::Node& root) {
    std::vector<AnimationManagerBase*> found;
    eachNode(root, [&](osg::Node& node) {
        for (AnimationManagerBase* manager : callbacksOf<AnimationManagerBase>(node.getUpdateCallback()))
            if (std::ranges::find(found, manager) == found.end()) found.push_back(manager);
    });
    return found;
}

AnimationChannels::AnimationChannels(osg::Node& root) {
    eachNode(root, [&](osg::Node& node) {
        if (_managed.contains(&node)) return; // it has several parents
        for (AnimationManagerBase* manager : callbacksOf<AnimationManagerBase>(node.getUpdateCallback()))
            for (const auto& animation : manager->getAnimationList()) {
                std::map<std::string, Channels> targets;
                for (const auto& channel : animation->getChannels())
                    targets[channel->getTargetName()].push_back(channel);
                _managed[&node].insert(targets.begin(), targets.end());
            }
    });
}

std::vector<AnimationChannels::Channels> AnimationChannels::of(const osg::Node& node,
                                                               const std::string& target) const {
    std::vector<Channels> found;
    std::vector<const osg::Node*> above;
    addAbove(node, above);
    for (const osg::Node* at : above) {
        const auto managed = _managed.find(at);
        if (managed == _managed.end()) continue;
        const auto [first, last] = managed->second.equal_range(target);
        for (auto entry = first; entry != last; ++entry) found.push_back(entry->second);
    }
    return found;
}

std::vector<double> keyTimes(const Channel& channel) {
    const Sampler* sampler = channel.getSampler();
    const KeyframeContainer* container = sampler ? sampler->getKeyframeContainer() : nullptr;
    std::vector<double> times;
    if (container)
        timesOf<FloatKeyframeContainer, DoubleKeyframeContainer, Vec2KeyframeContainer, Vec3KeyframeContainer,
                Vec4KeyframeContainer, QuatKeyframeContainer, MatrixKeyframeContainer,
                FloatCubicBezierKeyframeContainer, DoubleCubicBezierKeyframeContainer,
                Vec2CubicBezierKeyframeContainer, Vec3CubicBezierKeyframeContainer,
                Vec4CubicBezierKeyframeContainer>(*container, times);
    if (times.empty() && container && container->size() > 0)
        times = {channel.getStartTime(), channel.getEndTime()};
    tss::sortOnce(times);
    return times;
}

bool isCurve(const Channel& channel) {
    const Sampler* sampler = channel.getSampler();
    const KeyframeContainer* keys = sampler ? sampler->getKeyframeContainer() : nullptr;
    return dynamic_cast<const FloatCubicBezierKeyframeContainer*>(keys) ||
           dynamic_cast<const DoubleCubicBezierKeyframeContainer*>(keys) ||
           dynamic_cast<const Vec2CubicBezierKeyframeContainer*>(keys) ||
           dynamic_cast<const Vec3CubicBezierKeyframeContainer*>(keys) ||
           dynamic_cast<const Vec4CubicBezierKeyframeContainer*>(keys);
}

osg::Matrix stackMatrix(const StackedTransform& elements) {
    osg::Matrix matrix;
    for (const auto& element : elements)
        if (!element->isIdentity()) element->applyToMatrix(matrix);
    return matrix;
}

std::vector<osg::ref_ptr<Channel>> channelsOf(StackedTransformElement& element,
                                              const AnimationChannels::Channels& animation) {
    std::vector<osg::ref_ptr<Channel>> found;
    for (const auto& channel : animation) {
        if (element.getName() != channel->getName()) continue;
        const osg::ref_ptr<Channel> copy = channel->clone();
        Target* target = element.getOrCreateTarget();
        if (target && copy->setTarget(target)) found.push_back(copy);
    }
    return found;
}

std::vector<double> withSteps(const std::vector<double>& keyTimes, int steps) {
    std::vector<double> times;
    for (std::size_t k = 0; k + 1 < keyTimes.size(); ++k)
        for (int step = 0; step < steps; ++step)
            times.push_back(keyTimes[k] + (keyTimes[k + 1] - keyTimes[k]) * step / steps);
    if (!keyTimes.empty()) times.push_back(keyTimes.back());
    return times;
}

bool AnimationChannels::animates(const osg::Node& node, const std::string& target,
                                 const std::string& element) const {
    return std::ranges::any_of(of(node, target), [&](const Channels& animation) {
        return std::ranges::any_of(animation,
                                   [&](const auto& channel) { return channel->getName() == element; });
    });
}

} // namespace osgTSS
