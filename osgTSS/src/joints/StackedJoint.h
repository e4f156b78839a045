#pragma once
#include "AnimationChannels.h"
#include "FoundJoint.h"
#include "JointNode.h"

#include <osgAnimation/UpdateMatrixTransform>

#include <memory>

namespace osgTSS {

/// The osgAnimation callback that moves a MatrixTransform by a stack of elements; null when there is none,
/// and for bones, whose matrices hang together otherwise.
osgAnimation::UpdateMatrixTransform* stackOf(osg::Node& node);

/// The joints that a node's stack is. Each element that some channel moves is a DOF, or three: "name" of a
/// turn about an axis, "name.x" ... "name.z" of a translation, "name.turn" of a quaternion whose keys turn
/// about one axis, "name.rx" ... "name.rz" of another. Limits are the range that the channels' keys span;
/// drives are the keys where one channel alone moves the element. Throws tss::InputError with the reason for
/// what is not a rigid motion with limits.
FoundJoints stackedJoints(const osg::Node& node, osgAnimation::UpdateMatrixTransform& animation,
                          const AnimationChannels& channels, double timeCodesPerSecond);

/// Of a node with such a stack; null for DOFs that it does not have.
std::unique_ptr<JointNode> makeStackedNode(osg::Node& node, const tss::Joint& joint);

} // namespace osgTSS
