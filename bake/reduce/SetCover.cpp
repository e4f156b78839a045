// Lagrangian relaxation with a greedy repair, after Beasley, "A Lagrangian heuristic for set-covering
// problems", 1990.
#include "bake/reduce/SetCover.h"

#include "bake/base/Order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tss {

namespace {

using Index = std::uint32_t;
using Lists = std::vector<std::vector<Index>>;

Lists transpose(const Lists& lists, std::size_t count) {
    Lists other(count);
    for (Index i = 0; i < lists.size(); ++i)
        for (Index j : lists[i]) other[j].push_back(i);
    return other;
}

/// The member of a list that is in the fewest lists: what holds the list whole is among these.
Index rarest(const std::vector<Index>& list, const Lists& byMember) {
    return *std::ranges::min_element(list, {}, [&](Index x) { return byMember[x].size(); });
}

/// The lists that hold some other list whole (of equal lists all but the first).
std::vector<bool> supersets(const Lists& lists, const Lists& byMember) {
    std::vector<bool> drop(lists.size(), false);
    std::vector<Index> order = indicesOf<Index>(lists.size());
    std::stable_sort(order.begin(), order.end(),
                     [&](Index x, Index y) { return lists[x].size() < lists[y].size(); });
    for (Index small : order) {
        if (drop[small] || lists[small].empty()) continue;
        for (Index large : byMember[rarest(lists[small], byMember)])
            if (large != small && !drop[large] && lists[large].size() >= lists[small].size())
                drop[large] = std::ranges::includes(lists[large], lists[small]);
    }
    return drop;
}

/// The lists held whole by some other list (of equal lists all but the first).
std::vector<bool> subsets(const Lists& lists, const Lists& byMember) {
    std::vector<bool> drop(lists.size(), false);
    for (Index small = 0; small < lists.size(); ++small) {
        drop[small] = lists[small].empty();
        if (drop[small]) continue;
        drop[small] = std::ranges::any_of(byMember[rarest(lists[small], byMember)], [&](Index large) {
            const bool goes = lists[large].size() > lists[small].size() ||
                              (lists[large].size() == lists[small].size() && large < small);
            return goes && !drop[large] && std::ranges::includes(lists[large], lists[small]);
        });
    }
    return drop;
}

/// What is left of a problem after the exact reductions, with columns renumbered.
struct Core {
    Lists rows;
    std::vector<Index> columns; ///< original number of each column left
    std::vector<Index> forced;  ///< original numbers of columns that every optimum of this kind may take
};

void takeForced(Core& core) {
    std::vector<bool> taken(core.columns.size(), false);
    for (const auto& row : core.rows)
        if (row.size() == 1) taken[row[0]] = true;
    for (Index c = 0; c < taken.size(); ++c)
        if (taken[c]) core.forced.push_back(core.columns[c]);
    std::erase_if(core.rows, [&](const auto& row) {
        return std::any_of(row.begin(), row.end(), [&](Index c) { return taken[c]; });
    });
}

void keepColumns(Core& core, const std::vector<bool>& drop) {
    std::vector<Index> place(core.columns.size(), 0), kept;
    for (Index c = 0; c < drop.size(); ++c)
        if (!drop[c]) {
            place[c] = static_cast<Index>(kept.size());
            kept.push_back(core.columns[c]);
        }
    for (auto& row : core.rows) {
        std::erase_if(row, [&](Index c) { return drop[c]; });
        for (Index& c : row) c = place[c];
    }
    core.columns = std::move(kept);
}

Core reduceExactly(Lists rows) {
    Core core;
    for (const auto& row : rows) core.columns.insert(core.columns.end(), row.begin(), row.end());
    sortOnce(core.columns);
    for (auto& row : rows)
        for (Index& c : row)
            c = static_cast<Index>(std::lower_bound(core.columns.begin(), core.columns.end(), c) -
                                   core.columns.begin());
    core.rows = std::move(rows);
    for (;;) {
        const std::size_t before = core.rows.size() + core.columns.size();
        const auto dropRow = supersets(core.rows, transpose(core.rows, core.columns.size()));
        Index r = 0;
        std::erase_if(core.rows, [&](const auto&) { return dropRow[r++]; });
        takeForced(core);
        keepColumns(core, subsets(transpose(core.rows, core.columns.size()), core.rows));
        if (core.rows.size() + core.columns.size() == before) return core;
    }
}

/// Drops chosen columns all of whose rows are met by another chosen one, the dearest first.
std::vector<bool> withoutRedundant(const Lists& rows, const Lists& columns, std::vector<bool> chosen,
                                   const std::vector<double>& price) {
    std::vector<int> met(rows.size(), 0);
    std::vector<Index> order;
    for (Index c = 0; c < columns.size(); ++c)
        if (chosen[c]) {
            order.push_back(c);
            for (Index r : columns[c]) ++met[r];
        }
    std::stable_sort(order.begin(), order.end(), [&](Index x, Index y) { return price[x] > price[y]; });
    for (Index c : order)
        if (std::all_of(columns[c].begin(), columns[c].end(), [&](Index r) { return met[r] > 1; })) {
            chosen[c] = false;
            for (Index r : columns[c]) --met[r];
        }
    return chosen;
}

/// Takes the columns of negative reduced price, then the best by price per row newly met until none is open.
std::vector<bool> repair(const Lists& rows, const Lists& columns, const std::vector<double>& price) {
    std::vector<bool> chosen(columns.size(), false), met(rows.size(), false);
    std::vector<std::size_t> open(columns.size());
    std::size_t left = rows.size();
    for (Index c = 0; c < columns.size(); ++c) open[c] = columns[c].size();
    const auto take = [&](Index c) {
        chosen[c] = true;
        for (Index r : columns[c]) {
            if (met[r]) continue;
            met[r] = true;
            --left;
            for (Index other : rows[r]) --open[other];
        }
    };
    for (Index c = 0; c < columns.size(); ++c)
        if (price[c] <= 0 && open[c] > 0) take(c);
    while (left > 0) {
        Index best = 0;
        double bestScore = std::numeric_limits<double>::infinity();
        for (Index c = 0; c < columns.size(); ++c) {
            if (open[c] == 0) continue;
            const double score = std::max(price[c], 1e-3) / double(open[c]);
            if (score < bestScore) {
                bestScore = score;
                best = c;
            }
        }
        take(best);
    }
    return withoutRedundant(rows, columns, std::move(chosen), price);
}

} // namespace

