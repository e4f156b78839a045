// The exploration in "Object Interaction Using Tabulated Spheres Subsets": its table of collisions Tc.
#include "bake/search/SampledSearch.h"

#include "bake/base/Parallel.h"
#include "bake/base/Poll.h"
#include "bake/search/CandidatePairs.h"
#include "bake/search/NodePairs.h"

#include <algorithm>

namespace tss {

CandidatePairs searchSampled(const SphereSet& a, const SphereSet& b, const Motion& motion,
                             const SampledSearchOptions& options, const Progress& progress) {
    CandidatePairs result;
    const ContactRule& rule = options.rule;

    Poll poll(progress, "sampled search"); // of millions of spheres the trees alone, or the pairs that touch
                                           // at one pose, may take long
    const auto stop = [&] { return poll.stopped(); };
    const SphereTree treeA(a, stop), treeB(b, stop);
    if (poll.stopped()) return result;
    const auto poses = exploredPoses(motion, options.samples, options.seed);
    ConcurrentPairs found(a.size(), b.size());
    constexpr std::size_t batch = 256;
    for (std::size_t first = 0; first < poses.size(); first += batch) {
        if (!report(progress, "sampled search", double(first) / double(poses.size()))) break;
        const std::size_t count = std::min(batch, poses.size() - first);
        parallelFor(count, [&](std::size_t k) {
            std::uint32_t seen = 0;
            visitPairsWithin(treeA, treeB, pose(motion, poses[first + k]), 0,
                             [&](std::uint32_t i, std::uint32_t j, double gap) {
                                 if (rule.touches({i, j}, gap)) found.insert({i, j});
                                 return ++seen % 256 != 0 || !poll.stopped();
                             });
        });
        if (poll.stopped()) break;
        result.explored += count;
    }
    report(progress, "sampled search", 1);

    result.pairs = found.sorted();
    result.restGaps = rule.thresholds(result.pairs);
    return result;
}

} // namespace tss
