#include "bake/report/Accuracy.h"

#include "bake/base/Parallel.h"
#include "bake/compare/Methods.h"
#include "bake/geometry/ConnectedParts.h"

#include <algorithm>
#include <cmath>

namespace tss::reporting {

namespace {

/// The largest depth of these points inside the solid, no less than `best`. toSolid: from the points' frame.
double deepestInside(const Solid& solid, const Eigen::AlignedBox3d& box, const std::vector<Vec3>& points,
                     const Pose& toSolid, double best) {
    for (const Vec3& point : points) {
        const Vec3 p = toSolid * point;
        if (!box.contains(p)) continue;
        const ClosestPoint near = solid.boundary().closest(p);
        if (near.distance > best && solid.inside(p)) best = near.distance;
    }
    return best;
}

/// A vertex of every connected component of the mesh.
std::vector<Vec3> oneOfEach(const TriangleMesh& mesh) {
    std::vector<Vec3> points;
    for (const TriangleMesh& part : connectedParts(mesh)) points.push_back(part.vertices.front());
    return points;
}

bool anyInside(const Solid& solid, const std::vector<Vec3>& points, const Pose& toSolid) {
    return std::ranges::any_of(points, [&](const Vec3& point) { return solid.inside(toSolid * point); });
}

std::vector<double> along(const ClosingMotion& motion, double share) {
    std::vector<double> q(motion.from.size());
    for (std::size_t k = 0; k < q.size(); ++k)
        q[k] = motion.from[k] + share * (motion.to[k] - motion.from[k]);
    return q;
}

/// First share in [0, 1] at which `touches` holds, seen in steps and bisected; 2 where it never does.
template <class Touches>
double firstTouch(int steps, const Touches& touches) {
    double before = 0;
    for (int k = 0; k <= steps; ++k) {
        const double share = static_cast<double>(k) / steps;
        if (!touches(share)) {
            before = share;
            continue;
        }
        if (k == 0) return 0;
        double free = before, hit = share;
        for (int round = 0; round < 30; ++round) {
            const double middle = 0.5 * (free + hit);
            (touches(middle) ? hit : free) = middle;
        }
        return hit;
    }
    return 2;
}

} // namespace

JudgedPoses::JudgedPoses(const compare::ComparedPair& problem, const compare::MeshTruth& truth,
                         const std::vector<std::vector<double>>& values)
    : problem_(problem), truth_(truth), solidA_(problem.meshA), solidB_(problem.meshB) {
    const std::vector<Vec3> partsA = oneOfEach(problem.meshA), partsB = oneOfEach(problem.meshB);
    enum : char { Free, Touching, Enclosed };
    const auto all = compare::poseQueries(problem.motion, values);
    std::vector<char> verdicts(all.size());
    parallelFor(all.size(), [&](std::size_t i) {
        const Pose& toA = all[i].pose;
        if (truth.touches(toA))
            verdicts[i] = Touching;
        else if (anyInside(solidA_, partsB, toA) || anyInside(solidB_, partsA, toA.inverse(Eigen::Isometry)))
            verdicts[i] = Enclosed;
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (verdicts[i] == Enclosed) {
            ++leftOut_;
            continue;
        }
        queries_.push_back(all[i]);
        touches_.push_back(verdicts[i] == Touching);
        touching_ += verdicts[i] == Touching ? 1 : 0;
    }
    known_.assign(queries_.size(), -1);
}

double JudgedPoses::clearance(std::size_t pose) const {
    if (known_[pose] < 0) known_[pose] = truth_.distance(queries_[pose].pose);
    return known_[pose];
}

std::size_t JudgedPoses::freeWithin(double distance) const {
    std::vector<char> within(queries_.size(), 0);
    parallelFor(queries_.size(), [&](std::size_t i) { within[i] = !touches(i) && clearance(i) < distance; });
    return static_cast<std::size_t>(std::ranges::count(within, char{1}));
}

double JudgedPoses::depth(std::size_t pose) const {
    if (known_[pose] < 0) {
        const Pose& toA = queries_[pose].pose;
        double depth = deepestInside(solidA_, bounds(problem_.meshA), problem_.meshB.vertices, toA, 0);
        depth = deepestInside(solidB_, bounds(problem_.meshB), problem_.meshA.vertices,
                              toA.inverse(Eigen::Isometry), depth);
        known_[pose] = depth;
    }
    return known_[pose];
}

ErrorFigures measureError(const compare::CollisionMethod& method, const JudgedPoses& poses, std::size_t count,
                          std::size_t most) {
    ErrorFigures figures;
    std::vector<std::size_t> missed, early;
    figures.poses = std::min(count, poses.queries().size());
    for (std::size_t i = 0; i < figures.poses; ++i) {
        const bool hit = method.hit(poses.queries()[i]);
        figures.touching += poses.touches(i) ? 1 : 0;
        if (poses.touches(i) && !hit) missed.push_back(i);
        if (!poses.touches(i) && hit) early.push_back(i);
    }
    figures.missed = missed.size();
    figures.early = early.size();
    std::vector<std::size_t> measured;
    const std::size_t stride = std::max<std::size_t>(1, (missed.size() + most - 1) / most);
    figures.sampled = stride > 1;
    for (std::size_t k = 0; k < missed.size(); k += stride) measured.push_back(missed[k]);
    parallelFor(measured.size(), [&](std::size_t k) { poses.depth(measured[k]); });
    parallelFor(early.size(), [&](std::size_t k) { poses.clearance(early[k]); });
    for (const std::size_t i : measured) {
        figures.deepestMiss = std::max(figures.deepestMiss, poses.depth(i));
        figures.meanMiss += poses.depth(i) / static_cast<double>(measured.size());
    }
    for (const std::size_t i : early) {
        figures.farthestEarly = std::max(figures.farthestEarly, poses.clearance(i));
        figures.meanEarly += poses.clearance(i) / static_cast<double>(early.size());
    }
    return figures;
}

std::vector<ClosingMotion> closingMotions(const compare::ComparedPair& problem,
                                          const compare::MeshTruth& truth, const JudgedPoses& poses,
                                          std::size_t count, int steps) {
    std::vector<ClosingMotion> motions;
    std::vector<const std::vector<double>*> free, touching;
    for (std::size_t i = 0; i < poses.queries().size(); ++i)
        (poses.touches(i) ? touching : free).push_back(&poses.queries()[i].q);
    for (std::size_t k = 0; k < std::min({count, free.size(), touching.size()}); ++k) {
        ClosingMotion motion{*free[k], *touching[k], 0};
        motion.contact = firstTouch(
            steps, [&](double share) { return truth.touches(pose(problem.motion, along(motion, share))); });
        motions.push_back(std::move(motion));
    }
    return motions;
}

FirstContact measureFirstContact(const compare::ComparedPair& problem, const compare::CollisionMethod& method,
                                 std::span<const ClosingMotion> motions, int steps) {
    FirstContact result;
    const std::size_t leading = compare::leadingDof(problem);
    for (const ClosingMotion& motion : motions) {
        const double contact = firstTouch(steps, [&](double share) {
            const std::vector<double> q = along(motion, share);
            return method.hit({q, pose(problem.motion, q)});
        });
        ++result.motions;
        if (contact > 1) {
            ++result.never;
            continue;
        }
        const double angle =
            std::abs((contact - motion.contact) * (motion.to[leading] - motion.from[leading]));
        const double length =
            compare::farthestMove(problem, along(motion, motion.contact), along(motion, contact));
        result.worstAngle = std::max(result.worstAngle, angle);
        result.meanAngle += angle;
        result.worstLength = std::max(result.worstLength, length);
        (contact <= motion.contact ? result.earliest : result.latest) =
            std::max(contact <= motion.contact ? result.earliest : result.latest, length);
    }
    if (result.motions > result.never) result.meanAngle /= static_cast<double>(result.motions - result.never);
    return result;
}

} // namespace tss::reporting