SetCover coverRows(Lists input) {
    constexpr int rounds = 300; // of the subgradient method
    Core core = reduceExactly(std::move(input));
    SetCover result;
    result.chosen = core.forced;
    result.lowerBound = double(core.forced.size());
    if (!core.rows.empty()) {
        const Lists columns = transpose(core.rows, core.columns.size());
        std::vector<double> u(core.rows.size()); // Lagrange multipliers
        for (std::size_t r = 0; r < u.size(); ++r) {
            std::size_t largest = 1;
            for (Index c : core.rows[r]) largest = std::max(largest, columns[c].size());
            u[r] = 1.0 / double(largest);
        }
        std::vector<double> price(columns.size()); // reduced costs
        std::vector<bool> best;
        std::size_t bestCount = columns.size() + 1;
        double bound = 0, step = 2;
        int sinceBetter = 0;
        for (int round = 0; round < rounds && std::ceil(bound - 1e-6) < double(bestCount); ++round) {
            double value = std::accumulate(u.begin(), u.end(), 0.0);
            for (Index c = 0; c < columns.size(); ++c) {
                price[c] = 1;
                for (Index r : columns[c]) price[c] -= u[r];
                value += std::min(0.0, price[c]);
            }
            sinceBetter = value > bound + 1e-9 ? 0 : sinceBetter + 1;
            bound = std::max(bound, value);
            auto cover = repair(core.rows, columns, price);
            const auto count = static_cast<std::size_t>(std::count(cover.begin(), cover.end(), true));
            if (count < bestCount) {
                bestCount = count;
                best = std::move(cover);
            }
            if (sinceBetter >= 20) {
                step *= 0.5;
                sinceBetter = 0;
            }
            double norm = 0;
            std::vector<double> slack(u.size(), 1);
            for (std::size_t r = 0; r < u.size(); ++r) {
                for (Index c : core.rows[r]) slack[r] -= price[c] < 0;
                norm += slack[r] * slack[r];
            }
            if (norm == 0) break;
            const double length = step * (1.05 * double(bestCount) - value) / norm;
            for (std::size_t r = 0; r < u.size(); ++r) u[r] = std::max(0.0, u[r] + length * slack[r]);
        }
        for (Index c = 0; c < columns.size(); ++c)
            if (best[c]) result.chosen.push_back(core.columns[c]);
        result.lowerBound += std::ceil(bound - 1e-6);
    }
    std::sort(result.chosen.begin(), result.chosen.end());
    return result;
}

} // namespace tss
