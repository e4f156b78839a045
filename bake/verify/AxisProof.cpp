#include "bake/verify/MeshProof.h"

#include "bake/verify/ExactPose.h"
#include "bake/verify/PoseBox.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace tss::verify {

namespace {

double reachOf(const TriangleMesh& mesh, const Pose& pose) {
    double most = 0;
    for (const Vec3& v : mesh.vertices) most = std::max(most, (pose * v).norm());
    return most;
}

/// How far B's points may leave their place against n and along it.
struct Stray {
    Real down = 0, up = 0;
};

/// reach: of B's points from A's origin before the DOFs move them. Nothing: not known.
std::optional<Stray> strays(const Motion& motion, const Vector& n, Real reach) {
    Stray stray;
    for (std::size_t k = motion.dofCount(); k-- > 0;) {
        const Dof& dof = motion.dofs[k];
        const Vector axis = dof.axis.cast<Real>();
        if (dof.kind == DofKind::Translation) {
            const Real slope = n.dot(axis);
            reach += std::max(std::abs(Real(dof.lower)), std::abs(Real(dof.upper))) * axis.norm();
            stray.down += std::max(-slope * dof.lower, -slope * dof.upper);
            stray.up += std::max(slope * dof.lower, slope * dof.upper);
        } else if (dof.kind == DofKind::Rotation) {
            // The turn takes n along a circle about its axis, by no more than across it.
            const Real origin = dof.origin.cast<Real>().norm();
            const Real chords = 2 * (n.cross(axis).norm() / axis.norm() + Real(1e-8)) * (reach + origin);
            reach += 2 * origin;
            stray.down += chords;
            stray.up += chords;
        } else {
            return std::nullopt;
        }
    }
    return stray;
}

/// The least of a body's points along n.
Real least(const TriangleMesh& mesh, const Pose& pose, const Vector& n) {
    Real least = std::numeric_limits<Real>::infinity();
    for (const Vec3& v : mesh.vertices) least = std::min(least, n.dot((pose * v).cast<Real>()));
    return least;
}

bool apartAcross(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion, const Vector& n,
                 Real clearance) {
    const Pose still = Pose::Identity();
    const double size = reachOf(a, still) + coordinateBound(motion, reachOf(b, still));
    const std::optional<Stray> stray = strays(motion, n, Real(reachOf(b, motion.base)));
    if (!stray) return false;
    const Real above = least(b, motion.base, n) + least(a, still, -n) - stray->down;
    const Real below = least(a, still, n) + least(b, motion.base, -n) - stray->up;
    return std::max(above, below) - Real(poseRounding(motion, size, 0x1p-52)) > clearance;
}

} // namespace

bool apartAcrossAxis(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion, double clearance) {
    if (a.vertices.empty() || b.vertices.empty()) return false;
    return std::ranges::any_of(motion.dofs, [&](const Dof& dof) {
        return dof.kind == DofKind::Rotation &&
               apartAcross(a, b, motion, dof.axis.cast<Real>().normalized(), clearance);
    });
}

} // namespace tss::verify
