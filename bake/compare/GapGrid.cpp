#include "bake/base/Stopwatch.h"
#include "bake/compare/Methods.h"

#include "bake/base/Error.h"
#include "bake/base/Parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tss::compare {

namespace {

/// The largest distance that a point of B has from p while it is moved by the DOFs from number `from` on.
double reachFrom(const ComparedPair& problem, std::size_t from, const Vec3& p) {
    const Motion& motion = problem.motion;
    if (from == motion.dofCount()) {
        double reach = 0;
        for (const Vec3& v : problem.meshB.vertices) reach = std::max(reach, (motion.base * v - p).norm());
        for (const Sphere& s : problem.b)
            reach = std::max(reach, (motion.base * s.centre - p).norm() + s.radius);
        return reach;
    }
    const Dof& dof = motion.dofs[from];
    if (dof.kind == DofKind::Rotation)
        return reachFrom(problem, from + 1, dof.origin) + (dof.origin - p).norm();
    if (dof.kind == DofKind::Translation)
        return reachFrom(problem, from + 1, p) +
               dof.axis.norm() * std::max(std::abs(dof.lower), std::abs(dof.upper));
    double shift = 0; // a path: rotations about its frame's origin, and its translations
    for (const PathRow& row : dof.path) shift = std::max(shift, row.translation.norm());
    const Vec3 origin = dof.frame.translation();
    return reachFrom(problem, from + 1, origin) + (origin - p).norm() + shift;
}

/// How far a point of B moves at most for each unit of a DOF.
double speedOf(const ComparedPair& problem, std::size_t k) {
    const Dof& dof = problem.motion.dofs[k];
    if (dof.kind == DofKind::Rotation) return reachFrom(problem, k + 1, dof.origin);
    if (dof.kind == DofKind::Translation) return dof.axis.norm();
    const double reach = reachFrom(problem, k + 1, dof.frame.translation());
    double most = 0;
    for (std::size_t r = 0; r + 1 < dof.path.size(); ++r) {
        const PathRow &from = dof.path[r], &to = dof.path[r + 1];
        const double moved =
            (to.translation - from.translation).norm() + from.rotation.angularDistance(to.rotation) * reach;
        most = std::max(most, moved / (to.value - from.value));
    }
    return most;
}

template <int D>
struct Grid {
    struct Axis {
        double lower, scale;
        int last; ///< index of the last cell
        std::size_t stride;
    };

    float value(const PoseQuery& query) const {
        std::array<float, D> t;
        std::size_t base = 0;
        for (int k = 0; k < D; ++k) {
            const double x = (query.q[k] - axes[k].lower) * axes[k].scale;
            const int cell = std::clamp(static_cast<int>(x), 0, axes[k].last);
            t[k] = static_cast<float>(x - cell);
            base += static_cast<std::size_t>(cell) * axes[k].stride;
        }
        return interpolate<0>(base, t);
    }
    template <int K>
    float interpolate(std::size_t at, const std::array<float, D>& t) const {
        if constexpr (K == D) {
            return values[at];
        } else {
            const float low = interpolate<K + 1>(at, t);
            return low + t[K] * (interpolate<K + 1>(at + axes[K].stride, t) - low);
        }
    }

    std::array<Axis, D> axes;
    std::vector<float> values;
};

template <int D>
std::unique_ptr<CollisionMethod> makeGrid(const ComparedPair& problem, const GapOracle& oracle, int points,
                                          const StatedError& ofOracle) {
    const Stopwatch watch;
    Grid<D> grid;
    std::size_t count = 1;
    double band = 0;
    for (int k = D; k-- > 0;) {
        const Dof& dof = problem.motion.dofs[k];
        const double range = dof.upper - dof.lower;
        const int n = range > 0 ? points : 2; // a DOF that is held still has two equal layers
        grid.axes[k] = {dof.lower, range > 0 ? (n - 1) / range : 0, n - 2, count};
        count *= static_cast<std::size_t>(n);
        // With weights 1 - t and t the two grid values of a DOF are on average 2 t (1 - t) h <= h / 2 away.
        band += 0.5 * range / (n - 1) * speedOf(problem, static_cast<std::size_t>(k));
    }
    grid.values.resize(count);
    parallelFor(count, [&](std::size_t i) {
        PoseQuery query{std::vector<double>(D), Pose::Identity()};
        for (int k = 0; k < D; ++k) {
            const auto& axis = grid.axes[k];
            const std::size_t at = i / axis.stride % static_cast<std::size_t>(axis.last + 2);
            query.q[k] = axis.lower + (axis.scale > 0 ? static_cast<double>(at) / axis.scale : 0);
        }
        query.pose = pose(problem.motion, query.q);
        grid.values[i] = static_cast<float>(oracle(query));
    });
    double largest = 0;
    for (const float v : grid.values) largest = std::max(largest, std::abs(static_cast<double>(v)));
    band += 1e-6 * largest; // values are floats
    const double seconds = watch.seconds();
    Description about{"gap-grid-" + std::to_string(points),
                      "C-space grid",
                      "gaps of the sphere model on a regular grid, " + std::to_string(points) +
                          " values a DOF, linear between; the stated error is the Lipschitz bound",
                      ofOracle.widened(band, band),
                      count * sizeof(float),
                      seconds};
    // No sphere is tested; 2^D - 1 interpolations, one product each.
    return makeMethod(
        std::move(about), [grid = std::move(grid)](const PoseQuery& query) { return grid.value(query) <= 0; },
        [](const PoseQuery&) {
            return Work{0, (1u << D) - 1 + D};
        });
}

} // namespace

std::unique_ptr<CollisionMethod> makeGapGrid(const ComparedPair& problem, const GapOracle& oracle, int points,
                                             const StatedError& ofOracle) {
    if (points < 2) throw InputError("a grid of gaps: expected at least 2 points a DOF");
    switch (problem.motion.dofCount()) {
    case 1:
        return makeGrid<1>(problem, oracle, points, ofOracle);
    case 2:
        return makeGrid<2>(problem, oracle, points, ofOracle);
    case 3:
        return makeGrid<3>(problem, oracle, points, ofOracle);
    case 4:
        return makeGrid<4>(problem, oracle, points, ofOracle);
    default:
        throw InputError("a grid of gaps: expected 1 to 4 DOFs, found " +
                         std::to_string(problem.motion.dofCount()));
    }
}

} // namespace tss::compare
