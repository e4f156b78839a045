#include "bake/table/TableClusters.h"

#include <algorithm>
#include <limits>
#include <numeric>

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

/// Halves the tests where they are spread most, into whole groups and then into whole clusters.
void sortIntoClusters(std::span<const TablePair> pairs, std::span<std::uint32_t> tests, std::size_t cluster,
                      std::size_t group) {
    if (tests.size() <= cluster) return;
    const Bounds bounds = boundsOf(pairs, tests);
    Eigen::Index k = 0;
    (bounds.upper - bounds.lower).maxCoeff(&k);
    const std::size_t unit = tests.size() > group ? group : cluster;
    const std::size_t half = (tests.size() + unit - 1) / unit / 2 * unit;
    const auto along = [&](std::uint32_t test) { return k < 3 ? pairs[test].a[k] : pairs[test].b[k - 3]; };
    std::nth_element(tests.begin(), tests.begin() + half, tests.end(), [&](std::uint32_t x, std::uint32_t y) {
        return along(x) < along(y) || (along(x) == along(y) && x < y);
    });
    sortIntoClusters(pairs, tests.first(half), cluster, group);
    sortIntoClusters(pairs, tests.subspan(half), cluster, group);
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

std::vector<std::uint32_t> allOf(std::size_t count) {
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0u);
    return all;
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
    return boundOf(pairs, allOf(pairs.size()));
}

TableClusters::TableClusters(std::span<const TablePair> pairs, std::uint32_t lanes) {
    const std::size_t blocks = (pairs.size() + lanes - 1) / lanes;
    // One block would be bounded best, but to ask a cluster takes as long as some blocks.
    constexpr std::size_t fewBlocks = 3;
    testsEach_ = std::max((blocks + most - 1) / most, fewBlocks) * lanes;
    clustersEach_ = std::size_t((mostOfGroup + lanes - 1) / lanes) * lanes;
    order_ = allOf(pairs.size());
    sortIntoClusters(pairs, order_, testsEach_, testsEach_ * clustersEach_);
    bounds_ = boundsOfEach(pairs, order_, testsEach_);
    groups_ = boundsOfEach(bounds_, allOf(bounds_.size()), clustersEach_);
}

} // namespace tss
