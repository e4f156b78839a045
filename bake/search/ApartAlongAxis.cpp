#include "bake/search/SurfacesApart.h"

#include "bake/motion/MotionBound.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss {

namespace {

/// The extent of points along a direction.
struct Interval {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -std::numeric_limits<double>::infinity();

    void add(double x) {
        lower = std::min(lower, x);
        upper = std::max(upper, x);
    }
};

/// Widens B's interval along n by how far one DOF may move it that way. reach: the largest distance of B's
/// points from the origin, updated to that after the DOF. False: there is no bound for this kind of DOF.
bool widenBy(const Dof& dof, const Vec3& n, Interval& along, double& reach) {
    constexpr double axisRounding = 1e-8; // axes are unit vectors to less than this
    if (dof.kind == DofKind::Translation) {
        const double slope = n.dot(dof.axis);
        along.lower += std::min(slope * dof.lower, slope * dof.upper);
        along.upper += std::max(slope * dof.lower, slope * dof.upper);
        reach += std::max(std::abs(dof.lower), std::abs(dof.upper)) * dof.axis.norm();
        return true;
    }
    if (dof.kind != DofKind::Rotation) return false;
    // A turn changes the coordinate along n by at most 2 |n x axis| times the distance from the axis.
    const double arm = reach + dof.origin.norm(), drift = 2 * (n.cross(dof.axis).norm() + axisRounding) * arm;
    along.lower -= drift;
    along.upper += drift;
    reach = arm + dof.origin.norm();
    return true;
}

double apartAlong(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion, const Vec3& n) {
    Interval ofA, ofB;
    double reachA = 0, reachB = 0, reach = 0;
    for (const Vec3& v : a.vertices) {
        ofA.add(n.dot(v));
        reachA = std::max(reachA, v.norm());
    }
    for (const Vec3& v : b.vertices) {
        const Vec3 x = motion.base * v;
        ofB.add(n.dot(x));
        reach = std::max(reach, x.norm());
        reachB = std::max(reachB, v.norm());
    }
    for (std::size_t k = motion.dofCount(); k-- > 0;)
        if (!widenBy(motion.dofs[k], n, ofB, reach)) return 0;
    return std::max(ofA.lower - ofB.upper, ofB.lower - ofA.upper) -
           coordinateRounding(motion, reachA, reachB);
}

} // namespace

double apartAlongAxis(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion) {
    double most = 0;
    if (a.vertices.empty() || b.vertices.empty()) return most;
    for (const Dof& dof : motion.dofs)
        if (dof.kind == DofKind::Rotation)
            most = std::max(most, apartAlong(a, b, motion, dof.axis.normalized()));
    return most;
}

} // namespace tss
