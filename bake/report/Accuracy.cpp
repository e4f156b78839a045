#include "bake/report/Accuracy.h"

#include "bake/compare/Methods.h"

#include <algorithm>
#include <cmath>

namespace tss::reporting {

namespace {

/// Depth of the deepest of these points inside the solid. Points are in the solid's frame.
double deepest(const Solid& solid, const Eigen::AlignedBox3d& box, const std::vector<Vec3>& points,
               const Pose& toSolid, double best) {
    for (const Vec3& point : points) {
        const Vec3 p = toSolid * point;
        if (!box.contains(p)) continue;
        const ClosestPoint near = solid.boundary().closest(p);
        if (near.distance > best && solid.inside(p)) best = near.distance;
    }
    return best;
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

double farthestMove(const compare::Problem& problem, const std::vector<double>& p,
                    const std::vector<double>& q) {
    const Pose from = pose(problem.motion, p), to = pose(problem.motion, q);
    double most = 0;
    const Eigen::AlignedBox3d box = bounds(problem.meshB);
    for (int c = 0; c < 8; ++c) {
        const Vec3 corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c));
        most = std::max(most, (from * corner - to * corner).norm());
    }
    return most;
}

} // namespace

JudgedPoses::JudgedPoses(const compare::Problem& problem, const compare::MeshTruth& truth,
                         const std::vector<std::vector<double>>& values)
    : problem_(problem), truth_(truth), solidA_(problem.meshA), solidB_(problem.meshB),
      queries_(compare::poseQueries(problem.motion, values)), known_(values.size(), -1) {
    for (const compare::PoseQuery& query : queries_) {
        touches_.push_back(truth.touches(query.pose) ? 1 : 0);
        touching_ += static_cast<std::size_t>(touches_.back());
    }
}

double JudgedPoses::clearance(std::size_t pose) const {
    if (known_[pose] < 0) known_[pose] = truth_.distance(queries_[pose].pose);
    return known_[pose];
}

double JudgedPoses::depth(std::size_t pose) const {
    if (known_[pose] < 0) {
        const Pose& toA = queries_[pose].pose;
        double depth = deepest(solidA_, bounds(problem_.meshA), problem_.meshB.vertices, toA, 0);
        depth = deepest(solidB_, bounds(problem_.meshB), problem_.meshA.vertices,
                        toA.inverse(Eigen::Isometry), depth);
        known_[pose] = depth;
    }
    return known_[pose];
}

ErrorFigures measureError(const compare::Rival& rival, const JudgedPoses& poses, std::size_t most) {
    ErrorFigures figures;
    std::vector<std::size_t> missed, early;
    for (std::size_t i = 0; i < poses.queries().size(); ++i) {
        const bool hit = rival.hit(poses.queries()[i]);
        if (poses.touches(i) && !hit) missed.push_back(i);
        if (!poses.touches(i) && hit) early.push_back(i);
    }
    figures.poses = poses.queries().size();
    figures.touching = poses.touching();
    figures.missed = missed.size();
    figures.early = early.size();
    const auto measure = [&](const std::vector<std::size_t>& wrong, bool isMiss, double& worst,
                             double& mean) {
        const std::size_t stride = std::max<std::size_t>(1, (wrong.size() + most - 1) / most);
        figures.sampled = figures.sampled || stride > 1;
        std::size_t count = 0;
        for (std::size_t k = 0; k < wrong.size(); k += stride, ++count) {
            const double length = isMiss ? poses.depth(wrong[k]) : poses.clearance(wrong[k]);
            worst = std::max(worst, length);
            mean += length;
        }
        if (count > 0) mean /= static_cast<double>(count);
    };
    measure(missed, true, figures.deepestMiss, figures.meanMiss);
    measure(early, false, figures.farthestEarly, figures.meanEarly);
    return figures;
}

std::vector<ClosingMotion> closingMotions(const compare::Problem& problem, const compare::MeshTruth& truth,
                                          std::size_t count, int steps, std::uint64_t seed) {
    std::vector<ClosingMotion> motions;
    std::vector<std::vector<double>> free, touching;
    for (const auto& q : compare::randomPoses(problem.motion, 40 * count + 200, seed)) {
        (truth.touches(pose(problem.motion, q)) ? touching : free).push_back(q);
        if (free.size() > motions.size() && touching.size() > motions.size()) {
            ClosingMotion motion{free[motions.size()], touching[motions.size()], 0};
            motion.contact = firstTouch(steps, [&](double share) {
                return truth.touches(pose(problem.motion, along(motion, share)));
            });
            motions.push_back(std::move(motion));
            if (motions.size() == count) break;
        }
    }
    return motions;
}

FirstContact measureFirstContact(const compare::Problem& problem, const compare::Rival& rival,
                                 const std::vector<ClosingMotion>& motions, int steps) {
    FirstContact result;
    const std::size_t leading = compare::leadingDof(problem);
    for (const ClosingMotion& motion : motions) {
        const double contact = firstTouch(steps, [&](double share) {
            const std::vector<double> q = along(motion, share);
            return rival.hit({q, pose(problem.motion, q)});
        });
        ++result.motions;
        if (contact > 1) {
            ++result.never;
            continue;
        }
        const double angle =
            std::abs((contact - motion.contact) * (motion.to[leading] - motion.from[leading]));
        const double length = farthestMove(problem, along(motion, motion.contact), along(motion, contact));
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
