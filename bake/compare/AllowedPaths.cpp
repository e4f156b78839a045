#include "bake/base/Stopwatch.h"
#include "bake/compare/Methods.h"

#include "bake/base/Lists.h"
#include "bake/base/Parallel.h"

#include <algorithm>
#include <cmath>

namespace tss::compare {

namespace {

/// A stretch of the leading DOF in which nothing touches.
struct Stretch {
    double lower, upper;
};

struct Axis {
    double lower, scale; ///< index = round((q - lower) * scale)
    int count;
};

/// The free stretches along the leading DOF; `query` holds the other values. steps: samples, between which
/// ends are bisected.
std::vector<Stretch> trace(const ComparedPair& problem, const Oracle& oracle, std::size_t leading,
                           PoseQuery query, int steps) {
    const auto touches = [&](double q) {
        query.q[leading] = q;
        query.pose = pose(problem.motion, query.q);
        return oracle(query);
    };
    const auto border = [&](double free, double hit) { // the last free value
        for (int k = 0; k < 30; ++k) {
            const double middle = 0.5 * (free + hit);
            (touches(middle) ? hit : free) = middle;
        }
        return free;
    };
    const Dof& dof = problem.motion.dofs[leading];
    std::vector<Stretch> found;
    bool wasHit = true;
    double before = dof.lower;
    for (int k = 0; k < steps; ++k) {
        const double q = dof.lower + (dof.upper - dof.lower) * k / (steps - 1);
        const bool isHit = touches(q);
        if (!isHit && wasHit) found.push_back({k == 0 ? q : border(q, before), q});
        if (!isHit) found.back().upper = q;
        if (isHit && !wasHit) found.back().upper = border(before, q);
        wasHit = isHit;
        before = q;
    }
    return found;
}

} // namespace

std::unique_ptr<CollisionMethod> makeAllowedPaths(const ComparedPair& problem, const Oracle& oracle,
                                                  int paths, int steps) {
    const Stopwatch watch;
    const std::size_t leading = leadingDof(problem);
    std::vector<Axis> axes; // one per DOF; the leading one has one entry
    std::size_t count = 1;
    for (std::size_t k = 0; k < problem.motion.dofCount(); ++k) {
        const Dof& dof = problem.motion.dofs[k];
        const int n = k == leading || dof.upper == dof.lower ? 1 : paths;
        axes.push_back({dof.lower, n > 1 ? (n - 1) / (dof.upper - dof.lower) : 0, n});
        count *= static_cast<std::size_t>(n);
    }
    std::vector<std::vector<Stretch>> found(count);
    parallelFor(count, [&](std::size_t i) {
        PoseQuery query{std::vector<double>(axes.size()), Pose::Identity()};
        std::size_t index = i;
        for (std::size_t k = axes.size(); k-- > 0;) {
            const auto n = static_cast<std::size_t>(axes[k].count);
            const Dof& dof = problem.motion.dofs[k];
            query.q[k] = axes[k].scale > 0 ? axes[k].lower + static_cast<double>(index % n) / axes[k].scale
                                           : 0.5 * (dof.lower + dof.upper);
            index /= n;
        }
        found[i] = trace(problem, oracle, leading, std::move(query), steps);
    });
    const Lists<Stretch> stretches(found); // of each path
    const double seconds = watch.seconds();
    Description about{"allowed-paths-" + std::to_string(count),
                      "allowed paths",
                      std::to_string(count) + (count == 1 ? " path along " : " paths along ") +
                          problem.motion.dofs[leading].name + ", their free stretches stored, " +
                          std::to_string(steps) +
                          " samples a path and bisected ends; a query takes the nearest path",
                      {},
                      stretches.bytes(),
                      seconds};
    const auto hit = [=](const PoseQuery& query) {
        std::size_t path = 0;
        for (std::size_t k = 0; k < axes.size(); ++k) {
            const double x = std::round((query.q[k] - axes[k].lower) * axes[k].scale);
            path = path * static_cast<std::size_t>(axes[k].count) +
                   static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(axes[k].count - 1)));
        }
        const double q = query.q[leading];
        return std::ranges::none_of(stretches[path],
                                    [q](const Stretch& free) { return q >= free.lower && q <= free.upper; });
    };
    return makeMethod(std::move(about), hit, [](const PoseQuery&) { return Work{}; });
}

} // namespace tss::compare
