#pragma once
#include "bake/motion/Motion.h"

#include <array>
#include <string>
#include <vector>

namespace osgTSS {

/// The coordinate axis that a DOF is about or along, whatever its length and sign.
int axisOf(const tss::Dof& dof);

/// DOFs along and about coordinate axes, slides before turns: poses by their values, and back.
class AxisDofs {
public:
    /// Three turns at most, about different axes.
    explicit AxisDofs(std::vector<tss::Dof> dofs);

    const std::vector<tss::Dof>& dofs() const { return _dofs; }
    tss::Pose poseAt(const std::vector<double>& values) const;
    /// The values at a pose, less what of it no DOF can do. Three turns make a rotation in two ways: the one
    /// that the limits allow, or nearly, is taken.
    std::vector<double> valuesOf(const tss::Pose& pose) const;

private:
    std::vector<double> valuesBy(const std::array<double, 3>& turns, const tss::Vec3& slides) const;
    double beyond(const std::vector<double>& values, const std::array<double, 3>& turns) const;

    std::vector<tss::Dof> _dofs;
    std::array<int, 3> _order{}; ///< of the turns; axes that none is about come last
    std::size_t _turns = 0;
};

/// Words such as "rotZ:-24:18": a turn in degrees, or a slide in units of length, with its limits. `tag` is
/// named in errors: throws tss::InputError for another word, and for reversed limits.
std::vector<tss::Dof> parseDofWords(const std::string& words, const std::string& tag);

} // namespace osgTSS
