#include "bake/bind/SkinClaims.h"

#include "bake/base/Infinity.h"
#include "bake/base/Order.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// In sizes of an influence: a seed is nearer to it than seedNear, and to all others farther than seedFar and
/// than seedNearer times its distance from this one. A closed upper lip lies on the lower teeth, but is
/// nearer than that to the upper jaw.
constexpr double seedNear = 0.08, seedFar = 0.12, seedNearer = 2.5;
/// If fewer than this share of the vertices that are far enough from all others are near enough, the next
/// rule applies: a thin bone deep in flesh would have seeds at its ends only.
constexpr double seedNearShare = 0.5;
/// Then seeds are vertices whose contrast, the distance from the next influence less that from this one,
/// exceeds this share of the largest contrast of any vertex. With less, skin that only passes by another bone
/// would count; with more, a bone with little skin would have no seeds.
constexpr double seedContrast = 0.2;
/// The largest contrast counts as at most this many times that of the next influence: a long bone beside a
/// short one would have no seeds near their joint, and the skin there would go with the short one.
constexpr double mostUneven = 1.5;
/// Share of those that are kept, the nearest ones: the others lie beyond the ends of the influence.
constexpr double seedShare = 0.8;
/// In sizes of an influence: smaller distances count as this much, the thickness of tissue under which a
/// claim is not weaker.
constexpr double closeShare = 0.01;
/// In sizes of an influence: the distance of its certain vertices counts as at most this.
constexpr double certainShare = 0.15;
/// Weight of a claim against the smoothness of shares along the skin.
constexpr double claimWeight = 8;
/// How fast the certainty of a claim grows with the distance from where two claims meet.
constexpr int certaintyPower = 8;

/// How much nearer vertices are to an influence than to all others.
struct Contrast {
    std::vector<double> by; ///< #V: distance from the nearest other less that from this one, scene units;
                            ///< infinite for the only one
    std::vector<std::size_t> other; ///< #V: which that is
    double most = -infinity;        ///< the largest, but for vertices that are excluded
};

bool isExcluded(const SkinInfluence& influence, std::size_t v) {
    return !influence.excluded.empty() && influence.excluded[v];
}

Contrast contrastOf(const std::vector<SkinInfluence>& influences, std::size_t index) {
    const std::vector<double>& own = influences[index].distance;
    Contrast contrast{std::vector<double>(own.size(), infinity), std::vector<std::size_t>(own.size(), index)};
    for (std::size_t v = 0; v < own.size(); ++v) {
        for (std::size_t h = 0; h < influences.size(); ++h) {
            const double by = influences[h].distance[v] - own[v];
            if (h == index || by >= contrast.by[v]) continue;
            contrast.by[v] = by;
            contrast.other[v] = h;
        }
        if (!isExcluded(influences[index], v)) contrast.most = std::max(contrast.most, contrast.by[v]);
    }
    return contrast;
}

/// Seeds by the first rule (seedNear, seedFar, seedNearer); empty by seedNearShare.
std::vector<std::uint32_t> seedsByDistance(const SkinInfluence& influence, const Contrast& contrast) {
    std::vector<std::uint32_t> seeds;
    std::size_t far = 0; // vertices far enough from all others
    for (std::uint32_t v = 0; v < contrast.by.size(); ++v) {
        const double own = influence.distance[v];
        if (contrast.by[v] + own <= std::max(seedFar * influence.size, seedNearer * own)) continue;
        ++far;
        if (own < seedNear * influence.size) seeds.push_back(v);
    }
    if (static_cast<double>(seeds.size()) < seedNearShare * static_cast<double>(far)) seeds.clear();
    return seeds;
}

/// Seeds by the second rule (seedContrast, mostUneven, seedShare).
std::vector<std::uint32_t> seedsByContrast(const SkinInfluence& influence,
                                           const std::vector<Contrast>& contrasts, std::size_t index) {
    const Contrast& contrast = contrasts[index];
    std::vector<std::uint32_t> seeds;
    std::vector<double> distances;
    for (std::uint32_t v = 0; v < contrast.by.size(); ++v) {
        const double largest =
            std::max(std::min(contrast.most, mostUneven * contrasts[contrast.other[v]].most), 0.0);
        if (isExcluded(influence, v) || contrast.by[v] <= seedContrast * largest) continue;
        seeds.push_back(v);
        distances.push_back(influence.distance[v]);
    }
    if (seeds.empty()) return seeds;
    const auto last =
        std::min(static_cast<std::size_t>(seedShare * static_cast<double>(seeds.size())), seeds.size() - 1);
    const double most = valueAt(distances, last);
    std::erase_if(seeds, [&](std::uint32_t v) { return influence.distance[v] > most; });
    return seeds;
}

