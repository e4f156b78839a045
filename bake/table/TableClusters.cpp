#include "bake/table/TableClusters.h"

#include "bake/base/Order.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tss {

namespace {

/// Centres of both bodies as one point.
using Point = Eigen::Matrix<double, 6, 1>;

Point pointOf(const TablePair& pair) {
    Point point;
    point << pair.a, pair.b;
    return point;
}

struct Bounds {
    Point lower = Point::Constant(std::numeric_limits<double>::infinity());
    Point upper = Point::Constant(-std::numeric_limits<double>::infinity());
};

Bounds boundsOf(std::span<const TablePair> pairs, std::span<const std::uint32_t> tests) {
    Bounds bounds;
    for (const std::uint32_t test : tests) {
        const Point point = pointOf(pairs[test]);
        bounds.lower = bounds.lower.cwiseMin(point);
        bounds.upper = bounds.upper.cwiseMax(point);
    }
    return bounds;
}

/// Where a test lies, as far as sorting has to know, with its number.
struct Placed {
    std::array<float, 6> at;
    std::uint32_t test;
};

/// Halves the tests where they are spread most, into whole groups of the last level first and into whole
/// clusters at last.
void sortIntoClusters(std::span<Placed> tests, std::size_t cluster, std::size_t ofGroup) {
    if (tests.size() <= cluster) return;
    std::array<float, 6> lower = tests[0].at, upper = tests[0].at;
    for (const Placed& placed : tests)
        for (std::size_t k = 0; k < lower.size(); ++k) {
            lower[k] = std::min(lower[k], placed.at[k]);
            upper[k] = std::max(upper[k], placed.at[k]);
        }
    std::size_t widest = 0;
    for (std::size_t k = 1; k < lower.size(); ++k)
        if (upper[k] - lower[k] > upper[widest] - lower[widest]) widest = k;
    std::size_t unit = cluster;
    while (unit * ofGroup < tests.size()) unit *= ofGroup;
    const std::size_t half = (tests.size() + unit - 1) / unit / 2 * unit;
    std::nth_element(tests.begin(), tests.begin() + half, tests.end(), [&](const Placed& x, const Placed& y) {
        return x.at[widest] < y.at[widest] || (x.at[widest] == y.at[widest] && x.test < y.test);
    });
    sortIntoClusters(tests.first(half), cluster, ofGroup);
    sortIntoClusters(tests.subspan(half), cluster, ofGroup);
}

std::vector<std::uint32_t> inClusters(std::span<const TablePair> pairs, std::size_t cluster,
                                      std::size_t ofGroup) {
    std::vector<Placed> tests;
    for (const TablePair& p : pairs)
        tests.push_back(
            {{float(p.a.x()), float(p.a.y()), float(p.a.z()), float(p.b.x()), float(p.b.y()), float(p.b.z())},
             static_cast<std::uint32_t>(tests.size())});
    sortIntoClusters(tests, cluster, ofGroup);
    std::vector<std::uint32_t> order;
    for (const Placed& placed : tests) order.push_back(placed.test);
    return order;
}

TablePair boundOf(std::span<const TablePair> pairs, std::span<const std::uint32_t> tests) {
    const Bounds bounds = boundsOf(pairs, tests);
    const Point middle = 0.5 * (bounds.lower + bounds.upper);
    TablePair bound;
    bound.a = middle.head<3>();
    bound.b = middle.tail<3>();
    bound.contactDistance = -std::numeric_limits<double>::infinity();
    double size = 0;
    for (const std::uint32_t test : tests) {
        const TablePair& pair = pairs[test];
        const double off = (pair.a - bound.a).norm() + (pair.b - bound.b).norm();
        bound.contactDistance = std::max(bound.contactDistance, off + pair.contactDistance);
        size = std::max(size, pair.a.norm() + pair.b.norm() + off + std::abs(pair.contactDistance));
    }
    bound.contactDistance += 1e-14 * size; // for the rounding of all that
    return bound;
}

std::vector<TablePair> boundsOfEach(std::span<const TablePair> pairs, std::span<const std::uint32_t> order,
                                    std::size_t each) {
    std::vector<TablePair> bounds;
    for (std::size_t first = 0; first < order.size(); first += each)
        bounds.push_back(boundOf(pairs, order.subspan(first, std::min(each, order.size() - first))));
    return bounds;
}

} // namespace

TablePair boundOf(std::span<const TablePair> pairs) {
    return boundOf(pairs, indicesOf(pairs.size()));
}

TableClusters::TableClusters(std::span<const TablePair> pairs, std::uint32_t lanes) {
    if (pairs.empty()) return;
    // One block would be bounded best, but to ask a cluster takes as long as some blocks.
    constexpr std::size_t fewBlocks = 3;
    testsEach_ = fewBlocks * lanes;
    ofGroup_ = std::size_t((mostOfGroup + lanes - 1) / lanes) * lanes;
    order_ = inClusters(pairs, testsEach_, ofGroup_);
    levels_.push_back(boundsOfEach(pairs, order_, testsEach_));
    do {
        const std::vector<TablePair>& below = levels_.back();
        levels_.push_back(boundsOfEach(below, indicesOf(below.size()), ofGroup_));
    } while (levels_.back().size() > mostAtTop);
}

} // namespace tss
