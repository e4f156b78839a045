#pragma once
#include "FoundJoint.h"
#include "JointNode.h"

#include <osgSim/DOFTransform>

#include <memory>

namespace osgTSS {

/// The joint that an osgSim::DOFTransform is: T = inversePut, translations, turns in the node's order, put
/// (as columns). Axes that can move become DOFs named transX ... rotZ, in the node's own units; locked ones
/// stay at their value. Of an axis that the node does not limit (its bit of LimitationFlags is off) a turn is
/// a whole one, a slide has the limits that are there all the same; without any it stays, and is named as
/// unlimited. The user value "osgTSS:limits" ("rotZ:-24:18 transX:0:5", degrees and units) says otherwise of
/// the axes that it names; where it begins with "written" the others have the limits that are written in the
/// node, whatever its flags. With animation on, the drives are what the node would do, in time codes at this
/// rate. Throws tss::InputError with the reason for what is not a rigid joint.
FoundJoints dofTransformJoint(const osgSim::DOFTransform& node, double timeCodesPerSecond);

/// Null for DOFs that such a node does not have.
std::unique_ptr<JointNode> makeDofTransformNode(osgSim::DOFTransform& node, const tss::Joint& joint);

} // namespace osgTSS
