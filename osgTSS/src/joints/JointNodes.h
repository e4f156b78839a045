#pragma once
#include "FoundJoint.h"
#include "JointNode.h"

#include <osg/Transform>

#include <map>
#include <memory>
#include <optional>
#include <string>

namespace osgTSS {

class AnimationChannels;

/// The joints that a transform is: a JointTransform, an osgSim::DOFTransform, a transform tagged with
/// "osgTSS:dofs", an osgAnimation::Bone that keys move, or one that an osg::AnimationPathCallback or an
/// osgAnimation::UpdateMatrixTransform moves; nothing for another. Throws tss::InputError with the reason for
/// one of the first three that cannot be served; what cannot be served of the others is nothing, and `why`
/// then says so.
std::optional<FoundJoints> jointsOf(osg::Transform& node, const AnimationChannels& channels,
                                    double timeCodesPerSecond, std::string& why);

/// Whether a node of this kind is a joint whatever moves it: one of the first three.
bool saysJoint(osg::Node& node);

/// Reads and writes the values of one of the joints of a node that jointsOf() knows; null for another node or
/// for DOFs that the node does not have.
std::unique_ptr<JointNode> makeJointNode(osg::Node& node, const tss::Joint& joint);

/// Names the joints that a node carries. On another node than a JointTransform it is a user value, so that it
/// is saved and cloned with the node.
void tagJoint(osg::Node& node, const std::string& jointPath);

/// Whether the node carries a joint.
bool carriesJoint(osg::Node& node);

/// The nodes at and below `root` that carry a joint, by the joint's path, in the order of the graph. Sees
/// masked nodes.
std::map<std::string, std::vector<osg::Node*>> findJointNodes(osg::Node& root);

} // namespace osgTSS
