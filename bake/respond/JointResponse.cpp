#include "bake/respond/JointResponse.h"

#include "bake/table/Query.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// Values on the straight way from `from` to `to`, t in [0,1].
std::vector<double> along(std::span<const double> from, std::span<const double> to, double t) {
    std::vector<double> q(from.size());
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = t == 1 ? to[k] : from[k] + t * (to[k] - from[k]);
    return q;
}

/// An upper bound of the length of the way that any sphere centre of B takes between two poses on a straight
/// line of DOF values: each DOF moves a point at most its reach times its change, where the reach grows from
/// the last DOF inwards by what the DOFs between may move it.
double travelBound(const Table& table, std::span<const double> from, std::span<const double> to) {
    const Motion& motion = table.motion;
    double travel = 0;
    // Around the origin of DOF k, in the frame after D1..Dk-1: |x - origin| of all centres, whatever the DOFs
    // > k do. Found by walking outwards: reach about a point p of the set {T0 c}, then enlarged by each inner
    // DOF's span.
    for (std::size_t k = 0; k < motion.dofs.size(); ++k) {
        const Dof& dof = motion.dofs[k];
        const double change = std::abs(to[k] - from[k]);
        if (change == 0) continue;
        if (dof.kind == DofKind::Translation) {
            travel += change * dof.axis.norm();
            continue;
        }
        double reach = 0;
        for (const Sphere& b : table.b) reach = std::max(reach, (motion.base * b.centre - dof.origin).norm());
        for (std::size_t l = k + 1; l < motion.dofs.size(); ++l) {
            const Dof& inner = motion.dofs[l];
            const double span = std::max(std::abs(inner.lower), std::abs(inner.upper));
            if (inner.kind == DofKind::Translation) reach += span * inner.axis.norm();
            if (inner.kind == DofKind::Rotation) reach += 2 * (inner.origin - dof.origin).norm();
            if (inner.kind == DofKind::Path)
                for (const PathRow& row : inner.path) reach = std::max(reach, reach + row.translation.norm());
        }
        if (dof.kind == DofKind::Rotation) {
            travel += change * reach;
        } else {
            // The steepest segment of the path: its slide and its turn about the path's frame.
            double rate = 0;
            for (std::size_t i = 0; i + 1 < dof.path.size(); ++i) {
                const PathRow &r0 = dof.path[i], &r1 = dof.path[i + 1];
                const double turn = r0.rotation.angularDistance(r1.rotation);
                const double slide = (r1.translation - r0.translation).norm();
                rate = std::max(rate, (slide + turn * (reach + dof.frame.translation().norm())) /
                                          (r1.value - r0.value));
            }
            travel += change * rate;
        }
    }
    return travel;
}

} // namespace

const char* name(JointStatus status) {
    switch (status) {
    case JointStatus::Free:
        return "free";
    case JointStatus::Blocked:
        return "blocked";
    case JointStatus::Slid:
        return "slid";
    case JointStatus::Separated:
        return "separated";
    case JointStatus::Stuck:
        return "stuck";
    }
    return "?";
}

JointResult respond(const Table& table, const JointRequest& request) {
    const std::vector<double> asked = clampToLimits(table.motion, request.asked);
    JointResult result;
    result.q.assign(request.last.begin(), request.last.end());
    const QueryResult start = query(table, request.last);
    result.gap = start.gap;
    result.test = start.test;
    if (start.hit()) {
        // In collision already: only what makes it less deep is allowed.
        const QueryResult end = query(table, asked);
        result.status = end.gap > start.gap ? JointStatus::Separated : JointStatus::Stuck;
        if (result.status == JointStatus::Separated) {
            result.q = asked;
            result.gap = end.gap;
            result.test = end.test;
        }
        return result;
    }
    // Conservative advancement: a gap g cannot close before the way is longer than g.
    const double travel = travelBound(table, request.last, asked);
    double t = 0;
    for (int round = 0; round < 200; ++round) {
        if (travel * (1 - t) < result.gap) {
            t = 1;
        } else {
            const double step = result.gap / travel * (1 - 1e-7);
            if (step < 1e-9) break;
            t = std::min(1.0, t + step);
        }
        const std::vector<double> q = along(request.last, asked, t);
        const QueryResult there = query(table, q);
        if (there.hit()) break;
        result.q = q;
        result.gap = there.gap;
        result.test = there.test;
        if (t == 1) return result;
    }
    result.status = JointStatus::Blocked;
    return result;
}

} // namespace tss
