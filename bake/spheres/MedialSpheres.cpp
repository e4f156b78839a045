// The lazy greedy choice is that of Minoux, "Accelerated greedy algorithms for maximizing submodular set
// functions", 1978.
#include "bake/base/Order.h"
#include "bake/spheres/SphereMethods.h"

#include "bake/base/Parallel.h"
#include "bake/spheres/RestNeighbour.h"

#include <algorithm>
#include <queue>

namespace tss {
namespace {

/// For some of the spheres offered the patches that each covers.
struct CoverSets {
    std::vector<std::uint32_t> spheres; ///< indices of the spheres kept
    std::vector<std::size_t> first;     ///< #kept + 1: where the patches of each begin in `patches`
    std::vector<std::uint32_t> patches; ///< rising within a sphere

    std::span<const std::uint32_t> of(std::size_t kept) const {
        return std::span(patches).subspan(first[kept], first[kept + 1] - first[kept]);
    }
};

/// candidates: one per patch, that covers it. Large ones come first, and those whose own patch `enough`
/// others kept cover are left out: this bounds the memory by about the number of patches times `enough`, for
/// whatever tolerance, and costs few spheres. Asked to stop, it returns none.
CoverSets coverSets(std::span<const Sphere> candidates, std::span<const Patch> patches,
                    const Progress& progress) {
    constexpr int enough = 24;
    const Bvh tree = treeOfCentres(patches);
    std::vector<std::uint32_t> order = indicesOf(candidates.size());
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return candidates[a].radius > candidates[b].radius; });

    CoverSets sets;
    sets.first.push_back(0);
    std::vector<int> counts(patches.size(), 0);
    // Looked at together, though those before may leave the later ones nothing: the outcome does not depend
    // on it.
    constexpr std::size_t block = 64;
    std::vector<std::vector<std::uint32_t>> found(block);
    std::vector<std::uint32_t> batch;
    for (std::size_t at = 0; at < order.size();) {
        if (!report(progress, "spheres that cover", double(at) / double(order.size()))) return {};
        batch.clear();
        for (; at < order.size() && batch.size() < block; ++at)
            if (counts[order[at]] < enough && candidates[order[at]].radius > 0) batch.push_back(order[at]);
        parallelFor(batch.size(), [&](std::size_t i) {
            const Sphere& sphere = candidates[batch[i]];
            found[i].clear();
            visitBall(tree, sphere.centre, sphere.radius, [&](std::uint32_t patch) {
                if (covers(sphere, patches[patch])) found[i].push_back(patch);
            });
            std::sort(found[i].begin(), found[i].end());
        });
        for (std::size_t i = 0; i < batch.size(); ++i) {
            if (counts[batch[i]] >= enough) continue;
            for (const std::uint32_t patch : found[i]) ++counts[patch];
            sets.spheres.push_back(batch[i]);
            sets.patches.insert(sets.patches.end(), found[i].begin(), found[i].end());
            sets.first.push_back(sets.patches.size());
        }
    }
    return sets;
}

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

/// A small choice of spheres that covers every patch: lazy greedy by the number of patches gained (ties: the
/// one kept earlier), then the latest chosen are dropped where the others suffice (METHOD 1.3). Returns
/// indices of the candidates, rising.
std::vector<std::uint32_t> greedyCover(const CoverSets& sets, std::size_t patchCount) {
    struct Offer {
        std::size_t gain;
        std::uint32_t sphere;
        bool operator<(const Offer& o) const { return gain != o.gain ? gain < o.gain : sphere > o.sphere; }
    };
    std::vector<Offer> offers;
    for (std::uint32_t i = 0; i < sets.spheres.size(); ++i)
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
            chosen.erase(chosen.begin() + i);
        }
    for (std::uint32_t& i : chosen) i = sets.spheres[i];
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

const RestNeighbour* binding(const MedialOptions& options, double protrusion) {
    const RestNeighbour* neighbour = options.neighbour.get();
    return neighbour && neighbour->binds(protrusion) ? neighbour : nullptr;
}

} // namespace

MedialSet chooseSpheres(const FittedPatches& fitted, const Progress& progress) {
    const CoverSets sets = coverSets(fitted.candidates, fitted.patches, progress);
    // Stopped there, all candidates are the cover that there is.
    if (sets.spheres.empty()) return {fitted.candidates, fitted.inner};
    MedialSet set;
    for (const std::uint32_t i : greedyCover(sets, fitted.patches.size())) {
        set.spheres.push_back(fitted.candidates[i]);
        set.inner.push_back(fitted.inner[i]);
    }
    report(progress, "spheres that cover", 1);
    return set;
}

MedialSet medialSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                        const MedialOptions& options, const Progress& progress) {
    const PatchOptions patchOptions{protrusion, options.mostPatches, binding(options, protrusion)};
    return chooseSpheres(fitPatches(solid, patches, patchOptions, progress), progress);
}

MedialSet shrinkingSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                           const MedialOptions& options, const Progress& progress) {
    const PatchOptions patchOptions{protrusion, options.mostPatches, binding(options, protrusion), 1e-3, 1};
    FittedPatches fitted = fitPatches(solid, patches, patchOptions, progress);
    return {std::move(fitted.candidates), std::move(fitted.inner)};
}

SphereSet inscribed(const MedialSet& set) {
    SphereSet spheres = set.spheres;
    for (std::size_t i = 0; i < spheres.size(); ++i) spheres[i].radius = set.inner[i];
    return spheres;
}

} // namespace tss
