#include "bake/verify/TestTree.h"

#include "bake/base/Infinity.h"
#include "bake/base/Order.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tss::verify {

namespace {

constexpr std::uint32_t leafSize = 8;
constexpr std::uint64_t enoughLooks = 500, anyLooks = std::numeric_limits<std::uint64_t>::max();
constexpr double overstated = 1 + 1e-12, understated = 1 - 1e-15;

} // namespace

struct TestTree::Search {
    double limit; ///< of gaps
    std::size_t most;
    double enough; ///< a gap after which none is looked for any more
    std::uint64_t looks;
    std::uint64_t looked = 0;
    std::vector<Found> found; ///< a heap: the least deep first

    bool wants(double gap, double move) const {
        if (gap - move > limit) return false;
        if (!found.empty() && (looked > looks || found.front().gap <= enough)) return false;
        return found.size() < most || gap < found.front().gap;
    }
    void add(Found test) {
        found.push_back(test);
        std::push_heap(found.begin(), found.end());
        if (found.size() <= most) return;
        std::pop_heap(found.begin(), found.end());
        found.pop_back();
    }
};

TestTree::TestTree(const std::vector<MeshTest>& tests) : tests_(tests), order_(indicesOf(tests.size())) {
    if (!tests.empty()) join(0, static_cast<std::uint32_t>(tests.size()));
}

TestTree::Node TestTree::around(std::uint32_t from, std::uint32_t to) const {
    Eigen::AlignedBox3d boxA, boxB;
    Node node;
    node.contactDistance = -infinity;
    double least = infinity;
    for (std::uint32_t k = from; k < to; ++k) {
        const MeshTest& t = tests_[order_[k]];
        boxA.extend(t.centreA);
        boxB.extend(t.centreB);
        node.contactDistance = std::max(node.contactDistance, t.contactDistance);
        least = std::min(least, t.contactDistance);
    }
    node.differ = node.contactDistance - least;
    node.centreA = boxA.center();
    node.centreB = boxB.center();
    for (std::uint32_t k = from; k < to; ++k) {
        const MeshTest& t = tests_[order_[k]];
        node.radiusA = std::max(node.radiusA, (t.centreA - node.centreA).norm() * overstated);
        node.radiusB = std::max(node.radiusB, (t.centreB - node.centreB).norm() * overstated);
    }
    return node;
}

/// Sorts what differs most, along A, along B or in how near its spheres must be; returns where the second
/// half begins.
std::uint32_t TestTree::halve(const Node& node, std::uint32_t from, std::uint32_t to) {
    const std::uint32_t middle = from + (to - from) / 2;
    const auto sortBy = [&](const auto& key) {
        std::nth_element(order_.begin() + from, order_.begin() + middle, order_.begin() + to,
                         [&](std::uint32_t x, std::uint32_t y) {
                             const double kx = key(tests_[x]), ky = key(tests_[y]);
                             return kx != ky ? kx < ky : x < y;
                         });
    };
    const auto sortAlong = [&](Vec3 MeshTest::*centre) {
        Eigen::AlignedBox3d box;
        for (std::uint32_t k = from; k < to; ++k) box.extend(tests_[order_[k]].*centre);
        Eigen::Index axis = 0;
        box.sizes().maxCoeff(&axis);
        sortBy([&](const MeshTest& t) { return (t.*centre)[axis]; });
    };
    if (node.differ > std::max(node.radiusA, node.radiusB))
        sortBy([](const MeshTest& t) { return t.contactDistance; });
    else
        sortAlong(node.radiusA > node.radiusB ? &MeshTest::centreA : &MeshTest::centreB);
    return middle;
}

std::int32_t TestTree::join(std::uint32_t from, std::uint32_t to) {
    Node node = around(from, to);
    if (to - from <= leafSize) {
        node.first = from;
        node.count = to - from;
    } else {
        const std::uint32_t middle = halve(node, from, to);
        node.lower = join(from, middle);
        node.upper = join(middle, to);
    }
    nodes_.push_back(node);
    return static_cast<std::int32_t>(nodes_.size()) - 1;
}

template <typename Gap>
void TestTree::visit(std::int32_t at, const Gap& gap, Search& search) const {
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
        ++search.looked;
        const MeshTest& t = tests_[order_[k]];
        const auto [here, change] = gap(t.centreA, t.centreB, 0.0);
        if (search.wants(here - t.contactDistance, change)) search.add({here - t.contactDistance, order_[k]});
    }
    if (node.count > 0) return;
    const std::array<std::int32_t, 2> halves{node.lower, node.upper};
    std::array<double, 2> gaps{}, changes{};
    for (std::size_t k = 0; k < 2; ++k) {
        const Node& half = nodes_[static_cast<std::size_t>(halves[k])];
        const auto [here, change] = gap(half.centreA, half.centreB, half.radiusB);
        gaps[k] = here * understated - (half.radiusA + half.radiusB) * overstated - half.contactDistance;
        changes[k] = change;
    }
    search.looked += 2;
    const std::size_t first = gaps[1] < gaps[0];
    for (const std::size_t k : {first, 1 - first})
        if (search.wants(gaps[k], changes[k])) visit(halves[k], gap, search);
}

std::vector<TestTree::Found> TestTree::deepest(const PoseBox& box, double limit, std::size_t most,
                                               std::uint64_t& work) const {
    Search search{limit, most, -infinity, most < tests_.size() ? enoughLooks : anyLooks, 0, {}};
    // What rounds of gaps and of where points are is in the change.
    const auto gap = [&](const Vec3& a, const Vec3& b, double radius) {
        const MovingPoint point = box.carry(b, false);
        return std::pair((point.at - a).norm(), point.move + box.turn() * radius + 4 * box.error());
    };
    if (!nodes_.empty()) visit(root(), gap, search);
    work += search.looked;
    std::sort_heap(search.found.begin(), search.found.end());
    return std::move(search.found);
}

double TestTree::leastGap(const Pose& pose, double enough, std::uint64_t& work) const {
    Search search{infinity, 1, enough, anyLooks, 0, {}};
    const auto gap = [&](const Vec3& a, const Vec3& b, double) {
        return std::pair((pose * b - a).norm(), 0.0);
    };
    if (!nodes_.empty()) visit(root(), gap, search);
    work += search.looked;
    return search.found.empty() ? infinity : search.found.front().gap;
}

} // namespace tss::verify
