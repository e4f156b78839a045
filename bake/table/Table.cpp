#include "bake/table/Table.h"

#include "bake/base/Order.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace tss {

namespace {

/// The spheres that `used` marks, and where each went (new index by old).
SphereSet keepUsed(const SphereSet& all, const std::vector<bool>& used, std::vector<std::uint32_t>& place,
                   std::vector<std::uint32_t>* kept) {
    SphereSet set;
    place.assign(all.size(), 0);
    if (kept) kept->clear();
    for (std::uint32_t i = 0; i < all.size(); ++i) {
        if (!used[i]) continue;
        place[i] = static_cast<std::uint32_t>(set.size());
        set.push_back(all[i]);
        if (kept) kept->push_back(i);
    }
    return set;
}

} // namespace

std::vector<SpherePair> tests(const Table& table) {
    std::vector<SpherePair> pairs;
    pairs.reserve(table.columns.size());
    for (std::uint32_t i = 0; i + 1 < table.rowOffsets.size(); ++i)
        for (std::uint32_t k = table.rowOffsets[i]; k < table.rowOffsets[i + 1]; ++k)
            pairs.push_back({i, table.columns[k]});
    return pairs;
}

UsedSpheres usedSpheres(const Table& table) {
    UsedSpheres used;
    for (std::size_t i = 0; i + 1 < table.rowOffsets.size(); ++i)
        used.a += table.rowOffsets[i] < table.rowOffsets[i + 1];
    std::vector<bool> seen(table.b.size());
    for (std::uint32_t column : table.columns) seen[column] = true;
    used.b = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
    return used;
}

Table makeTable(const SphereSet& a, const SphereSet& b, const std::vector<SpherePair>& pairs,
                const std::vector<double>& restGaps, const Motion& motion, std::vector<std::uint32_t>* usedA,
                std::vector<std::uint32_t>* usedB, Keep keep) {
    assert(restGaps.empty() || restGaps.size() == pairs.size());
    std::vector<std::size_t> order = indicesOf<std::size_t>(pairs.size());
    std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return pairs[x] < pairs[y]; });
    order.erase(std::unique(order.begin(), order.end(),
                            [&](std::size_t x, std::size_t y) { return pairs[x] == pairs[y]; }),
                order.end());

    std::vector<bool> inA(a.size(), keep == Keep::All), inB(b.size(), keep == Keep::All);
    for (const SpherePair& p : pairs) inA[p.a] = inB[p.b] = true;
    std::vector<std::uint32_t> placeA, placeB;
    Table table;
    table.a = keepUsed(a, inA, placeA, usedA);
    table.b = keepUsed(b, inB, placeB, usedB);
    table.motion = motion;
    table.rowOffsets.assign(table.a.size() + 1, 0);
    const bool rest = std::any_of(restGaps.begin(), restGaps.end(), [](double g) { return g != 0; });
    for (std::size_t k : order) {
        ++table.rowOffsets[placeA[pairs[k].a] + 1];
        table.columns.push_back(placeB[pairs[k].b]);
        if (rest) table.restGaps.push_back(restGaps[k]);
    }
    std::partial_sum(table.rowOffsets.begin(), table.rowOffsets.end(), table.rowOffsets.begin());
    return table;
}

std::size_t tableBytes(const Table& table) {
    return (table.a.size() + table.b.size()) * sizeof(Sphere) +
           (table.rowOffsets.size() + table.columns.size()) * sizeof(std::uint32_t) +
           table.restGaps.size() * sizeof(double);
}

} // namespace tss
