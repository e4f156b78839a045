#include "bake/table/LikelyTests.h"

#include "bake/base/Order.h"

namespace tss {

std::vector<std::uint32_t> likelyTests(std::span<const TablePair> pairs,
                                       const std::vector<TouchingPose>& poses, std::size_t most) {
    std::vector<std::uint32_t> candidates;
    for (const TouchingPose& at : poses) candidates.push_back(at.test);
    sortOnce(candidates);

    std::vector<std::vector<bool>> touches(candidates.size(), std::vector<bool>(poses.size()));
    for (std::size_t c = 0; c < candidates.size(); ++c)
        for (std::size_t i = 0; i < poses.size(); ++i)
            touches[c][i] =
                centreDistance(pairs[candidates[c]], poses[i].pose) <= pairs[candidates[c]].contactDistance;

    std::vector<std::uint32_t> chosen;
    std::vector<bool> open(poses.size(), true);
    while (chosen.size() < most) {
        std::size_t best = 0, ended = 0;
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            std::size_t here = 0;
            for (std::size_t i = 0; i < poses.size(); ++i) here += open[i] && touches[c][i];
            if (here > ended) ended = here, best = c;
        }
        if (ended == 0) break;
        chosen.push_back(candidates[best]);
        for (std::size_t i = 0; i < poses.size(); ++i) open[i] = open[i] && !touches[best][i];
    }
    return chosen;
}

} // namespace tss
