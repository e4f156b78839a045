#include "DofTransformJoint.h"

#include "bake/base/Error.h"

#include <osgTSS/Convert>

#include <array>
#include <cmath>

namespace osgTSS {

namespace {

/// An axis of a DOFTransform: heading turns about Z, pitch about X, roll about Y.
struct Axis {
    tss::DofKind kind;
    int direction; ///< 0 X, 1 Y, 2 Z
    float current, lower, upper, increment;
    bool limited; ///< the node's limitation flag
};

constexpr unsigned int firstFlag = 0x80000000u; // translations X Y Z, then pitch, roll, yaw

Axis translation(const osgSim::DOFTransform& node, int i) {
    return {tss::DofKind::Translation,
            i,
            node.getCurrentTranslate()[i],
            node.getMinTranslate()[i],
            node.getMaxTranslate()[i],
            node.getIncrementTranslate()[i],
            (node.getLimitationFlags() & (firstFlag >> i)) != 0};
}

/// i: index into HPR.
Axis turn(const osgSim::DOFTransform& node, int i) {
    constexpr std::array<int, 3> direction{2, 0, 1};
    constexpr std::array<int, 3> flag{5, 3, 4};
    return {tss::DofKind::Rotation,
            direction[i],
            node.getCurrentHPR()[i],
            node.getMinHPR()[i],
            node.getMaxHPR()[i],
            node.getIncrementHPR()[i],
            (node.getLimitationFlags() & (firstFlag >> flag[i])) != 0};
}

/// The node multiplies translations first and then the turns in the order of its name, seen as columns.
std::array<Axis, 6> axesInOrder(const osgSim::DOFTransform& node) {
    std::array<int, 3> hpr{};
    switch (node.getHPRMultOrder()) {
    case osgSim::DOFTransform::PRH:
        hpr = {1, 2, 0};
        break;
    case osgSim::DOFTransform::PHR:
        hpr = {1, 0, 2};
        break;
    case osgSim::DOFTransform::HPR:
        hpr = {0, 1, 2};
        break;
    case osgSim::DOFTransform::HRP:
        hpr = {0, 2, 1};
        break;
    case osgSim::DOFTransform::RPH:
        hpr = {2, 1, 0};
        break;
    case osgSim::DOFTransform::RHP:
        hpr = {2, 0, 1};
        break;
    }
    return {translation(node, 0), translation(node, 1), translation(node, 2),
            turn(node, hpr[0]),   turn(node, hpr[1]),   turn(node, hpr[2])};
}

tss::Dof dofOf(const Axis& axis) {
    tss::Dof dof;
    dof.kind = axis.kind;
    dof.name =
        (axis.kind == tss::DofKind::Rotation ? "rot" : "trans") + std::string(1, char('X' + axis.direction));
    dof.axis = tss::Vec3::Unit(axis.direction);
    dof.lower = axis.lower;
    dof.upper = axis.upper;
    const bool animated = axis.increment != 0;
    if (!(axis.lower < axis.upper)) {
        if (!axis.limited && animated) {
            if (axis.kind == tss::DofKind::Translation)
                throw tss::InputError("DOF " + dof.name +
                                      " slides without limits: expected minimum < maximum");
            dof.lower = -osg::PI;
            dof.upper = osg::PI;
        } else {
            dof.lower = dof.upper = axis.current;
        }
    }
    dof.rest = std::min(std::max<double>(axis.current, dof.lower), dof.upper);
    return dof;
}

/// To and fro between the limits, upwards first, for one period.
tss::TimeSamples drive(const tss::Dof& dof, double increment, double rate) {
    tss::TimeSamples samples;
    if (!(increment > 0) || !(dof.lower < dof.upper)) return samples;
    const double codesPerUnit = rate / increment, range = dof.upper - dof.lower;
    const double top = (dof.upper - dof.rest) * codesPerUnit;
    const auto add = [&](double time, double value) {
        if (!samples.times.empty() && !(time > samples.times.back())) return;
        samples.times.push_back(time);
        samples.values.push_back(value);
    };
    add(0, dof.rest);
    add(top, dof.upper);
    add(top + range * codesPerUnit, dof.lower);
    add(2 * range * codesPerUnit, dof.rest);
    return samples;
}

tss::Pose rigidPut(const osg::Matrix& matrix) {
    const auto similarity = toSimilarity(matrix);
    if (!similarity || similarity->scale != 1)
        throw tss::InputError("put matrix: expected a rigid matrix, without scale, shear or mirror");
    return similarity->pose;
}

} // namespace

tss::Joint jointOf(const osgSim::DOFTransform& node, double timeCodesPerSecond) {
    if (node.getCurrentScale() != osg::Vec3(1, 1, 1) ||
        (node.getAnimationOn() && node.getIncrementScale() != osg::Vec3()))
        throw tss::InputError("expected a scale of 1; tables are for rigid bodies");
    tss::Joint joint;
    joint.frame0 = rigidPut(node.getInversePutMatrix());
    joint.frame1 = rigidPut(node.getPutMatrix()).inverse(Eigen::Isometry);
    for (const Axis& axis : axesInOrder(node)) {
        const tss::Dof dof = dofOf(axis);
        if (dof.lower == 0 && dof.upper == 0) continue; // locked where it does nothing
        joint.drives.push_back(node.getAnimationOn() ? drive(dof, axis.increment, timeCodesPerSecond)
                                                     : tss::TimeSamples{});
        joint.dofs.push_back(dof);
    }
    return joint;
}

} // namespace osgTSS
