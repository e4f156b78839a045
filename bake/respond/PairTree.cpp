#include "bake/respond/PairTree.h"

#include "bake/base/Order.h"
#include "bake/geometry/Bvh.h"

#include <algorithm>

namespace tss {

namespace {

constexpr std::uint32_t fan = PairTree::fan;

/// What floats may round, as a share of the coordinates: 18 roundoffs of 2^-24 by count, and as much again.
constexpr double rounding = 2.2e-6;

/// Halves the spheres where they are spread most, into whole blocks of blocks down to whole blocks.
void sortIntoBlocks(const SphereSet& spheres, std::span<std::uint32_t> order) {
    if (order.size() <= fan) return;
    std::size_t unit = fan;
    while (unit * fan < order.size()) unit *= fan;
    const std::size_t half = ((order.size() + unit - 1) / unit + 1) / 2 * unit;
    partAlongLongest(order, half, [&](std::uint32_t i) { return spheres[i].centre; });
    sortIntoBlocks(spheres, order.first(half));
    sortIntoBlocks(spheres, order.subspan(half));
}

/// A sphere that holds some.
Sphere boundOf(std::span<const Sphere> spheres) {
    Vec3 lower = spheres[0].centre, upper = lower;
    for (const Sphere& sphere : spheres) {
        lower = lower.cwiseMin(sphere.centre);
        upper = upper.cwiseMax(sphere.centre);
    }
    Sphere bound{0.5 * (lower + upper), 0};
    for (const Sphere& sphere : spheres)
        bound.radius = std::max(bound.radius, (sphere.centre - bound.centre).norm() + sphere.radius);
    return bound;
}

std::vector<PairTree::Block> blocksOf(std::span<const Sphere> spheres, const Vec3& origin) {
    std::vector<PairTree::Block> blocks((spheres.size() + fan - 1) / fan);
    for (std::size_t i = 0; i < blocks.size() * fan; ++i) {
        PairTree::Block& block = blocks[i / fan];
        const std::size_t lane = i % fan;
        const Sphere sphere = i < spheres.size() ? spheres[i] : Sphere{origin, -1e18};
        const Vec3 at = sphere.centre - origin;
        block.x[lane] = float(at.x());
        block.y[lane] = float(at.y());
        block.z[lane] = float(at.z());
        block.r[lane] = float(sphere.radius);
    }
    return blocks;
}

/// Spheres in the order of the leaves. levels: at least so many.
PairTree::Side sideOf(std::vector<Sphere> spheres, std::size_t levels) {
    PairTree::Side side;
    side.origin = boundOf(spheres).centre;
    for (const Sphere& sphere : spheres)
        side.extent = std::max(side.extent, (sphere.centre - side.origin).norm() + sphere.radius);
    while (side.levels.empty() || side.levels.back().size() > 1 || side.levels.size() < levels) {
        side.levels.push_back(blocksOf(spheres, side.origin));
        std::vector<Sphere> bounds;
        for (std::size_t first = 0; first < spheres.size(); first += fan)
            bounds.push_back(boundOf(
                std::span(spheres).subspan(first, std::min<std::size_t>(fan, spheres.size() - first))));
        spheres = std::move(bounds);
    }
    side.root = blocksOf(spheres, side.origin).front();
    std::reverse(side.levels.begin(), side.levels.end());
    return side;
}

std::vector<std::uint32_t> orderOf(const SphereSet& spheres) {
    std::vector<std::uint32_t> order = indicesOf(spheres.size());
    sortIntoBlocks(spheres, order);
    return order;
}

std::size_t levelsFor(std::size_t count) {
    std::size_t levels = 1;
    for (std::size_t blocks = (count + fan - 1) / fan; blocks > 1; blocks = (blocks + fan - 1) / fan)
        ++levels;
    return levels;
}

} // namespace

PairTree::PairTree(const Table& table, KernelTarget target) : ask_(pairTreeKernel(target)) {
    const std::vector<std::uint32_t> orderA = orderOf(table.a), orderB = orderOf(table.b);
    const auto sorted = [](const SphereSet& spheres, std::span<const std::uint32_t> order) {
        std::vector<Sphere> some;
        for (const std::uint32_t i : order) some.push_back(spheres[i]);
        return some;
    };
    const std::size_t levels = levelsFor(std::max(table.a.size(), table.b.size()));
    a_ = sideOf(sorted(table.a, orderA), levels);
    b_ = sideOf(sorted(table.b, orderB), levels);
    for (const double rest : table.restGaps) mostRest_ = std::max(mostRest_, rest);
    fillTests(table, orderA, orderB);
}

void PairTree::fillTests(const Table& table, std::span<const std::uint32_t> orderA,
                         std::span<const std::uint32_t> orderB) {
    const std::size_t leavesB = b_.levels.back().size();
    leafPairs_.assign(a_.levels.back().size() * leavesB, 0);
    std::vector<std::uint32_t> place(orderB.size());
    for (std::uint32_t i = 0; i < orderB.size(); ++i) place[orderB[i]] = i;
    for (std::size_t i = 0; i < orderA.size(); ++i)
        for (auto k = table.rowOffsets[orderA[i]]; k < table.rowOffsets[orderA[i] + 1]; ++k) {
            const std::uint32_t b = place[table.columns[k]];
            std::uint32_t& at = leafPairs_[i / fan * leavesB + b / fan];
            if (at == 0) {
                tests_.emplace_back().fill(-1);
                at = static_cast<std::uint32_t>(tests_.size());
            }
            tests_[at - 1][b % fan * fan + i % fan] = static_cast<std::int32_t>(k);
        }
}

std::uint32_t PairTree::testsWithin(const Pose& pose, double margin, std::uint32_t enough,
                                    std::uint32_t* out) const {
    const Vec3 move = pose * b_.origin - a_.origin;
    Question question;
    for (int row = 0; row < 3; ++row) {
        for (int k = 0; k < 3; ++k) question.pose[4 * row + k] = float(pose(row, k));
        question.pose[4 * row + 3] = float(move[row]);
    }
    const double reach = margin + mostRest_;
    question.reach = float(reach + rounding * (a_.extent + b_.extent + move.norm() + reach));
    question.enough = enough;
    return ask_(*this, question, out);
}

} // namespace tss
