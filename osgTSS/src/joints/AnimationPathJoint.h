#pragma once
#include "FoundJoint.h"
#include "JointNode.h"

#include <osg/AnimationPath>
#include <osg/Node>

#include <memory>

namespace osgTSS {

/// The animation path callback among a node's update callbacks, null when there is none.
osg::AnimationPathCallback* animationPathOf(osg::Node& node);

/// The joint that an animated path is: one DOF, the time along the path in its own seconds, from the first
/// control point to the last; linear and slerp between control points, as OSG has it. The drive is one round
/// (to and fro for SWING). Throws tss::InputError with the reason for what is not a rigid path.
FoundJoints animationPathJoint(const osg::AnimationPathCallback& animation, double timeCodesPerSecond);

/// Of a MatrixTransform or PositionAttitudeTransform with such a callback, or null.
std::unique_ptr<JointNode> makeAnimationPathNode(osg::Node& node, const tss::Joint& joint);

} // namespace osgTSS
