#include "bake/search/SampledSearch.h"

#include <cmath>
#include <limits>
#include <random>

namespace tss {

namespace {

using Values = std::vector<double>;

void keepInside(const Motion& motion, Values q, std::vector<Values>& out) {
    if (withinLimits(motion, q, 0)) out.push_back(std::move(q));
}

/// The poses of a grid of as many values of each DOF that moves.
void addGrid(const Motion& motion, std::size_t side, std::vector<Values>& out) {
    const std::size_t dofs = motion.dofCount();
    std::vector<std::size_t> index(dofs, 0);
    Values q(dofs);
    for (;;) {
        for (std::size_t k = 0; k < dofs; ++k) {
            const Dof& dof = motion.dofs[k];
            const double t = side > 1 ? double(index[k]) / double(side - 1) : 0;
            q[k] = index[k] + 1 == side ? dof.upper : dof.lower + t * (dof.upper - dof.lower);
        }
        keepInside(motion, q, out);
        std::size_t k = 0;
        for (; k < dofs; ++k) {
            const std::size_t count = motion.dofs[k].upper > motion.dofs[k].lower ? side : 1;
            if (++index[k] < count) break;
            index[k] = 0;
        }
        if (k == dofs) return;
    }
}

/// Poses with each DOF at one of its limits.
void addCorners(const Motion& motion, std::size_t count, std::mt19937_64 random, std::vector<Values>& out) {
    Values q(motion.dofCount());
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < q.size(); ++k)
            q[k] = random() >> 63 ? motion.dofs[k].upper : motion.dofs[k].lower;
        keepInside(motion, q, out);
    }
}

/// About so many on a grid that includes the limits, or, where its corners alone are more than twice as many,
/// at some of these.
void addSpread(const Motion& motion, std::size_t samples, std::uint64_t seed, std::vector<Values>& out) {
    std::size_t moving = 0;
    for (const Dof& dof : motion.dofs) moving += dof.upper > dof.lower;
    if (moving == 0) return addGrid(motion, 1, out);
    // The root can round down just below a whole number.
    const double side = std::pow(double(samples), 1.0 / double(moving)) + 1e-9;
    if (std::pow(2, double(moving)) > 2 * double(samples))
        addCorners(motion, samples, std::mt19937_64(seed + 1), out);
    else
        addGrid(motion, std::max<std::size_t>(2, static_cast<std::size_t>(side)), out);
}

/// From the lower to the upper limit that the line start + t * direction meets.
void addLine(const Motion& motion, const Values& start, const Values& direction, std::size_t count,
             std::vector<Values>& out) {
    double from = -std::numeric_limits<double>::infinity(), to = -from;
    for (std::size_t k = 0; k < start.size(); ++k) {
        if (direction[k] == 0) continue;
        const double t0 = (motion.dofs[k].lower - start[k]) / direction[k];
        const double t1 = (motion.dofs[k].upper - start[k]) / direction[k];
        from = std::max(from, std::min(t0, t1));
        to = std::min(to, std::max(t0, t1));
    }
    if (!std::isfinite(from) || !std::isfinite(to)) return;
    Values q(start.size());
    for (std::size_t i = 0; i < count; ++i) {
        const double t = from + (to - from) * double(i) / double(count - 1);
        for (std::size_t k = 0; k < q.size(); ++k)
            q[k] = std::clamp(start[k] + t * direction[k], motion.dofs[k].lower, motion.dofs[k].upper);
        keepInside(motion, q, out);
    }
}

} // namespace

std::vector<Values> exploredPoses(const Motion& motion, std::size_t samples, std::uint64_t seed) {
    constexpr std::size_t perLine = 16;
    std::vector<Values> poses;
    addSpread(motion, std::max<std::size_t>(1, samples / 2), seed, poses);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (std::size_t line = 0; line < (samples - samples / 2) / perLine; ++line) {
        Values start, direction;
        for (const Dof& dof : motion.dofs) {
            const double range = dof.upper - dof.lower;
            start.push_back(dof.lower + unit(random) * range);
            direction.push_back((2 * unit(random) - 1) * range);
        }
        addLine(motion, start, direction, perLine, poses);
    }
    return poses;
}

} // namespace tss
