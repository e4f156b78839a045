#pragma once
#include <osg/Node>
#include <osgAnimation/Animation>
#include <osgAnimation/AnimationManagerBase>
#include <osgAnimation/Channel>
#include <osgAnimation/StackedTransform>

#include <map>
#include <string>
#include <vector>

namespace osgTSS {

/// The animation managers among the update callbacks of a graph, each once.
std::vector<osgAnimation::AnimationManagerBase*> animationManagers(osg::Node& root);

/// The channels of the osgAnimation managers of a graph, by the target that they animate (the name of an
/// update callback) and its element. A manager animates what is at and below the nodes that it stands on:
/// another character may have bones of the same names.
class AnimationChannels {
public:
    AnimationChannels() = default;
    explicit AnimationChannels(osg::Node& root);

    /// Whether some channel, of whatever type, animates the element.
    bool animates(const osg::Node& node, const std::string& target, const std::string& element) const;

    using Channels = std::vector<osg::ref_ptr<const osgAnimation::Channel>>;

    /// The channels that animate the node under the target's name, those of each animation together.
    std::vector<Channels> of(const osg::Node& node, const std::string& target) const;

private:
    /// The channels of each animation of the managers that stand on one node, by target.
    using Managed = std::multimap<std::string, Channels>;
    std::map<const osg::Node*, Managed> _managed;
};

/// Whether the values between the channel's keys swing as a curve does.
bool isCurve(const osgAnimation::Channel& channel);

/// Between the keys of a curve it is followed so finely that what it swings beyond the samples is less than a
/// part in a thousand of a step between two keys.
inline constexpr int stepsOfCurve = 32;

/// When a channel has keys, seconds, rising; of a channel of an unknown type its start and its end.
std::vector<double> keyTimes(const osgAnimation::Channel& channel);

/// These times, and so many steps from each to the next.
std::vector<double> withSteps(const std::vector<double>& keyTimes, int steps);

/// What the elements of a stack, with their values now, make together.
osg::Matrix stackMatrix(const osgAnimation::StackedTransform& elements);

/// Copies of those channels of an animation that move the element, which is their target.
std::vector<osg::ref_ptr<osgAnimation::Channel>> channelsOf(osgAnimation::StackedTransformElement& element,
                                                            const AnimationChannels::Channels& animation);

} // namespace osgTSS
