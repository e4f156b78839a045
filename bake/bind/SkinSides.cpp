#include "bake/bind/SkinSides.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/base/UnionFind.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tss {
namespace {

/// Patches of seeds less firm than this share of an influence's firmest patch are dropped: they lie far off
/// by chance.
constexpr double firmShare = 0.1;
/// A part is attached to one side alone if cutting it off from the other side costs less than this share of
/// cutting it off from that one.
constexpr double clearShare = 0.2;

/// The seeds without patches that are much less firm than others, by their sum of area over squared distance.
std::vector<std::uint32_t> firmSeeds(const SkinGraph& graph, const SkinInfluence& influence,
                                     const std::vector<std::uint32_t>& seeds) {
    std::vector<char> isSeed(graph.vertices(), 0);
    for (const std::uint32_t v : seeds) isSeed[v] = 1;
    UnionFind sets(graph.vertices());
    for (const std::uint32_t v : seeds)
        for (const SkinGraph::Edge& edge : graph.edges[v])
            if (isSeed[edge.to]) sets.join(v, edge.to);
    std::map<std::size_t, double> firm;
    double most = 0;
    for (const std::uint32_t v : seeds) {
        const double distance = std::max(influence.distance[v], graph.meanEdge);
        most = std::max(most, firm[sets.root(v)] += graph.area[v] / (distance * distance));
    }
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t v : seeds)
        if (firm[sets.root(v)] >= firmShare * most) kept.push_back(v);
    return kept;
}

/// How far the ends of swings move a place, at most.
double displacement(const std::vector<Pose>& ends, const Vec3& place) {
    double most = 0;
    for (const Pose& end : ends) most = std::max(most, (end * place - place).norm());
    return most;
}

/// Sets vertices to Either that are no farther from a cut than the cut there is from the seeds, `far`.
void dropUncertain(const SkinGraph& graph, const std::vector<double>& far, std::vector<SkinSide>& sides) {
    const double most = *std::max_element(far.begin(), far.end());
    std::vector<std::uint32_t> beside;
    std::vector<double> starts; // most - far: within `most` then means within `far`
    for (std::uint32_t v = 0; v < sides.size(); ++v)
        for (const SkinGraph::Edge& edge : graph.edges[v])
            if (sides[edge.to] != sides[v]) {
                beside.push_back(v);
                starts.push_back(most - far[v]);
                break;
            }
    std::vector<double> from(sides.size(), infinity);
    lowerDistances(graph, beside, most, from, starts);
    for (std::size_t v = 0; v < sides.size(); ++v)
        if (from[v] <= most) sides[v] = SkinSide::Either;
}

} // namespace

SkinSides::SkinSides(const SkinAnatomy& anatomy, const std::vector<SkinInfluence>& influences,
                     const std::vector<MovedGroup>& groups)
    : anatomy_(anatomy) {
    const std::size_t count = anatomy.skin.vertices.size();
    std::vector<std::vector<std::uint32_t>> seeds = seedsOf(influences);
    for (std::size_t h = 0; h < influences.size(); ++h) {
        seeds[h] = firmSeeds(anatomy.graph, influences[h], seeds[h]);
        seeded_.push_back(!seeds[h].empty());
        along_.emplace_back(count, infinity);
        lowerDistances(anatomy.graph, seeds[h], infinity, along_.back());
    }
    for (const MovedGroup& group : groups) {
        Swing swing{group.moved, std::vector<double>(count, 0), std::vector<double>(count, 0),
                    std::vector<SkinSide>(count, SkinSide::Either)};
        std::vector<double> nearest[2] = {std::vector<double>(count, infinity),
                                          std::vector<double>(count, infinity)};
        bool both[2] = {false, false};
        for (std::size_t h = 0; h < influences.size(); ++h) {
            const bool inside = group.moved[h];
            both[inside] |= seeded_[h];
            for (const std::uint32_t v : seeds[h])
                swing.fixed[v] = inside ? SkinSide::Inside : SkinSide::Outside;
            for (std::size_t v = 0; v < count; ++v)
                nearest[inside][v] = std::min(nearest[inside][v], along_[h][v]);
        }
        for (std::size_t v = 0; v < count; ++v) {
            const double farther = std::max(nearest[0][v], nearest[1][v]);
            swing.price[v] = displacement(group.ends, anatomy.skin.vertices[v]);
            if (std::isfinite(farther))
                swing.far[v] = farther;
            else if (std::isfinite(nearest[0][v]))
                swing.fixed[v] = SkinSide::Outside; // the only seeds on its shell
            else if (std::isfinite(nearest[1][v]))
                swing.fixed[v] = SkinSide::Inside;
        }
        if (both[0] && both[1]) swings_.push_back(std::move(swing));
    }
}

