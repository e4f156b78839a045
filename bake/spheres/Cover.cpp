#include "bake/spheres/Cover.h"

#include "bake/base/Parallel.h"

#include <algorithm>
#include <queue>

namespace tss {

CoverSets coverSets(std::span<const Sphere> spheres, std::span<const Patch> patches) {
    std::vector<Eigen::AlignedBox3d> centres;
    centres.reserve(patches.size());
    for (const Patch& patch : patches) centres.emplace_back(patch.centre());
    const Bvh tree = buildBvh(centres, 8);

    constexpr std::size_t block = 256;
    const std::size_t blocks = (spheres.size() + block - 1) / block;
    std::vector<std::vector<std::uint32_t>> found(blocks);
    std::vector<std::size_t> counts(spheres.size());
    parallelFor(blocks, [&](std::size_t b) {
        for (std::size_t i = b * block; i < std::min(spheres.size(), (b + 1) * block); ++i) {
            const std::size_t before = found[b].size();
            visitBall(tree, spheres[i].centre, spheres[i].radius, [&](std::uint32_t patch) {
                if (covers(spheres[i], patches[patch])) found[b].push_back(patch);
            });
            std::sort(found[b].begin() + static_cast<std::ptrdiff_t>(before), found[b].end());
            counts[i] = found[b].size() - before;
        }
    });
    CoverSets sets;
    sets.first.push_back(0);
    for (const std::size_t count : counts) sets.first.push_back(sets.first.back() + count);
    sets.patches.reserve(sets.first.back());
    for (std::vector<std::uint32_t>& part : found) {
        sets.patches.insert(sets.patches.end(), part.begin(), part.end());
        part = {};
    }
    return sets;
}

namespace {

/// How many of the chosen spheres cover each patch.
class Counts {
public:
    Counts(const CoverSets& sets, std::size_t patchCount) : sets_(sets), counts_(patchCount, 0) {}

    std::size_t gain(std::uint32_t sphere) const {
        const auto patches = sets_.of(sphere);
        return static_cast<std::size_t>(
            std::count_if(patches.begin(), patches.end(), [&](auto patch) { return counts_[patch] == 0; }));
    }
    bool redundant(std::uint32_t sphere) const {
        const auto patches = sets_.of(sphere);
        return std::all_of(patches.begin(), patches.end(), [&](auto patch) { return counts_[patch] > 1; });
    }
    void change(std::uint32_t sphere, int by) {
        for (const std::uint32_t patch : sets_.of(sphere)) counts_[patch] += by;
    }

private:
    const CoverSets& sets_;
    std::vector<int> counts_;
};

} // namespace

std::vector<std::uint32_t> greedyCover(const CoverSets& sets, std::size_t patchCount) {
    struct Offer {
        std::size_t gain;
        std::uint32_t sphere;
        bool operator<(const Offer& o) const { return gain != o.gain ? gain < o.gain : sphere > o.sphere; }
    };
    std::vector<Offer> offers;
    for (std::uint32_t i = 0; i + 1 < sets.first.size(); ++i)
        if (!sets.of(i).empty()) offers.push_back({sets.of(i).size(), i});
    std::priority_queue<Offer> queue(std::less<Offer>(), std::move(offers));

    Counts counts(sets, patchCount);
    std::vector<std::uint32_t> chosen;
    while (!queue.empty()) {
        Offer best = queue.top();
        queue.pop();
        // Gains only fall: an offer that is still the best after a second look is the best of all.
        best.gain = counts.gain(best.sphere);
        if (best.gain == 0) continue;
        if (!queue.empty() && best < queue.top()) {
            queue.push(best);
            continue;
        }
        chosen.push_back(best.sphere);
        counts.change(best.sphere, 1);
    }
    for (std::size_t i = chosen.size(); i-- > 0;)
        if (counts.redundant(chosen[i])) {
            counts.change(chosen[i], -1);
            chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(i));
        }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

} // namespace tss
