#pragma once
#include "bake/motion/Motion.h"

#include <osgSim/DOFTransform>

#include <array>
#include <functional>
#include <span>

namespace osgTSS {

/// The numbers by which a DOFTransform moves: its translation along X, Y and Z, then heading, pitch and roll.
using DofState = std::array<float, 6>;

DofState dofState(const osgSim::DOFTransform& node);
void setDofState(osgSim::DOFTransform& node, const DofState& state);

/// Where a DOF along or about a coordinate axis stands in it: heading turns about Z, pitch about X, roll
/// about Y.
std::size_t placeOf(tss::DofKind kind, int axis);

/// Puts the axes of a DOFTransform where they are on their way up and down between the limits of its DOFs,
/// from rest at share 0 on; one that turns all the way round goes half a turn to either side of rest. rounds:
/// asked once per DOF, how often it goes until share 1. Ends the node's own animation.
void swingDofs(osgSim::DOFTransform& node, std::span<const tss::Dof> dofs,
               const std::function<double()>& rounds, double share);

} // namespace osgTSS
