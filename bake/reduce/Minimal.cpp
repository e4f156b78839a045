// The minimal sphere set Mss of "Object Interaction Using Tabulated Spheres Subsets".
#include "bake/base/Order.h"
#include "bake/reduce/Reductions.h"

#include "bake/base/Parallel.h"
#include "bake/reduce/LowerBound.h"
#include "bake/search/NodePairs.h"
#include "bake/search/SampledSearch.h"

#include <algorithm>

namespace tss {

namespace {

/// The poses that some pair collides at, with the pairs that do. A pose whose pairs include all pairs of
/// another adds no condition; such poses are left out as they are met, so that deep poses with their
/// thousands of pairs are never stored.
class Conditions {
public:
    Conditions(const SphereSet& a, const SphereSet& b, const Motion& motion, const ContactRule& rule)
        : a_(a), b_(b), motion_(motion), rule_(rule), treeA_(a), treeB_(b) {}

    std::vector<std::vector<SpherePair>> collect(const std::vector<std::vector<double>>& poses,
                                                 const Progress& progress) {
        std::vector<std::size_t> count(poses.size());
        parallelFor(poses.size(), [&](std::size_t k) { count[k] = pairsAt(poses[k]).size(); });
        std::vector<std::size_t> order = indicesOf<std::size_t>(poses.size());
        std::stable_sort(order.begin(), order.end(), [&](auto x, auto y) { return count[x] < count[y]; });

        std::vector<std::vector<SpherePair>> kept;
        for (std::size_t n = 0; n < order.size(); ++n) {
            if (count[order[n]] == 0) continue;
            if (n % 64 == 0 && !report(progress, "minimal subset", double(n) / double(order.size()))) break;
            const Pose at = pose(motion_, poses[order[n]]);
            if (!std::any_of(kept.begin(), kept.end(), [&](const auto& list) { return allTouch(list, at); }))
                kept.push_back(pairsAt(poses[order[n]]));
        }
        return kept;
    }

private:
    std::vector<SpherePair> pairsAt(const std::vector<double>& q) const {
        std::vector<SpherePair> list;
        visitPairsWithin(treeA_, treeB_, pose(motion_, q), 0,
                         [&](std::uint32_t i, std::uint32_t j, double gap) {
                             if (rule_.touches({i, j}, gap)) list.push_back({i, j});
                         });
        std::sort(list.begin(), list.end());
        return list;
    }

    bool allTouch(const std::vector<SpherePair>& list, const Pose& at) const {
        return std::all_of(list.begin(), list.end(), [&](const SpherePair& p) {
            const double gap =
                (at * b_[p.b].centre - a_[p.a].centre).norm() - a_[p.a].radius - b_[p.b].radius;
            return rule_.touches(p, gap);
        });
    }

    const SphereSet &a_, &b_;
    const Motion& motion_;
    const ContactRule& rule_;
    SphereTree treeA_, treeB_;
};

} // namespace

Reduced reduceMinimal(const SphereSet& a, const SphereSet& b, const Motion& motion,
                      const SampledSearchOptions& options, const Progress& progress) {
    const ContactRule& rule = options.rule;
    const auto conditions = Conditions(a, b, motion, rule)
                                .collect(exploredPoses(motion, options.samples, options.seed), progress);

    const PairCover cover = coverPairs({conditions.begin(), conditions.end()});
    return {cover.pairs, rule.thresholds(cover.pairs), cover.lowerBound};
}

} // namespace tss
