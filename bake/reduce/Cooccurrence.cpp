// The co-occurrence table Ta and the merging of rows in "Object Interaction Using Tabulated Spheres Subsets".
#include "bake/base/Order.h"
#include "bake/reduce/Reductions.h"

#include <algorithm>
#include <map>

namespace tss {

namespace {

using Bits = std::vector<std::uint64_t>;

bool subset(const Bits& x, const Bits& y) {
    for (std::size_t w = 0; w < x.size(); ++w)
        if (x[w] & ~y[w]) return false;
    return true;
}

/// Tc by sphere of A and by sphere of B, with indices renumbered to the spheres that appear.
struct Collisions {
    std::vector<std::uint32_t> a, b;             ///< index in the whole set
    std::vector<std::vector<std::uint32_t>> row; ///< per sphere of A: spheres of B it meets, rising
    std::vector<std::vector<std::uint32_t>> column;
    std::vector<Bits> meets; ///< per sphere of B: bit set of rows

    explicit Collisions(const std::vector<SpherePair>& pairs) {
        for (const SpherePair& p : pairs) {
            a.push_back(p.a);
            b.push_back(p.b);
        }
        sortOnce(a);
        sortOnce(b);
        row.resize(a.size());
        column.resize(b.size());
        meets.assign(b.size(), Bits((a.size() + 63) / 64, 0));
        for (const SpherePair& p : pairs) {
            const auto i = place(a, p.a), j = place(b, p.b);
            row[i].push_back(j);
            column[j].push_back(i);
            meets[j][i / 64] |= std::uint64_t{1} << (i % 64);
        }
    }

private:
    static std::uint32_t place(const std::vector<std::uint32_t>& list, std::uint32_t value) {
        return static_cast<std::uint32_t>(std::lower_bound(list.begin(), list.end(), value) - list.begin());
    }
};

/// Ta[i][i] == Ta[i][j] for some other j still kept, that is: i never appears without j.
bool alwaysWithAnother(const Collisions& tc, std::uint32_t i, const std::vector<bool>& kept) {
    const auto& rows = tc.column[i];
    const auto shortest = *std::min_element(
        rows.begin(), rows.end(), [&](auto x, auto y) { return tc.row[x].size() < tc.row[y].size(); });
    return std::any_of(tc.row[shortest].begin(), tc.row[shortest].end(), [&](std::uint32_t j) {
        return j != i && kept[j] && subset(tc.meets[i], tc.meets[j]);
    });
}

std::vector<bool> keptColumns(const Collisions& tc) {
    std::vector<std::uint32_t> order = indicesOf(tc.b.size());
    // The least seen first; of two that always appear together the first stays.
    std::sort(order.begin(), order.end(), [&](auto x, auto y) {
        const std::size_t nx = tc.column[x].size(), ny = tc.column[y].size();
        return nx != ny ? nx < ny : x > y;
    });
    std::vector<bool> kept(tc.b.size(), true);
    for (std::uint32_t i : order)
        if (alwaysWithAnother(tc, i, kept)) kept[i] = false;
    return kept;
}

} // namespace

Reduced reduceCooccurrence(const CandidatePairs& candidates) {
    const Collisions tc(candidates.pairs);
    const std::vector<bool> kept = keptColumns(tc);
    Reduced result;
    std::map<std::vector<std::uint32_t>, std::uint32_t> rows;
    for (std::uint32_t i = 0; i < tc.a.size(); ++i) {
        std::vector<std::uint32_t> left;
        for (std::uint32_t j : tc.row[i])
            if (kept[j]) left.push_back(j);
        if (left.empty() || !rows.emplace(left, i).second) continue;
        for (std::uint32_t j : left) result.pairs.push_back({tc.a[i], tc.b[j]});
    }
    if (!candidates.restGaps.empty())
        for (const SpherePair& pair : result.pairs) {
            const auto at = std::lower_bound(candidates.pairs.begin(), candidates.pairs.end(), pair);
            result.restGaps.push_back(candidates.restGaps[at - candidates.pairs.begin()]);
        }
    return result;
}

} // namespace tss
