#pragma once
#include "AnimationChannels.h"
#include "FoundJoint.h"
#include "JointNode.h"

#include <osg/Matrixd>
#include <osg/Node>

#include <memory>
#include <optional>

namespace osgTSS {

/// The joint of an osgAnimation::Bone (boneMotion()); nothing for one that stands and for other nodes. Its
/// frames, or where it stands, are left on the bone as user values ("osgTSS:frame0", "osgTSS:frame1",
/// "osgTSS:stands"), so that what plays needs no keys.
std::optional<FoundJoints> boneJoint(osg::Node& node, const AnimationChannels& channels);

/// The matrix of a bone that no key moves, which may differ from the one that it has before its first update;
/// nothing for other nodes.
std::optional<osg::Matrixd> standingBone(const osg::Node& node);

/// Of a bone with such frames; null for another node. It reads and writes the bone's matrix after whatever
/// has set that; the bones' matrices in the skeleton are SkeletonPose's. A pose that the joint does not know
/// is left as it is, and stray() says so.
std::unique_ptr<JointNode> makeBoneNode(osg::Node& node, const tss::Joint& joint);

} // namespace osgTSS
