#include "AnimationChannels.h"

#include "osgTSS/src/EachNode.h"

#include <osgAnimation/AnimationManagerBase>

#include <algorithm>

namespace osgTSS {

namespace {

using namespace osgAnimation;

/// Keys of the channel if it is of this type. Curves are followed between their keys, so finely that what
/// they swing beyond the samples is less than a part in a thousand of a step between two keys.
template <class ChannelType, class Value>
bool read(const Channel& channel, int steps, std::vector<Keys<Value>>& out) {
    const auto* typed = dynamic_cast<const ChannelType*>(&channel);
    if (!typed) return false;
    const auto* sampler = typed->getSamplerTyped();
    const auto* container = sampler ? sampler->getKeyframeContainerTyped() : nullptr;
    if (!container || container->empty()) return true;
    Keys<Value> keys;
    const auto add = [&](double time) {
        typename ChannelType::UsingType value;
        sampler->getValueAt(time, value);
        keys.times.push_back(time);
        keys.values.push_back(Value(value));
    };
    for (std::size_t k = 0; k + 1 < container->size(); ++k) {
        const double from = (*container)[k].getTime(), to = (*container)[k + 1].getTime();
        if (!(from < to)) continue;
        for (int step = 0; step < steps; ++step) add(from + (to - from) * step / steps);
    }
    add(container->back().getTime());
    out.push_back(std::move(keys));
    return true;
}

template <class... Containers>
void timesOf(const KeyframeContainer& container, std::vector<double>& times) {
    const auto add = [&](const auto* keys) {
        if (!keys) return false;
        for (const auto& key : *keys) times.push_back(key.getTime());
        return true;
    };
    (add(dynamic_cast<const Containers*>(&container)) || ...);
}

constexpr int curve = 32;

void readAny(const Channel& channel, std::vector<Keys<double>>& out) {
    read<FloatLinearChannel>(channel, 1, out) || read<DoubleLinearChannel>(channel, 1, out) ||
        read<FloatStepChannel>(channel, 1, out) || read<DoubleStepChannel>(channel, 1, out) ||
        read<FloatCubicBezierChannel>(channel, curve, out) ||
        read<DoubleCubicBezierChannel>(channel, curve, out);
}

void readAny(const Channel& channel, std::vector<Keys<osg::Vec3d>>& out) {
    read<Vec3LinearChannel>(channel, 1, out) || read<Vec3StepChannel>(channel, 1, out) ||
        read<Vec3CubicBezierChannel>(channel, curve, out);
}

void readAny(const Channel& channel, std::vector<Keys<osg::Quat>>& out) {
    read<QuatSphericalLinearChannel>(channel, curve, out) || read<QuatStepChannel>(channel, 1, out);
}

std::vector<AnimationManagerBase*> managersOn(osg::Node& node) {
    std::vector<AnimationManagerBase*> found;
    for (osg::Callback* callback = node.getUpdateCallback(); callback;
         callback = callback->getNestedCallback())
        if (auto* manager = dynamic_cast<AnimationManagerBase*>(callback)) found.push_back(manager);
    return found;
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
        for (AnimationManagerBase* manager : managersOn(node))
            if (std::ranges::find(found, manager) == found.end()) found.push_back(manager);
    });
    return found;
}

AnimationChannels::AnimationChannels(osg::Node& root) {
    eachNode(root, [&](osg::Node& node) {
        if (_managed.contains(&node)) return; // it has several parents
        for (AnimationManagerBase* manager : managersOn(node))
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
    std::ranges::sort(times);
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

template <class Value>
std::vector<Keys<Value>> AnimationChannels::keys(const osg::Node& node, const std::string& target,
                                                 const std::string& element) const {
    std::vector<Keys<Value>> all;
    for (const Channels& animation : of(node, target))
        for (const auto& channel : animation)
            if (channel->getName() == element) readAny(*channel, all);
    return all;
}

bool AnimationChannels::animates(const osg::Node& node, const std::string& target,
                                 const std::string& element) const {
    return std::ranges::any_of(of(node, target), [&](const Channels& animation) {
        return std::ranges::any_of(animation,
                                   [&](const auto& channel) { return channel->getName() == element; });
    });
}

template std::vector<Keys<double>> AnimationChannels::keys(const osg::Node&, const std::string&,
                                                           const std::string&) const;
template std::vector<Keys<osg::Vec3d>> AnimationChannels::keys(const osg::Node&, const std::string&,
                                                               const std::string&) const;
template std::vector<Keys<osg::Quat>> AnimationChannels::keys(const osg::Node&, const std::string&,
                                                              const std::string&) const;

} // namespace osgTSS
