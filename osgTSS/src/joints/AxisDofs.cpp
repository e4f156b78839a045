#include "AxisDofs.h"

#include "bake/base/Error.h"
#include "bake/motion/AxisTurns.h"
#include "bake/motion/DofUnits.h"
#include "bake/motion/WholeTurn.h"
#include "bake/scene/DofToken.h"

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace osgTSS {

int axisOf(const tss::Dof& dof) {
    int axis = 0;
    dof.axis.cwiseAbs().maxCoeff(&axis);
    return axis;
}

AxisDofs::AxisDofs(std::vector<tss::Dof> dofs) : _dofs(std::move(dofs)) {
    for (const tss::Dof& dof : _dofs)
        if (dof.kind == tss::DofKind::Rotation) _order[_turns++] = axisOf(dof);
    std::size_t count = _turns;
    for (int axis = 0; axis < 3 && count < 3; ++axis)
        if (std::find(_order.begin(), _order.begin() + _turns, axis) == _order.begin() + _turns)
            _order[count++] = axis;
}

tss::Pose AxisDofs::poseAt(const std::vector<double>& values) const {
    tss::Pose pose = tss::Pose::Identity();
    for (std::size_t k = 0; k < _dofs.size(); ++k) {
        const tss::Vec3 axis = tss::Vec3::Unit(axisOf(_dofs[k]));
        if (_dofs[k].kind == tss::DofKind::Rotation)
            pose.rotate(Eigen::AngleAxisd(values[k], axis));
        else
            pose.translate(values[k] * axis);
    }
    return pose;
}

std::vector<double> AxisDofs::valuesOf(const tss::Pose& pose) const {
    const std::array<double, 3> first = tss::turnsOf(pose.linear(), _order),
                                other{first[0] + osg::PI, osg::PI - first[1], first[2] + osg::PI};
    const std::vector<double> values = valuesBy(first, pose.translation()),
                              others = valuesBy(other, pose.translation());
    return beyond(others, other) < beyond(values, first) - 1e-9 ? others : values;
}

std::vector<double> AxisDofs::valuesBy(const std::array<double, 3>& turns, const tss::Vec3& slides) const {
    std::vector<double> values;
    std::size_t turn = 0;
    for (const tss::Dof& dof : _dofs)
        values.push_back(dof.kind == tss::DofKind::Rotation
                             ? tss::nearestTurn(turns[turn++], (dof.lower + dof.upper) / 2)
                             : slides[axisOf(dof)]);
    return values;
}

/// How far turns go beyond the limits, and those that no DOF makes from 0.
double AxisDofs::beyond(const std::vector<double>& values, const std::array<double, 3>& turns) const {
    double sum = 0;
    for (std::size_t k = 0; k < _dofs.size(); ++k)
        if (_dofs[k].kind == tss::DofKind::Rotation)
            sum += std::max({0.0, _dofs[k].lower - values[k], values[k] - _dofs[k].upper});
    for (std::size_t k = _turns; k < turns.size(); ++k) sum += std::abs(tss::nearestTurn(turns[k], 0));
    return sum;
}

namespace {

tss::Dof parseDofWord(const std::string& word, const std::string& tag) {
    std::istringstream text(word);
    std::string token;
    double lower = 0, upper = 0;
    char colon = 0;
    tss::Dof dof;
    std::size_t path = 0;
    std::getline(text, token, ':');
    text >> lower >> colon >> upper;
    if (text.fail() || colon != ':' || text.peek() != EOF || !tss::dofFromToken(token, dof, path) ||
        dof.kind == tss::DofKind::Path || !(lower <= upper) || !std::isfinite(lower) || !std::isfinite(upper))
        throw tss::InputError(tag + ": expected words such as rotZ:-24:18 or transX:0:5, found \"" + word +
                              "\"");
    dof.name = token;
    dof.lower = tss::fromUser(dof, lower);
    dof.upper = tss::fromUser(dof, upper);
    return dof;
}

} // namespace

std::vector<tss::Dof> parseDofWords(const std::string& words, const std::string& tag) {
    std::istringstream text(words);
    std::vector<tss::Dof> dofs;
    for (std::string word; text >> word;) dofs.push_back(parseDofWord(word, tag));
    return dofs;
}

} // namespace osgTSS
