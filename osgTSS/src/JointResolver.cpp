#include "JointResolver.h"

namespace osgTSS {

namespace {

std::vector<double> pick(std::span<const double> values, const std::vector<std::size_t>& slots) {
    std::vector<double> picked;
    picked.reserve(slots.size());
    for (std::size_t slot : slots) picked.push_back(values[slot]);
    return picked;
}

} // namespace

std::vector<tss::JointResult> resolveJoints(std::span<const ResolverPair> pairs, std::span<const double> last,
                                            std::vector<double>& q) {
    constexpr int mostRounds = 16;
    std::vector<tss::JointResult> results(pairs.size());
    bool settled = false;
    for (int round = 0; round < mostRounds && !settled; ++round) {
        settled = true;
        for (std::size_t p = 0; p < pairs.size(); ++p) {
            const std::vector<double> from = pick(last, pairs[p].slots), asked = pick(q, pairs[p].slots);
            const tss::JointResult result = tss::respond(*pairs[p].table, {from, asked});
            const bool changed = result.q != asked;
            // The first word of a pair tells whether it stopped the joint; later rounds only confirm.
            if (round == 0 || changed) results[p] = result;
            for (std::size_t k = 0; k < result.q.size(); ++k) q[pairs[p].slots[k]] = result.q[k];
            if (changed && pairs.size() > 1) settled = false;
        }
    }
    if (!settled) q.assign(last.begin(), last.end());
    return results;
}

} // namespace osgTSS
