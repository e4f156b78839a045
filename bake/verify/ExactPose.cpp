#include "bake/verify/ExactPose.h"

#include "bake/verify/MeshProof.h"
#include "bake/verify/PoseBox.h"

#include <algorithm>
#include <cmath>

namespace tss::verify {

namespace {

Matrix cross(const Vector& v) {
    Matrix m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

} // namespace

ExactPose exactPose(const Motion& motion, const std::vector<Real>& q) {
    ExactPose pose;
    for (std::size_t k = 0; k < motion.dofs.size(); ++k) {
        const Dof& dof = motion.dofs[k];
        ExactPose step;
        if (dof.kind == DofKind::Path) {
            const Pose at = dofPose(dof, static_cast<double>(q[k]));
            step = {at.linear().cast<Real>(), at.translation().cast<Real>()};
        } else if (dof.kind == DofKind::Translation) {
            step.shift = q[k] * dof.axis.cast<Real>();
        } else {
            const Matrix spin = cross(dof.axis.cast<Real>());
            const Real half = std::sin(q[k] / 2);
            step.turn += std::sin(q[k]) * spin + 2 * half * half * spin * spin;
            const Vector origin = dof.origin.cast<Real>();
            step.shift = origin - step.turn * origin;
        }
        pose = pose.times(step);
    }
    return pose.times({motion.base.linear().cast<Real>(), motion.base.translation().cast<Real>()});
}

double poseRounding(const Motion& motion, double size, double u) {
    double off = 0;
    for (const Dof& dof : motion.dofs) {
        if (dof.kind == DofKind::Rotation) off += 4 * std::abs(dof.axis.norm() - 1);
        for (const PathRow& row : dof.path) off += std::abs(row.rotation.norm() - 1);
    }
    return (64 * double(motion.dofCount() + 2) * u + off) * size;
}

double turnRounding(const Motion& motion, double size, double u) {
    double turned = 0;
    for (const Dof& dof : motion.dofs)
        if (dof.kind == DofKind::Rotation) turned += 0.5 * (dof.upper - dof.lower);
    return 2 * u * turned * size;
}

std::vector<Exact> exactTests(const Table& table) {
    std::vector<Exact> all;
    for (const MeshTest& t : meshTests(table)) all.push_back({t.centreA, t.centreB, t.contactDistance});
    return all;
}

double pathSize(const Motion& motion, const std::vector<Exact>& tests) {
    double a = 0, b = 0;
    for (const Exact& t : tests) {
        a = std::max(a, t.a.norm());
        b = std::max(b, t.b.norm());
    }
    return a + coordinateBound(motion, b);
}

} // namespace tss::verify