/// For each vertex the distance between the seed that claims it and the nearest seed of another influence,
/// the unit of its certainty. So a limb without bones is claimed up to its end as firmly as the skin that it
/// is attached to.
std::vector<double> gapsOf(const SkinGraph& graph, const std::vector<std::uint32_t>& influence,
                           const std::vector<double>& nearest, const std::vector<double>& second) {
    std::vector<std::uint32_t> order = indicesOf(nearest.size());
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return nearest[a] < nearest[b]; });
    std::vector<double> gap = second;
    for (const std::uint32_t v : order) {
        double least = nearest[v] > 0 && std::isfinite(nearest[v]) ? infinity : 0;
        for (const SkinGraph::Edge& edge : graph.edges[v]) {
            const double by = nearest[edge.to] + edge.length;
            if (influence[edge.to] != influence[v] || nearest[edge.to] >= nearest[v] || by >= least) continue;
            least = by;
            gap[v] = gap[edge.to];
        }
    }
    return gap;
}

} // namespace

/// All influences by the first rule or all by the second: with different rules one would reach farther than
/// its neighbour.
std::vector<std::vector<std::uint32_t>> seedsOf(const std::vector<SkinInfluence>& influences) {
    std::vector<std::vector<std::uint32_t>> clear, seeds;
    bool all = true;
    std::vector<Contrast> contrasts;
    for (std::size_t h = 0; h < influences.size(); ++h) contrasts.push_back(contrastOf(influences, h));
    for (std::size_t h = 0; h < influences.size(); ++h) {
        seeds.push_back(seedsByContrast(influences[h], contrasts, h));
        const bool sized = std::isfinite(influences[h].size);
        clear.push_back(sized ? seedsByDistance(influences[h], contrasts[h]) : seeds.back());
        all = all && !clear.back().empty();
    }
    return all ? clear : seeds;
}

SkinClaims claimSkin(const TriangleMesh& skin, const SkinGraph& graph,
                     const std::vector<SkinInfluence>& influences) {
    const std::size_t count = graph.vertices();
    std::vector<double> nearest(count, infinity), second(count, infinity);
    SkinClaims claims{std::vector<std::uint32_t>(count, 0), {}, {}, {}};
    std::vector<std::uint32_t> rival(count, 0);
    std::vector<std::vector<std::uint32_t>> seeds = seedsOf(influences);
    std::vector<std::int64_t> owner(count, -1);
    for (std::uint32_t h = 0; h < influences.size(); ++h)
        for (const std::uint32_t v : influences[h].certain) owner[v] = h;
    for (std::uint32_t h = 0; h < influences.size(); ++h) {
        std::vector<double> along(count, infinity);
        std::vector<std::uint32_t>& sources = seeds[h];
        std::erase_if(sources, [&](std::uint32_t v) { return owner[v] >= 0 && owner[v] != h; });
        sources.insert(sources.end(), influences[h].certain.begin(), influences[h].certain.end());
        lowerDistances(graph, sources, infinity, along);
        for (std::size_t v = 0; v < count; ++v) {
            if (along[v] < nearest[v]) {
                second[v] = nearest[v];
                rival[v] = claims.influence[v];
                nearest[v] = along[v];
                claims.influence[v] = h;
            } else if (along[v] < second[v]) {
                second[v] = along[v];
                rival[v] = h;
            }
        }
    }
    const std::vector<double> gap = gapsOf(graph, claims.influence, nearest, second);
    claims.shells = bindShells(skin, influences, nearest);
    for (std::size_t v = 0; v < count; ++v) {
        const bool ofShell = !std::isfinite(nearest[v]);
        if (ofShell) claims.influence[v] = claims.shells[v].influence;
        if (!std::isfinite(second[v])) rival[v] = claims.influence[v];
        const SkinInfluence& own = influences[claims.influence[v]];
        double size = std::min(own.size, influences[rival[v]].size);
        if (!std::isfinite(size))
            for (const SkinInfluence& h : influences) size = std::min(size, h.size);
        double certainty = std::isfinite(second[v]) && second[v] > 0 ? 0 : 1;
        if (certainty == 0 && nearest[v] < second[v]) certainty = (second[v] - nearest[v]) / gap[v];
        const double close = closeShare * size;
        double distance =
            std::max(owner[v] >= 0 ? std::min(own.distance[v], certainShare * size) : own.distance[v], close);
        if (ofShell) { // of a thing held in a hand, the end at the hand counts most
            distance = std::max(claims.shells[v].distance, close);
            distance *= distance / std::max(claims.shells[v].least, close);
        }
        claims.size.push_back(size);
        claims.weight.push_back(graph.area[v] / (distance * distance) *
                                (claimWeight * std::pow(certainty, certaintyPower)));
    }
    return claims;
}

} // namespace tss
