#pragma once
#include "bake/table/TablePairs.h"

#include <cmath>

/// Gaps in long double, written apart from everything they judge.
namespace exact {

using Vector = Eigen::Matrix<long double, 3, 1>;

inline Vector turned(const Vector& x, const Vector& axis, long double angle) {
    // Rodrigues' formula.
    return x * std::cos(angle) + axis.cross(x) * std::sin(angle) + axis * axis.dot(x) * (1 - std::cos(angle));
}

inline Vector moved(const tss::Motion& motion, const std::vector<double>& q, const tss::Vec3& point) {
    Vector x = motion.base.linear().cast<long double>() * point.cast<long double>() +
               motion.base.translation().cast<long double>();
    for (std::size_t k = q.size(); k-- > 0;) {
        const tss::Dof& dof = motion.dofs[k];
        const Vector axis = dof.axis.cast<long double>(), origin = dof.origin.cast<long double>();
        if (dof.kind == tss::DofKind::Rotation)
            x = turned(x - origin, axis, q[k]) + origin;
        else if (dof.kind == tss::DofKind::Translation)
            x += axis * static_cast<long double>(q[k]);
        else // paths go through the same double code as the table's own
            x = tss::dofPose(dof, q[k]).matrix().topLeftCorner<3, 4>().cast<long double>() * x.homogeneous();
    }
    return x;
}

inline long double gap(const tss::Motion& motion, const tss::TablePair& pair, const std::vector<double>& q) {
    return (moved(motion, q, pair.b) - pair.a.cast<long double>()).norm() - pair.contactDistance;
}

/// The smallest over all pairs.
inline long double gap(const tss::Motion& motion, const std::vector<tss::TablePair>& pairs,
                       const std::vector<double>& q) {
    long double least = HUGE_VALL;
    for (const tss::TablePair& pair : pairs) least = std::min(least, gap(motion, pair, q));
    return least;
}

} // namespace exact
