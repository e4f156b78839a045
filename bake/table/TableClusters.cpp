#include "bake/table/TableClusters.h"

#include <algorithm>
#include <cmath>
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

/// Halves the tests where they are spread most, into whole clusters.
void sortIntoClusters(std::span<const TablePair> pairs, std::span<std::uint32_t> tests, std::size_t each) {
    if (tests.size() <= each) return;
    const Bounds bounds = boundsOf(pairs, tests);
    Eigen::Index k = 0;
    (bounds.upper - bounds.lower).maxCoeff(&k);
    const std::size_t clusters = (tests.size() + each - 1) / each, half = clusters / 2 * each;
    const auto along = [&](std::uint32_t test) { return k < 3 ? pairs[test].a[k] : pairs[test].b[k - 3]; };
    std::nth_element(tests.begin(), tests.begin() + std::ptrdiff_t(half), tests.end(),
                     [&](std::uint32_t x, std::uint32_t y) {
                         return along(x) < along(y) || (along(x) == along(y) && x < y);
                     });
    sortIntoClusters(pairs, tests.first(half), each);
    sortIntoClusters(pairs, tests.subspan(half), each);
}

TablePair boundOf(std::span<const TablePair> pairs, std::span<const std::uint32_t> tests) {
    const Bounds bounds = boundsOf(pairs, tests);
    const Point middle = 0.5 * (bounds.lower + bounds.upper);
    TablePair bound;
    bound.a = middle.head<3>();
    bound.b = middle.tail<3>();
    bound.reach = -std::numeric_limits<double>::infinity();
    double size = 0;
    for (const std::uint32_t test : tests) {
        const TablePair& pair = pairs[test];
        const double off = (pair.a - bound.a).norm() + (pair.b - bound.b).norm();
        bound.reach = std::max(bound.reach, off + pair.reach);
        size = std::max(size, pair.a.norm() + pair.b.norm() + off + std::abs(pair.reach));
    }
    bound.reach += 1e-14 * size; // for the rounding of all that
    return bound;
}

} // namespace

TableClusters::TableClusters(std::span<const TablePair> pairs, std::uint32_t lanes) {
    const double blocks = std::ceil(double(pairs.size()) / lanes);
    // A query looks at all bounds, and then into few clusters.
    const double each = std::max(std::ceil(blocks / most), std::ceil(std::sqrt(blocks) / 8));
    testsEach_ = std::size_t(each) * lanes;
    order_.resize(pairs.size());
    std::iota(order_.begin(), order_.end(), 0u);
    sortIntoClusters(pairs, order_, testsEach_);
    for (std::size_t first = 0; first < order_.size(); first += testsEach_)
        bounds_.push_back(boundOf(pairs, std::span<const std::uint32_t>(order_).subspan(
                                             first, std::min(testsEach_, order_.size() - first))));
}

} // namespace tss
