#pragma once
#include "bake/respond/JointResponder.h"
#include "bake/table/Query.h"
#include "tests/table/RandomTable.h"

#include <limits>

/// Steps that a test asks of a joint, and how to judge where the joint went.
namespace walk {

/// Of two poses in the responder's metric.
inline double distance(const tss::JointResponder& responder, std::span<const double> x,
                       std::span<const double> y) {
    double sum = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double d = responder.weights()[k] * (x[k] - y[k]);
        sum += d * d;
    }
    return std::sqrt(sum);
}

/// A pose asked for: anywhere, or a step of any size from where the joint is.
inline std::vector<double> askedPose(random_table::Random& random, const tss::Motion& motion,
                                     const std::vector<double>& q) {
    if (random() % 4 == 0) return clampToLimits(motion, random_table::values(random, motion));
    const double share = std::pow(10.0, random_table::between(random, -6, 0));
    std::vector<double> asked = q;
    for (std::size_t k = 0; k < q.size(); ++k)
        asked[k] +=
            share * random_table::between(random, -1, 1) * (motion.dofs[k].upper - motion.dofs[k].lower);
    return clampToLimits(motion, asked);
}

/// The smallest of gapAt(q) at samples + 1 poses of the straight way.
template <class GapAt>
double smallestGapBetween(std::span<const double> from, std::span<const double> to, int samples,
                          GapAt gapAt) {
    double smallest = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= samples; ++i) {
        std::vector<double> q(from.begin(), from.end());
        for (std::size_t k = 0; k < q.size(); ++k) q[k] += (to[k] - from[k]) * i / samples;
        smallest = std::min(smallest, gapAt(q));
    }
    return smallest;
}

/// By how much a free pose within a thousandth of the range of q is nearer to the asked one, as a share of
/// the range: 0 at a local optimum. Searched at random.
inline double nearerBy(const tss::Table& table, const tss::JointResponder& responder,
                       std::span<const double> q, std::span<const double> asked,
                       random_table::Random& random) {
    const std::size_t n = q.size();
    std::vector<double> low, high;
    for (const tss::Dof& d : table.motion.dofs) {
        low.push_back(d.lower);
        high.push_back(d.upper);
    }
    const double range = distance(responder, low, high);
    double nearest = distance(responder, q, asked);
    const double start = nearest;
    for (int i = 0; i < 3000; ++i) {
        std::vector<double> p(q.begin(), q.end());
        for (std::size_t k = 0; k < n; ++k)
            p[k] += 1e-3 * range / responder.weights()[k] * random_table::between(random, -1, 1);
        p = clampToLimits(table.motion, p);
        if (query(table, p).gap >= 1.2 * responder.keptGap())
            nearest = std::min(nearest, distance(responder, p, asked));
    }
    return (start - nearest) / range;
}

} // namespace walk
