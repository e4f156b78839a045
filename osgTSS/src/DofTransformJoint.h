#pragma once
#include "FoundJoint.h"
#include "JointNode.h"

#include <osgSim/DOFTransform>

#include <memory>

namespace osgTSS {

/// The joint that an osgSim::DOFTransform is: T = inversePut, translations, turns in the node's order, put
/// (as columns). Axes that can move become DOFs named transX ... rotZ, in the node's own units; locked ones
/// stay at their value. With animation on, the drives are the to and fro that the node would make, in time
/// codes at this rate. Throws tss::InputError with the reason for what is not a rigid joint.
FoundJoints dofTransformJoint(const osgSim::DOFTransform& node, double timeCodesPerSecond);

/// Null for DOFs that such a node does not have.
std::unique_ptr<JointNode> makeDofTransformNode(osgSim::DOFTransform& node, const tss::Joint& joint);

} // namespace osgTSS
