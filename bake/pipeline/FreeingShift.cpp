#include "bake/pipeline/FreeingShift.h"

#include "bake/base/Parallel.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/search/ExploredPoses.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// Of the smaller body's diagonal: what counts as apart, the first shift that is tried, and the last.
constexpr double marginShare = 1e-3, firstShare = 1e-3, lastShare = 0.1;
constexpr double growth = 1.3; ///< from one length to the next

/// To the faces, edges and corners of a cube.
std::vector<Vec3> directions() {
    std::vector<Vec3> all;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x || y || z) all.push_back(Vec3(x, y, z).normalized());
    return all;
}

class Trial {
public:
    Trial(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion)
        : a_(a), b_(b), size_(std::min(bounds(a).diagonal().norm(), bounds(b).diagonal().norm())) {
        const std::vector<double> rest = restValues(motion);
        poses_.push_back(pose(motion, rest));
        // Each DOF by itself through its limits, and some anywhere.
        for (std::size_t k = 0; k < rest.size(); ++k)
            for (int step = 0; step <= steps; ++step) {
                std::vector<double> q = rest;
                q[k] = motion.dofs[k].lower + (motion.dofs[k].upper - motion.dofs[k].lower) * step / steps;
                if (withinLimits(motion, q, 0)) poses_.push_back(pose(motion, q));
            }
        if (rest.size() > 1)
            for (const std::vector<double>& q : exploredPoses(motion, 20, 1))
                poses_.push_back(pose(motion, q));
    }

    double size() const { return size_; }
    std::size_t poseCount() const { return poses_.size(); }
    bool overlapsAtRest() const { return a_.distanceTo(b_, poses_.front(), 1e-6 * size_) < 1e-6 * size_; }

    std::size_t freePoses(const Vec3& shift) const {
        std::vector<char> free(poses_.size());
        parallelFor(poses_.size(),
                    [&](std::size_t k) { free[k] = a_.apart(b_, shifted(k, shift), marginShare * size_); });
        return static_cast<std::size_t>(std::count(free.begin(), free.end(), char{1}));
    }

    FreeingShift measured(const Vec3& shift) const {
        std::vector<double> distances(poses_.size());
        parallelFor(poses_.size(),
                    [&](std::size_t k) { distances[k] = a_.distanceTo(b_, shifted(k, shift), size_); });
        FreeingShift found;
        found.shift = shift;
        found.poses = poses_.size();
        found.atRest = std::min(distances.front(), size_);
        found.freeAtRest = distances.front() > marginShare * size_;
        found.least = size_;
        for (const double distance : distances)
            if (distance > marginShare * size_) {
                ++found.free;
                found.least = std::min(found.least, distance);
            }
        return found;
    }

private:
    static constexpr int steps = 16;

    Pose shifted(std::size_t k, const Vec3& shift) const {
        return Pose(poses_[k] * Eigen::Translation3d(shift));
    }

    MeshQuery a_, b_;
    double size_;
    std::vector<Pose> poses_;
};

/// The same direction as short as it may be, to a tenth of what lies between.
Vec3 shortened(const Trial& trial, const Vec3& direction, double tooShort, double enough, std::size_t free) {
    for (int round = 0; round < 4; ++round) {
        const double middle = (tooShort + enough) / 2;
        (trial.freePoses(middle * direction) >= free ? enough : tooShort) = middle;
    }
    return enough * direction;
}

} // namespace

std::vector<FreeingShift> freeingShifts(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion) {
    std::vector<FreeingShift> found;
    const Trial trial(a, b, motion);
    if (!trial.overlapsAtRest()) return found;
    std::size_t most = trial.freePoses(Vec3::Zero());
    double before = 0;
    for (double length = firstShare * trial.size();
         length <= lastShare * trial.size() && most < trial.poseCount(); length *= growth) {
        Vec3 best = Vec3::Zero();
        std::size_t reached = most;
        for (const Vec3& direction : directions()) {
            const std::size_t free = trial.freePoses(length * direction);
            if (free > reached) reached = free, best = direction;
        }
        if (reached > most) {
            found.push_back(trial.measured(shortened(trial, best, before, length, reached)));
            most = reached;
        }
        before = length;
    }
    return found;
}

} // namespace tss
