#include "SwingDofs.h"

#include "bake/motion/WholeTurn.h"

#include <algorithm>
#include <cmath>

namespace osgTSS {

void swingDofs(osgSim::DOFTransform& node, std::span<const tss::Dof> dofs,
               const std::function<double()>& rounds, double share) {
    constexpr int componentOfTurn[3] = {1, 2, 0}; // of HPR
    node.setAnimationOn(false);
    osg::Vec3 turn = node.getCurrentHPR(), slide = node.getCurrentTranslate();
    for (const tss::Dof& dof : dofs) {
        const int axis = dof.name.back() - 'X';
        if (axis < 0 || axis > 2 || dof.kind == tss::DofKind::Path) continue;
        const bool whole = tss::wholeTurn(dof);
        const double lower = whole ? dof.rest - osg::PI : dof.lower;
        const double upper = whole ? dof.rest + osg::PI : dof.upper;
        const double half = (upper - lower) / 2, middle = (upper + lower) / 2;
        const double from = half > 0 ? std::asin(std::clamp((dof.rest - middle) / half, -1.0, 1.0)) : 0;
        const double value = middle + half * std::sin(from + 2 * osg::PI * rounds() * share);
        (dof.kind == tss::DofKind::Rotation ? turn[componentOfTurn[axis]] : slide[axis]) =
            static_cast<float>(value);
    }
    node.setCurrentHPR(turn);
    node.setCurrentTranslate(slide);
}

} // namespace osgTSS
