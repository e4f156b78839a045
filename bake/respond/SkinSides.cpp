#include "bake/respond/SkinSides.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/base/UnionFind.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tss {
namespace {

/// Of the most firmly held patch of a holder's seeds: what is held less so lies far off by chance.
constexpr double firmShare = 0.1;
/// A part hangs on one side alone where this share of what it costs to part it from that one parts it from
/// the other.
constexpr double clearShare = 0.2;

/// Leaves those patches out that are held much less firmly than others: area over squared distance.
std::vector<std::uint32_t> firmOnes(const SkinGraph& graph, const SkinHolder& holder,
                                    const std::vector<std::uint32_t>& seeds) {
    std::vector<char> is(graph.vertices(), 0);
    for (const std::uint32_t v : seeds) is[v] = 1;
    UnionFind sets(graph.vertices());
    for (const std::uint32_t v : seeds)
        for (const SkinGraph::Edge& edge : graph.edges[v])
            if (is[edge.to]) sets.join(v, edge.to);
    std::map<std::size_t, double> firm;
    double most = 0;
    for (const std::uint32_t v : seeds) {
        const double distance = std::max(holder.distance[v], graph.meanEdge);
        most = std::max(most, firm[sets.root(v)] += graph.area[v] / (distance * distance));
    }
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t v : seeds)
        if (firm[sets.root(v)] >= firmShare * most) kept.push_back(v);
    return kept;
}

/// Makes those either that are no farther from a cut than the cut is from what it parts.
void keepCertain(const SkinGraph& graph, const std::vector<double>& price, std::vector<SkinSide>& sides) {
    const double most = *std::max_element(price.begin(), price.end());
    std::vector<std::uint32_t> beside;
    std::vector<double> starts; // farther by `most` than the price allows, so that all are above 0
    for (std::uint32_t v = 0; v < sides.size(); ++v)
        for (const SkinGraph::Edge& edge : graph.edges[v])
            if (sides[edge.to] != sides[v]) {
                beside.push_back(v);
                starts.push_back(most - price[v]);
                break;
            }
    std::vector<double> from(sides.size(), infinity);
    lowerDistances(graph, beside, most, from, starts);
    for (std::size_t v = 0; v < sides.size(); ++v)
        if (from[v] <= most) sides[v] = SkinSide::Either;
}

} // namespace

SkinSides::SkinSides(const SkinGround& ground, const std::vector<SkinHolder>& holders,
                     const std::vector<std::vector<char>>& moved)
    : ground_(ground) {
    const std::size_t count = ground.skin.vertices.size();
    std::vector<std::vector<std::uint32_t>> seeds = seedsOf(holders);
    for (std::size_t h = 0; h < holders.size(); ++h) {
        seeds[h] = firmOnes(ground.graph, holders[h], seeds[h]);
        seeded_.push_back(!seeds[h].empty());
        along_.emplace_back(count, infinity);
        lowerDistances(ground.graph, seeds[h], infinity, along_.back());
    }
    for (const std::vector<char>& group : moved) {
        Swing swing{group, std::vector<double>(count, 0), std::vector<SkinSide>(count, SkinSide::Either)};
        std::vector<double> nearest[2] = {std::vector<double>(count, infinity),
                                          std::vector<double>(count, infinity)};
        bool both[2] = {false, false};
        for (std::size_t h = 0; h < holders.size(); ++h) {
            const bool inside = group[h];
            both[inside] |= seeded_[h];
            for (const std::uint32_t v : seeds[h])
                swing.undoubted[v] = inside ? SkinSide::Inside : SkinSide::Outside;
            for (std::size_t v = 0; v < count; ++v)
                nearest[inside][v] = std::min(nearest[inside][v], along_[h][v]);
        }
        for (std::size_t v = 0; v < count; ++v) {
            const double farther = std::max(nearest[0][v], nearest[1][v]);
            if (std::isfinite(farther))
                swing.price[v] = farther;
            else if (std::isfinite(nearest[0][v]))
                swing.undoubted[v] = SkinSide::Outside; // of its shell
            else if (std::isfinite(nearest[1][v]))
                swing.undoubted[v] = SkinSide::Inside;
        }
        if (both[0] && both[1]) swings_.push_back(std::move(swing));
    }
}

/// The one that moves in those swings in whose sides the vertex is, and in no other; the nearest of several.
std::optional<std::size_t> SkinSides::holderOf(const std::vector<SkinSide>& sides, std::uint32_t v) const {
    std::optional<std::size_t> found;
    for (std::size_t h = 0; h < along_.size(); ++h) {
        if (!seeded_[h] || !std::isfinite(along_[h][v])) continue;
        bool fits = true;
        for (std::size_t s = 0; s < swings_.size() && fits; ++s)
            fits = sides[s] == (swings_[s].moved[h] ? SkinSide::Inside : SkinSide::Outside);
        if (fits && (!found || along_[h][v] < along_[*found][v])) found = h;
    }
    return found;
}

std::optional<std::size_t> SkinSides::ownerOf(const std::vector<std::uint32_t>& part) const {
    std::vector<SkinSide> sides(swings_.size(), SkinSide::Either);
    parallelFor(swings_.size(), [&](std::size_t s) {
        const SkinCutter cutter(ground_.skin, ground_.graph, swings_[s].price);
        std::vector<SkinSide> tied = swings_[s].undoubted;
        const auto cut = [&](SkinSide side) {
            for (const std::uint32_t v : part) tied[v] = side;
            return cutter.cut(tied);
        };
        const SkinCut inside = cut(SkinSide::Inside), outside = cut(SkinSide::Outside);
        for (std::size_t v = 0; v < tied.size(); ++v)
            if (inside.inside[v] != outside.inside[v]) tied[v] = SkinSide::Removed; // what goes with the part
        const double without = cutter.cut(tied).cost, toOut = inside.cost - without,
                     toIn = outside.cost - without;
        if (toOut < clearShare * toIn) sides[s] = SkinSide::Inside;
        if (toIn < clearShare * toOut) sides[s] = SkinSide::Outside;
    });
    return swings_.empty() || part.empty() ? std::nullopt : holderOf(sides, part.front());
}

SkinSides::Sides SkinSides::sidesOf(const std::vector<SkinHolder>& holders) const {
    Sides sides(swings_.size());
    parallelFor(swings_.size(), [&](std::size_t s) {
        std::vector<SkinSide> tied = swings_[s].undoubted;
        for (std::size_t h = 0; h < holders.size(); ++h)
            for (const std::uint32_t v : holders[h].sure)
                tied[v] = swings_[s].moved[h] ? SkinSide::Inside : SkinSide::Outside;
        const SkinCut cut = SkinCutter(ground_.skin, ground_.graph, swings_[s].price).cut(tied);
        for (const char inside : cut.inside)
            sides[s].push_back(inside ? SkinSide::Inside : SkinSide::Outside);
        keepCertain(ground_.graph, swings_[s].price, sides[s]);
    });
    return sides;
}

void SkinSides::hold(std::vector<SkinHolder>& holders) const {
    if (swings_.empty()) return;
    const Sides sides = sidesOf(holders);
    std::vector<SkinSide> here(swings_.size());
    for (std::uint32_t v = 0; v < ground_.graph.vertices(); ++v) {
        for (std::size_t s = 0; s < here.size(); ++s) here[s] = sides[s][v];
        if (const std::optional<std::size_t> h = holderOf(here, v)) holders[*h].sure.push_back(v);
    }
}

} // namespace tss
