#pragma once
#include "FoundJoint.h"
#include "JointNode.h"

#include <osg/Transform>

#include <memory>

namespace osgTSS {

/// An application says of its MatrixTransform or PositionAttitudeTransform how it moves, by user values:
///   osgTSS:dofs   (string) DOFs from the parent inwards with their limits, in degrees and units of length:
///                 "transX:0:5 rotZ:-24:18"; slides before turns, each axis once; about and along the node's
///                 own axes as it stands when it is first extracted, which is where all DOFs are 0
///   osgTSS:pivot  (Vec3d or Vec3f, optional) the point that it turns about, in the node's own frame
///   osgTSS:rest   (Matrixd) that first matrix; set by the first extraction unless the application did
bool isTagged(const osg::Node& node);

/// Throws tss::InputError with the reason for a tag that cannot be served.
FoundJoints taggedJoint(osg::Transform& node);

/// Of a tagged node, or null. While nothing stops it, its matrix is left exactly as the application set it;
/// when something does, what the matrix does beyond the DOFs is lost.
std::unique_ptr<JointNode> makeTaggedNode(osg::Node& node, const tss::Joint& joint);

} // namespace osgTSS
