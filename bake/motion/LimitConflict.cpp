#include "bake/motion/LimitConflict.h"

#include "bake/base/Order.h"
#include "bake/motion/JointQp.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// Limits and planes as inequalities on the offset from a value within the limits, each DOF's offset in units
/// of its range.
class ScaledLimits {
public:
    explicit ScaledLimits(const Motion& motion) : motion_(motion) {
        for (const Dof& dof : motion.dofs) {
            centre_.push_back(std::clamp(dof.rest, dof.lower, dof.upper));
            range_.push_back(dof.upper - dof.lower);
        }
    }

    /// Whether some value within the limits satisfies these planes.
    bool feasible(const std::vector<std::size_t>& planes) const {
        constexpr double tolerance = 1e-9;
        const std::size_t n = range_.size();
        QpRows rows(2 * n + planes.size());
        rows.clear(static_cast<int>(n));
        for (std::size_t k = 0; k < n; ++k) addBox(rows, k);
        for (const std::size_t p : planes)
            if (!addPlane(rows, motion_.planes[p], tolerance)) return false;
        DofValues y{};
        return nearestToOrigin(rows, tolerance, y);
    }

private:
    void addBox(QpRows& rows, std::size_t k) const {
        const Dof& dof = motion_.dofs[k];
        const double unit = range_[k] > 0 ? range_[k] : 1;
        for (const double side : {1.0, -1.0}) {
            double* row = rows.add();
            std::fill_n(row, range_.size(), 0.0);
            row[k] = side;
            row[range_.size()] = side * ((side > 0 ? dof.lower : dof.upper) - centre_[k]) / unit;
        }
    }

    /// Returns false for a plane that is violated and has coefficients on fixed DOFs alone.
    bool addPlane(QpRows& rows, const LimitPlane& plane, double tolerance) const {
        const std::size_t n = range_.size();
        const double over = excess(plane, centre_);
        double squared = 0, size = std::abs(plane.bound);
        for (std::size_t k = 0; k < n; ++k) {
            const double c = plane.coefficients[k];
            squared += c * range_[k] * c * range_[k];
            size += std::abs(c * centre_[k]);
        }
        const double rounding = 1e-12 * size, length = std::sqrt(squared);
        if (!(length > 0)) return over <= tolerance * size;
        double* row = rows.add();
        for (std::size_t k = 0; k < n; ++k) row[k] = -plane.coefficients[k] * range_[k] / length;
        row[n] = (over - rounding) / length;
        return true;
    }

    const Motion& motion_;
    std::vector<double> centre_, range_;
};

} // namespace

std::vector<std::size_t> conflictingPlanes(const Motion& motion) {
    const ScaledLimits limits(motion);
    std::vector<std::size_t> planes = indicesOf<std::size_t>(motion.planes.size());
    if (planes.empty() || limits.feasible(planes)) return {};
    // Deletion filter: a plane without which the others still conflict is not part of the subset.
    for (std::size_t i = planes.size(); i-- > 0;) {
        std::vector<std::size_t> others = planes;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        if (!limits.feasible(others)) planes = std::move(others);
    }
    return planes;
}

LimitPlane rescaled(LimitPlane plane) {
    double largest = 0;
    for (const double c : plane.coefficients) largest = std::max(largest, std::abs(c));
    if (!(largest > 0)) return plane;
    const int power = -std::ilogb(largest);
    for (double& c : plane.coefficients) c = std::ldexp(c, power);
    plane.bound = std::ldexp(plane.bound, power);
    return plane;
}

} // namespace tss
