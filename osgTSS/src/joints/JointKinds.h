#pragma once
#include "AnimationChannels.h"
#include "FoundJoint.h"
#include "JointNode.h"

#include <osg/AnimationPath>
#include <osg/Matrixd>
#include <osg/Node>
#include <osg/Transform>
#include <osgAnimation/UpdateMatrixTransform>
#include <osgSim/DOFTransform>

#include <memory>
#include <optional>

namespace osgTSS {

// Each kind of node that is a joint: which joints it is, and what reads and writes their values on it.

/// The joint that an osgSim::DOFTransform is: T = inversePut, translations, turns in the node's order, put
/// (as columns). Axes that can move become DOFs named transX ... rotZ, in the node's own units; locked ones
/// stay at their value. Of an axis that the node does not limit (its bit of LimitationFlags is off) a turn is
/// a whole one, a slide has the limits that are there all the same; without any it stays, and is named as
/// unlimited. The user value "osgTSS:limits" ("rotZ:-24:18 transX:0:5", degrees and units) says otherwise of
/// the axes that it names; where it begins with "written" the others have the limits that are written in the
/// node, whatever its flags. With animation on, the drives are what the node would do, in time codes at this
/// rate. Throws tss::InputError with the reason for what is not a rigid joint.
FoundJoints dofTransformJoint(const osgSim::DOFTransform& node, double timeCodesPerSecond);

/// Reads and writes the values of such a joint; null for DOFs that the node does not have.
std::unique_ptr<JointNode> makeDofTransformNode(osgSim::DOFTransform& node, const tss::Joint& joint);

/// An application says of its MatrixTransform or PositionAttitudeTransform how it moves, by user values:
///   osgTSS:dofs   (string) DOFs from the parent inwards with their limits, in degrees and units of length:
///                 "transX:0:5 rotZ:-24:18"; slides before turns, each axis once; about and along the node's
///                 own axes as it stands when it is first extracted, which is where all DOFs are 0
///   osgTSS:pivot  (Vec3d or Vec3f, optional) the point that it turns about, in the node's own frame
///   osgTSS:rest   (Matrixd) that first matrix; set by the first extraction unless the application did
bool isTagged(const osg::Node& node);

/// Throws tss::InputError with the reason for a tag that cannot be served.
FoundJoints taggedJoint(osg::Transform& node);

/// Reads and writes the values of a tagged node; null for another. While nothing stops it, its matrix is left
/// exactly as the application set it; when something does, what the matrix does beyond the DOFs is lost.
std::unique_ptr<JointNode> makeTaggedNode(osg::Node& node, const tss::Joint& joint);

/// The joint of an osgAnimation::Bone (boneMotion()); nothing for one that stands and for other nodes. Its
/// frames, or where it stands, are left on the bone as user values ("osgTSS:frame0", "osgTSS:frame1",
/// "osgTSS:stands"), so that what plays needs no keys.
std::optional<FoundJoints> boneJoint(osg::Node& node, const AnimationChannels& channels);

/// The matrix of a bone that no key moves, which may differ from the one that it has before its first update;
/// nothing for other nodes.
std::optional<osg::Matrixd> standingBone(const osg::Node& node);

/// Reads and writes a bone with such frames; null for another node. It does so with the bone's matrix, after
/// whatever has set that; the bones' matrices in the skeleton are SkeletonPose's. A pose that the joint does
/// not know is left as it is, and stray() says so.
std::unique_ptr<JointNode> makeBoneNode(osg::Node& node, const tss::Joint& joint);

/// The animation path callback among a node's update callbacks, null when there is none.
osg::AnimationPathCallback* animationPathOf(osg::Node& node);

/// The joint that an animated path is: one DOF, the time along the path in its own seconds, from the first
/// control point to the last; linear and slerp between control points, as OSG has it. The drive is one round
/// (to and fro for SWING). Throws tss::InputError with the reason for what is not a rigid path.
FoundJoints animationPathJoint(const osg::AnimationPathCallback& animation, double timeCodesPerSecond);

/// Reads and writes a MatrixTransform or PositionAttitudeTransform with such a callback; null for another.
std::unique_ptr<JointNode> makeAnimationPathNode(osg::Node& node, const tss::Joint& joint);

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

/// Reads and writes a node with such a stack; null for DOFs that it does not have.
std::unique_ptr<JointNode> makeStackedNode(osg::Node& node, const tss::Joint& joint);

} // namespace osgTSS
