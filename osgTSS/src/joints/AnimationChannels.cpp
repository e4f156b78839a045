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

} // namespace

std::vector<AnimationManagerBase*> animationManagers(osg::Node& root) {
    std::vector<AnimationManagerBase*> found;
    eachNode(root, [&](osg::Node& node) {
        for (osg::Callback* callback = node.getUpdateCallback(); callback;
             callback = callback->getNestedCallback())
            if (auto* manager = dynamic_cast<AnimationManagerBase*>(callback))
                if (std::ranges::find(found, manager) == found.end()) found.push_back(manager);
    });
    return found;
}

AnimationChannels::AnimationChannels(osg::Node& root) {
    for (AnimationManagerBase* manager : animationManagers(root))
        for (const auto& animation : manager->getAnimationList()) addAnimation(*animation);
}

void AnimationChannels::addAnimation(osgAnimation::Animation& animation) {
    std::map<std::string, Channels> targets;
    for (const auto& channel : animation.getChannels()) {
        _channels[{channel->getTargetName(), channel->getName()}].push_back(channel);
        targets[channel->getTargetName()].push_back(channel);
    }
    for (auto& [target, channels] : targets) _targets[target].push_back(std::move(channels));
}

const std::vector<AnimationChannels::Channels>& AnimationChannels::of(const std::string& target) const {
    static const std::vector<Channels> none;
    const auto found = _targets.find(target);
    return found != _targets.end() ? found->second : none;
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

template <class Value>
std::vector<Keys<Value>> AnimationChannels::keys(const std::string& target,
                                                 const std::string& element) const {
    std::vector<Keys<Value>> all;
    const auto found = _channels.find({target, element});
    if (found == _channels.end()) return all;
    for (const auto& channel : found->second) readAny(*channel, all);
    return all;
}

template std::vector<Keys<double>> AnimationChannels::keys(const std::string&, const std::string&) const;
template std::vector<Keys<osg::Vec3d>> AnimationChannels::keys(const std::string&, const std::string&) const;
template std::vector<Keys<osg::Quat>> AnimationChannels::keys(const std::string&, const std::string&) const;

} // namespace osgTSS
