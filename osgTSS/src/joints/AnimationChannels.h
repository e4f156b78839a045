#pragma once
#include <osg/Node>
#include <osg/Quat>
#include <osg/Vec3>
#include <osgAnimation/Animation>
#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/Channel>

#include <map>
#include <string>
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

/// The channels of the osgAnimation managers of a graph, by the target that they animate (the name of an
/// update callback) and its element. A manager animates what is at and below the nodes that it stands on:
/// another character may have bones of the same names.
class AnimationChannels {
public:
    AnimationChannels() = default;
    explicit AnimationChannels(osg::Node& root);

    /// The keys of each channel that animates the element of the node; with values between the keys where the
    /// channel is a curve. Channels of another type are left out.
    template <class Value>
    std::vector<Keys<Value>> keys(const osg::Node& node, const std::string& target,
                                  const std::string& element) const;

    /// Whether some channel, of whatever type, animates the element.
    bool animates(const osg::Node& node, const std::string& target, const std::string& element) const;

    using Channels = std::vector<osg::ref_ptr<const osgAnimation::Channel>>;

    /// The channels that animate the node under the target's name, those of each animation together.
    std::vector<Channels> of(const osg::Node& node, const std::string& target) const;

private:
    /// Of each animation of the managers that stand on one node, by target.
    using Managed = std::multimap<std::string, Channels>;
    std::map<const osg::Node*, Managed> _managed;
};

/// Whether the values between the channel's keys swing as a curve does.
bool isCurve(const osgAnimation::Channel& channel);

/// When a channel has keys, seconds, rising; of a channel of an unknown type its start and its end.
std::vector<double> keyTimes(const osgAnimation::Channel& channel);

} // namespace osgTSS
