#include "bake/motion/Motion.h"

#include "bake/base/Error.h"

#include <algorithm>

namespace tss {

namespace {

/// The path's pose at a value: linear in translation, slerp in rotation between the rows about it.
Pose pathPose(const std::vector<PathRow>& rows, double value) {
    const auto next = std::upper_bound(rows.begin() + 1, rows.end() - 1, value,
                                       [](double v, const PathRow& row) { return v < row.value; });
    const PathRow &r0 = *(next - 1), &r1 = *next;
    const double t = std::clamp((value - r0.value) / (r1.value - r0.value), 0.0, 1.0);
    Pose p = Pose::Identity();
    p.linear() = r0.rotation.slerp(t, r1.rotation).toRotationMatrix();
    p.translation() = r0.translation + t * (r1.translation - r0.translation);
    return p;
}

} // namespace

Pose dofPose(const Dof& dof, double q) {
    Pose p = Pose::Identity();
    switch (dof.kind) {
    case DofKind::Rotation:
        p.linear() = Eigen::AngleAxisd(q, dof.axis).toRotationMatrix();
        p.translation() = dof.origin - p.linear() * dof.origin;
        break;
    case DofKind::Translation:
        p.translation() = q * dof.axis;
        break;
    case DofKind::Path:
        p = dof.frame * pathPose(dof.path, q) * dof.frame.inverse(Eigen::Isometry);
        break;
    }
    return p;
}

void expectValues(const Motion& motion, std::span<const double> q) {
    if (q.size() != motion.dofs.size())
        throw InputError("expected " + std::to_string(motion.dofs.size()) + " values, one a DOF, found " +
                         std::to_string(q.size()));
}

Pose pose(const Motion& motion, std::span<const double> q) {
    expectValues(motion, q);
    Pose p = Pose::Identity();
    for (std::size_t k = 0; k < motion.dofs.size(); ++k) p = p * dofPose(motion.dofs[k], q[k]);
    return p * motion.base;
}

std::vector<double> restValues(const Motion& motion) {
    std::vector<double> q;
    for (const Dof& dof : motion.dofs) q.push_back(dof.rest);
    return q;
}

} // namespace tss
