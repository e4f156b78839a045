#include "DofState.h"

#include "AxisDofs.h"

#include "bake/motion/WholeTurn.h"

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgTSS {

DofState dofState(const osgSim::DOFTransform& node) {
    const osg::Vec3 &slide = node.getCurrentTranslate(), &turn = node.getCurrentHPR();
    return {slide[0], slide[1], slide[2], turn[0], turn[1], turn[2]};
}

void setDofState(osgSim::DOFTransform& node, const DofState& state) {
    node.setCurrentTranslate(osg::Vec3(state[0], state[1], state[2]));
    node.setCurrentHPR(osg::Vec3(state[3], state[4], state[5]));
}

std::size_t placeOf(tss::DofKind kind, int axis) {
    constexpr std::array<std::size_t, 3> ofTurn{4, 5, 3};
    return kind == tss::DofKind::Rotation ? ofTurn.at(axis) : static_cast<std::size_t>(axis);
}

void swingDofs(osgSim::DOFTransform& node, std::span<const tss::Dof> dofs,
               const std::function<double()>& rounds, double share) {
    node.setAnimationOn(false);
    DofState state = dofState(node);
    for (const tss::Dof& dof : dofs) {
        const auto [lower, upper] = tss::limitsAboutRest(dof);
        const double half = (upper - lower) / 2, middle = (upper + lower) / 2;
        const double from = half > 0 ? std::asin(std::clamp((dof.rest - middle) / half, -1.0, 1.0)) : 0;
        const double value = middle + half * std::sin(from + 2 * osg::PI * rounds() * share);
        state[placeOf(dof.kind, axisOf(dof))] = static_cast<float>(value);
    }
    setDofState(node, state);
}

} // namespace osgTSS
