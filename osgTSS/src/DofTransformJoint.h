#pragma once
#include "bake/scene/SceneModel.h"

#include <osgSim/DOFTransform>

namespace osgTSS {

/// The joint that an osgSim::DOFTransform is: T = inversePut, translations, turns in the node's order, put
/// (as columns). Axes that can move become DOFs named transX ... rotZ, in the node's own units; locked ones
/// stay at their value. With animation on, the drives are the to and fro that the node would make, in time
/// codes at this rate. Throws tss::InputError with the reason for what is not a rigid joint.
tss::Joint jointOf(const osgSim::DOFTransform& node, double timeCodesPerSecond);

} // namespace osgTSS