/// The influences that are moved by all swings on whose inside the vertex is and by none on whose outside it
/// is; the nearest first.
std::vector<std::size_t> SkinSides::fitting(const std::vector<SkinSide>& sides, std::uint32_t v) const {
    std::vector<std::size_t> found;
    for (std::size_t h = 0; h < along_.size(); ++h) {
        if (!seeded_[h] || !std::isfinite(along_[h][v])) continue;
        bool fits = true;
        for (std::size_t s = 0; s < swings_.size() && fits; ++s)
            fits = sides[s] != (swings_[s].moved[h] ? SkinSide::Outside : SkinSide::Inside);
        if (fits) found.push_back(h);
    }
    std::stable_sort(found.begin(), found.end(),
                     [&](std::size_t a, std::size_t b) { return along_[a][v] < along_[b][v]; });
    const bool decided = std::ranges::find(sides, SkinSide::Either) == sides.end();
    if (decided && found.size() > 1) found.resize(1);
    return found;
}

std::vector<std::size_t> SkinSides::ownersOf(const std::vector<std::uint32_t>& part) const {
    std::vector<SkinSide> sides(swings_.size(), SkinSide::Either);
    parallelFor(swings_.size(), [&](std::size_t s) {
        const SkinCutter cutter(anatomy_.skin, anatomy_.graph, swings_[s].price);
        std::vector<SkinSide> tied = swings_[s].fixed;
        const auto cut = [&](SkinSide side) {
            for (const std::uint32_t v : part) tied[v] = side;
            return cutter.cut(tied);
        };
        const SkinCut inside = cut(SkinSide::Inside), outside = cut(SkinSide::Outside);
        for (std::size_t v = 0; v < tied.size(); ++v)
            if (inside.inside[v] != outside.inside[v])
                tied[v] = SkinSide::Removed; // what changes sides with the part
        const double without = cutter.cut(tied).cost, toOut = inside.cost - without,
                     toIn = outside.cost - without;
        if (toOut < clearShare * toIn) sides[s] = SkinSide::Inside;
        if (toIn < clearShare * toOut) sides[s] = SkinSide::Outside;
    });
    return swings_.empty() || part.empty() ? std::vector<std::size_t>{} : fitting(sides, part.front());
}

SkinSides::Sides SkinSides::sidesOf(const std::vector<SkinInfluence>& influences) const {
    Sides sides(swings_.size());
    parallelFor(swings_.size(), [&](std::size_t s) {
        std::vector<SkinSide> tied = swings_[s].fixed;
        for (std::size_t h = 0; h < influences.size(); ++h)
            for (const std::uint32_t v : influences[h].certain)
                tied[v] = swings_[s].moved[h] ? SkinSide::Inside : SkinSide::Outside;
        const SkinCut cut = SkinCutter(anatomy_.skin, anatomy_.graph, swings_[s].price).cut(tied);
        for (const char inside : cut.inside)
            sides[s].push_back(inside ? SkinSide::Inside : SkinSide::Outside);
        dropUncertain(anatomy_.graph, swings_[s].far, sides[s]);
    });
    return sides;
}

void SkinSides::assignCertain(std::vector<SkinInfluence>& influences) const {
    if (swings_.empty()) return;
    const Sides sides = sidesOf(influences);
    std::vector<SkinSide> here(swings_.size());
    for (std::uint32_t v = 0; v < anatomy_.graph.vertices(); ++v) {
        for (std::size_t s = 0; s < here.size(); ++s) here[s] = sides[s][v];
        if (std::ranges::find(here, SkinSide::Either) != here.end()) continue;
        if (const std::vector<std::size_t> fits = fitting(here, v); !fits.empty())
            influences[fits.front()].certain.push_back(v);
    }
}

} // namespace tss
