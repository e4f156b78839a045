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

class AllowedPaths final : public CollisionMethodLoop<AllowedPaths> {
public:
    AllowedPaths(const ComparedPair& problem, const Oracle& oracle, int paths, int steps)
        : leading_(leadingDof(problem)) {
        const Stopwatch watch;
        std::size_t count = 1;
        for (std::size_t k = 0; k < problem.motion.dofCount(); ++k) {
            const Dof& dof = problem.motion.dofs[k];
            const int n = k == leading_ || dof.upper == dof.lower ? 1 : paths;
            axes_.push_back({dof.lower, n > 1 ? (n - 1) / (dof.upper - dof.lower) : 0, n});
            count *= static_cast<std::size_t>(n);
        }
        std::vector<std::vector<Stretch>> found(count);
        parallelFor(count, [&](std::size_t i) { found[i] = trace(problem, oracle, i, steps); });
        stretches_ = Lists<Stretch>(found);
        const double seconds = watch.seconds();
        description() = {"allowed-paths-" + std::to_string(count),
                         "allowed paths",
                         std::to_string(count) + (count == 1 ? " path along " : " paths along ") +
                             problem.motion.dofs[leading_].name + ", their free stretches stored, " +
                             std::to_string(steps) +
                             " samples a path and bisected ends; a query takes the nearest path",
                         {},
                         stretches_.bytes(),
                         seconds};
    }

    bool hit(const PoseQuery& query) const override {
        std::size_t path = 0;
        for (std::size_t k = 0; k < axes_.size(); ++k) {
            const double x = std::round((query.q[k] - axes_[k].lower) * axes_[k].scale);
            path = path * static_cast<std::size_t>(axes_[k].count) +
                   static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(axes_[k].count - 1)));
        }
        const double q = query.q[leading_];
        return std::ranges::none_of(stretches_[path],
                                    [q](const Stretch& free) { return q >= free.lower && q <= free.upper; });
    }
    std::optional<Work> work(const PoseQuery&) const override { return Work{}; }

private:
    struct Axis {
        double lower, scale; ///< index = round((q - lower) * scale)
        int count;
    };

    std::vector<Stretch> trace(const ComparedPair& problem, const Oracle& oracle, std::size_t index,
                               int steps) const {
        PoseQuery query{std::vector<double>(axes_.size()), Pose::Identity()};
        for (std::size_t k = axes_.size(); k-- > 0;) {
            const auto n = static_cast<std::size_t>(axes_[k].count);
            query.q[k] = axes_[k].scale > 0
                             ? axes_[k].lower + static_cast<double>(index % n) / axes_[k].scale
                             : 0.5 * (problem.motion.dofs[k].lower + problem.motion.dofs[k].upper);
            index /= n;
        }
        const auto touches = [&](double q) {
            query.q[leading_] = q;
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
        const Dof& dof = problem.motion.dofs[leading_];
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

    std::size_t leading_;
    std::vector<Axis> axes_;   ///< one per DOF; the leading one has one entry
    Lists<Stretch> stretches_; ///< of each path
};

} // namespace

std::unique_ptr<CollisionMethod> makeAllowedPaths(const ComparedPair& problem, const Oracle& oracle,
                                                  int paths, int steps) {
    return std::make_unique<AllowedPaths>(problem, oracle, paths, steps);
}

} // namespace tss::compare
