#pragma once
#include <osg/Node>
#include <osg/Quat>
#include <osg/Vec3>
#include <osgAnimation/Animation>
#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/Channel>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgTSS {

/// The animation managers among the update callbacks of a graph, each once.
std::vector<osgAnimation::AnimationManagerBase*> animationManagers(osg::Node& root);

/// Values over time, seconds: of a channel of numbers, vectors or turns.
template <class Value>
struct Keys {
    std::vector<double> times;
    std::vector<Value> values;
};

/// The channels of all osgAnimation managers of a graph, by the target that they animate (the name of an
/// update callback) and its element.
class AnimationChannels {
public:
    AnimationChannels() = default;
    explicit AnimationChannels(osg::Node& root);

    /// The keys of each channel that animates the element; with values between the keys where the channel is
    /// a curve. Channels of another type are left out.
    template <class Value>
    std::vector<Keys<Value>> keys(const std::string& target, const std::string& element) const;

    /// Whether some channel, of whatever type, animates the element.
    bool animates(const std::string& target, const std::string& element) const {
        return _channels.contains({target, element});
    }

    using Channels = std::vector<osg::ref_ptr<const osgAnimation::Channel>>;

    /// The channels that animate a target, those of each animation together.
    const std::vector<Channels>& of(const std::string& target) const;

private:
    void addAnimation(osgAnimation::Animation& animation);

    std::map<std::pair<std::string, std::string>, Channels> _channels;
    std::map<std::string, std::vector<Channels>> _targets;
};

/// When a channel has keys, seconds, rising; of a channel of an unknown type its start and its end.
std::vector<double> keyTimes(const osgAnimation::Channel& channel);

} // namespace osgTSS
