#include "bake/base/Error.h"
#include "bake/motion/DofUnits.h"
#include "bake/motion/LimitConflict.h"
#include "bake/motion/MotionBound.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace tss {

namespace {

/// Moves q straight towards a pose within all limits and planes, until it meets the planes too.
void pullTowards(const Motion& motion, const std::vector<double>& inside, std::vector<double>& q) {
    double share = 0;
    for (const LimitPlane& plane : motion.planes) {
        const double over = excess(plane, q), within = std::min(0.0, excess(plane, inside));
        if (over > 0) share = std::max(share, over / (over - within));
    }
    if (!(share <= 1)) share = 1;
    for (std::size_t k = 0; k < q.size(); ++k) q[k] += share * (inside[k] - q[k]);
}

/// Radians, some 15,900 turns: the range in which the tables' sine is accurate (bake/table/SinVersin.h).
constexpr double farthestTurn = 1e5;

bool isRigid(const Pose& frame) {
    const Eigen::Matrix3d& turn = frame.linear();
    return frame.matrix().allFinite() && turn.determinant() > 0 &&
           (turn.transpose() * turn - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-9;
}

void checkPath(const Dof& dof) {
    if (dof.path.size() < 2) throw InputError("path of DOF '" + dof.name + "': expected at least 2 rows");
    for (std::size_t i = 0; i + 1 < dof.path.size(); ++i)
        if (const double from = dof.path[i].value, to = dof.path[i + 1].value;
            !(to - from > 1e-12 * (dof.path.back().value - dof.path.front().value) && from < to))
            throw InputError("path of DOF '" + dof.name +
                             "': expected values that rise from row to row, by more than rounding");
    for (const PathRow& row : dof.path)
        if (!row.translation.allFinite() || !row.rotation.coeffs().allFinite())
            throw InputError("path of DOF '" + dof.name + "': expected finite numbers");
    for (const PathRow& row : dof.path)
        if (std::abs(row.rotation.norm() - 1) > 1e-9)
            throw InputError("path of DOF '" + dof.name + "': expected quaternions of unit length");
    if (!isRigid(dof.frame)) throw InputError("path of DOF '" + dof.name + "': expected a rigid frame");
    if (dof.lower < dof.path.front().value || dof.upper > dof.path.back().value)
        throw InputError("path of DOF '" + dof.name + "': expected rows that cover the limits");
}

void checkDof(const Dof& dof) {
    if (!std::isfinite(dof.lower) || !std::isfinite(dof.upper))
        throw InputError("DOF '" + dof.name + "': expected finite limits; a table covers a bounded motion");
    if (dof.lower > dof.upper)
        throw InputError("DOF '" + dof.name + "': expected lower limit <= upper limit");
    if (!std::isfinite(dof.rest)) throw InputError("DOF '" + dof.name + "': expected a finite rest value");
    if (dof.kind == DofKind::Path) return checkPath(dof);
    if (!dof.axis.allFinite() || !(dof.axis.norm() > 0) || !dof.origin.allFinite())
        throw InputError("DOF '" + dof.name + "': expected a finite origin and an axis that is not zero");
    if (dof.kind == DofKind::Rotation && std::abs(dof.axis.norm() - 1) > 1e-9)
        throw InputError("DOF '" + dof.name + "': expected an axis of unit length");
    if (dof.kind == DofKind::Rotation && std::max(std::abs(dof.lower), std::abs(dof.upper)) > farthestTurn)
        throw InputError("DOF '" + dof.name + "': expected turns within " +
                         std::to_string(int(farthestTurn)) + " radians, found limits beyond");
}

/// "limit plane 2", "limit planes 1, 3": as they stand in the motion, counted from 1.
std::string named(const std::vector<std::size_t>& planes) {
    std::string s = planes.size() == 1 ? "limit plane" : "limit planes";
    for (std::size_t i = 0; i < planes.size(); ++i)
        s += (i == 0 ? " " : ", ") + std::to_string(planes[i] + 1);
    return s;
}

std::string names(const Motion& motion) {
    std::string s;
    for (const Dof& dof : motion.dofs) s += (s.empty() ? "'" : ", '") + dof.name + "'";
    return s;
}

/// Throws unless Q holds the rest pose: of an empty Q anything could be proven.
void checkNotEmpty(const Motion& motion) {
    const std::vector<double> rest = restValues(motion);
    for (const Dof& dof : motion.dofs) {
        const double slack =
            1e-9 * (dof.upper - dof.lower) + 1e-12 * std::max(std::abs(dof.lower), std::abs(dof.upper));
        if (!(dof.rest >= dof.lower - slack && dof.rest <= dof.upper + slack))
            throw InputError("DOF '" + dof.name +
                             "': expected a rest value within its limits, found one outside");
    }
    for (std::size_t p = 0; p < motion.planes.size(); ++p) {
        const LimitPlane& plane = motion.planes[p];
        double slack = 1e-12 * std::abs(plane.bound);
        for (std::size_t k = 0; k < rest.size(); ++k)
            slack += std::abs(plane.coefficients[k]) *
                     (1e-9 * (motion.dofs[k].upper - motion.dofs[k].lower) + 1e-12 * std::abs(rest[k]));
        if (excess(plane, rest) <= slack) continue;
        const std::vector<std::size_t> conflict =
            motion.dofCount() <= maxDofs ? conflictingPlanes(motion) : std::vector<std::size_t>();
        if (!conflict.empty())
            throw InputError(named(conflict) + " of the DOFs " + names(motion) +
                             ": expected planes that leave some pose within the limits, found none left");
        throw InputError(named({p}) + " of the DOFs " + names(motion) +
                         ": expected planes that the rest values meet, found the rest beyond it");
    }
}

} // namespace

bool withinLimits(const Motion& motion, std::span<const double> q, double slack) {
    for (std::size_t k = 0; k < motion.dofs.size(); ++k)
        if (!(q[k] >= motion.dofs[k].lower - slack && q[k] <= motion.dofs[k].upper + slack)) return false;
    return std::all_of(motion.planes.begin(), motion.planes.end(), [&](const LimitPlane& plane) {
        double most = 0;
        for (const double c : plane.coefficients) most = std::max(most, std::abs(c));
        return excess(plane, q) <= slack * most;
    });
}

bool beyondLimits(const Motion& motion, std::span<const double> q) {
    const auto roundingOf = [](const Dof& dof) { return limitRounding(dof, fileRounding); };
    if (q.size() != motion.dofs.size()) return true;
    if (!std::ranges::all_of(q, [](double value) { return std::isfinite(value); })) return true;
    for (std::size_t k = 0; k < q.size(); ++k) {
        const Dof& dof = motion.dofs[k];
        const double rounding = roundingOf(dof);
        if (!(q[k] >= dof.lower - rounding && q[k] <= dof.upper + rounding)) return true;
    }
    return std::any_of(motion.planes.begin(), motion.planes.end(), [&](const LimitPlane& plane) {
        double rounding = 1e-12 * std::abs(plane.bound);
        for (std::size_t k = 0; k < q.size(); ++k)
            rounding += std::abs(plane.coefficients[k]) * roundingOf(motion.dofs[k]);
        return !(excess(plane, q) <= rounding);
    });
}

std::vector<double> clampToLimits(const Motion& motion, std::span<const double> asked) {
    expectValues(motion, asked);
    std::vector<double> q(asked.begin(), asked.end());
    const auto clampBox = [&] {
        for (std::size_t k = 0; k < q.size(); ++k)
            q[k] = std::clamp(q[k], motion.dofs[k].lower, motion.dofs[k].upper);
    };
    clampBox();
    double range = 0;
    for (const Dof& dof : motion.dofs) range = std::max(range, dof.upper - dof.lower);
    std::vector<LimitPlane> planes;
    for (const LimitPlane& plane : motion.planes) planes.push_back(rescaled(plane));
    // Cyclic projection converges slowly where planes meet at a sharp angle; a round takes some nanoseconds.
    for (int round = 0; round < 10000; ++round) {
        if (withinLimits(motion, q, 1e-13 * range)) return q;
        for (const LimitPlane& plane : planes) {
            const double over = excess(plane, q);
            if (over <= 0) continue;
            double squared = 0;
            for (double c : plane.coefficients) squared += c * c;
            for (std::size_t k = 0; k < q.size(); ++k) q[k] -= over / squared * plane.coefficients[k];
        }
        clampBox();
    }
    std::vector<double> rest = restValues(motion);
    for (std::size_t k = 0; k < q.size(); ++k)
        rest[k] = std::clamp(rest[k], motion.dofs[k].lower, motion.dofs[k].upper);
    pullTowards(motion, rest, q);
    return q;
}

void checkMotion(const Motion& motion) {
    for (const Dof& dof : motion.dofs) checkDof(dof);
    if (!isRigid(motion.base)) throw InputError("motion: expected a base that is rigid");
    for (const LimitPlane& plane : motion.planes) {
        const bool finite = std::all_of(plane.coefficients.begin(), plane.coefficients.end(),
                                        [](double c) { return std::isfinite(c); });
        const bool zero = std::all_of(plane.coefficients.begin(), plane.coefficients.end(),
                                      [](double c) { return c == 0; });
        if (plane.coefficients.size() != motion.dofCount() || !finite || zero || !std::isfinite(plane.bound))
            throw InputError(
                "limit plane: expected one finite coefficient a DOF, not all 0, and a finite bound");
    }
    checkNotEmpty(motion);
}

std::vector<std::vector<double>> randomPoses(const Motion& motion, std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<std::vector<double>> poses;
    poses.reserve(count);
    // Planes that leave less than a thousandth of the box would make this loop long: then take what came.
    for (std::size_t tries = 0; poses.size() < count && tries < 1000 * count; ++tries) {
        std::vector<double> q;
        for (const Dof& dof : motion.dofs)
            q.push_back(std::uniform_real_distribution<double>(dof.lower, dof.upper)(random));
        if (motion.planes.empty() || withinLimits(motion, q)) poses.push_back(std::move(q));
    }
    return poses;
}

} // namespace tss
