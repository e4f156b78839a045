#include "bake/search/NearSurface.h"

#include "bake/base/Parallel.h"
#include "bake/base/Poll.h"
#include "bake/motion/CellTools.h"
#include "bake/search/SurfacesApart.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

namespace tss {

namespace {

/// A node of the tree over patches, with a ball that holds all below it.
struct Ball {
    Vec3 centre;
    double radius;
};

/// One pass over the cells of Q, shared by all threads. Marks in `reached` are only ever set, and whether one
/// gets set does not depend on the others: reading them only saves work.
struct Pass {
    Side side; ///< of the patches
    const MeshQuery& other;
    const MotionRates& rates;
    double resolution; ///< scene units: cells in which the patches move less are not split further
    double margin;     ///< scene units
    Poll& poll;
    std::uint64_t mostTests; ///< of one subtree; what is open then counts as near
    double rounding;         ///< scene units: of distances between the two bodies

    Bvh tree{};                ///< over the patches
    std::vector<Ball> balls{}; ///< #nodes; a leaf is one patch, or many where there was no time to divide
    std::vector<MeshQuery> triangles{}; ///< #patches, each its triangle; empty: balls are tested alone
    std::unique_ptr<std::atomic<char>[]> reached {}; ///< #nodes: 1 where all patches below come near
    std::vector<std::uint32_t> parents{};            ///< #nodes
    std::atomic<std::uint64_t> tests{0};             ///< of balls, so far
};

void buildTree(Pass& p, std::span<const Patch> patches) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const Patch& patch : patches) {
        Eigen::AlignedBox3d box(patch.corners[0]);
        boxes.push_back(box.extend(patch.corners[1]).extend(patch.corners[2]));
    }
    p.tree = buildBvh(boxes, 1, [&] { return p.poll.stopped(); });
    p.parents.resize(p.tree.nodes.size(), 0);
    p.reached = std::make_unique<std::atomic<char>[]>(p.tree.nodes.size());
    for (std::uint32_t n = 0; n < p.tree.nodes.size(); ++n) {
        const Bvh::Node& node = p.tree.nodes[n];
        if (node.count == 0) p.parents[node.first] = p.parents[node.first + 1] = n;
        const Vec3 centre = 0.5 * (node.lower + node.upper);
        double radius2 = (node.upper - centre).squaredNorm();
        if (node.count == 1) {
            const Patch& patch = patches[p.tree.items[node.first]];
            p.balls.push_back({patch.centre(), patch.radius()});
            continue;
        }
        for (std::uint32_t i = 0; i < node.count; ++i)
            for (const Vec3& c : patches[p.tree.items[node.first + i]].corners)
                radius2 = std::max(radius2, (c - centre).squaredNorm());
        p.balls.push_back({centre, std::sqrt(radius2)});
    }
}

/// A ball about patches at the centre pose of a cell of Q.
struct PlacedBall {
    Vec3 centre; ///< in the other mesh's frame
    double move; ///< scene units: how far its points may move against the other mesh in the cell
};

PlacedBall placed(const Pass& p, const CellMotion& motion, const Pose& inverse, const Ball& ball) {
    const double spread = motion.relativeMove() * ball.radius;
    if (p.side == Side::B) {
        const Vec3 x = motion.centrePose() * ball.centre;
        return {x, motion.pointMotion(x).move + spread};
    }
    // Say that x of A meets y of B at some pose of the cell. At the centre pose y is elsewhere, at most f(y)
    // from x, f being how far a point of B moves in the cell. What is known is f(x). As f differs between two
    // points by at most rate times their distance, f(y) <= f(x) + rate * f(y), so f(y) <= f(x) / (1 - rate).
    const double rate = motion.relativeMove();
    const double move = rate < 1 ? (motion.pointMotion(ball.centre).move + spread) / (1 - rate)
                                 : std::numeric_limits<double>::infinity();
    return {inverse * ball.centre, move};
}

/// Marks the patches of one subtree that come near, cell by cell (branch and bound).
class ReachSearch {
public:
    explicit ReachSearch(Pass& pass) : p_(pass) {}
    ~ReachSearch() { p_.tests += tests_; }

    void run(const CellTree& tree, const std::vector<std::uint32_t>& inherited) {
        Cell cell = tree.cell;
        if (!shrinkToPlanes(p_.rates.motion(), cell)) return;
        if (p_.poll.stopped() || tests_ > p_.mostTests) { // what has not been looked at may be near
            for (const std::uint32_t n : inherited) mark(n);
            return;
        }
        const CellMotion motion(p_.rates, cell);
        const Pose inverse = motion.centrePose().inverse();
        std::vector<std::uint32_t> open, stack(inherited.rbegin(), inherited.rend());
        while (!stack.empty()) {
            const std::uint32_t n = stack.back();
            stack.pop_back();
            if (p_.reached[n].load(std::memory_order_relaxed)) continue;
            ++tests_;
            const Ball& ball = p_.balls[n];
            const PlacedBall at = placed(p_, motion, inverse, ball);
            const double within = (ball.radius + at.move + p_.margin) * (1 + 1e-9) + p_.rounding;
            if (std::isfinite(within) && !p_.other.comesWithin(at.centre, within)) continue;
            const Bvh::Node& node = p_.tree.nodes[n];
            if (node.count == 1 && std::isfinite(within) && triangleApart(node, motion, inverse, at))
                continue;
            const bool settled = at.move <= p_.resolution;
            if (node.count == 0 && (settled || ball.radius >= at.move)) {
                stack.push_back(node.first + 1);
                stack.push_back(node.first);
            } else if (settled) {
                mark(n);
            } else {
                open.push_back(n);
            }
        }
        if (open.empty()) return;
        if (!tree.children.empty()) {
            for (const CellTree& child : tree.children) run(child, open);
            return;
        }
        const std::size_t k = widest(motion, p_.balls[open[0]]);
        if (!canSplit(cell, k)) { // undecided in the smallest cell: counts as near
            for (const std::uint32_t n : open) mark(n);
            return;
        }
        const auto [lower, upper] = splitCell(p_.rates, cell, k);
        run({lower, {}}, open);
        run({upper, {}}, open);
    }

private:
    /// Whether the triangle of a leaf stays farther away than the margin all over the cell. First by how far
    /// its points move at most, then along separating axes, which also tells apart what slides past closely.
    bool triangleApart(const Bvh::Node& leaf, const CellMotion& motion, const Pose& inverse,
                       const PlacedBall& at) {
        constexpr std::uint64_t mostLooks = 20'000, looksPerTest = 32;
        if (p_.triangles.empty()) return false;
        const MeshQuery& triangle = p_.triangles[p_.tree.items[leaf.first]];
        const bool inA = p_.side == Side::A;
        const double within = (at.move + p_.margin) * (1 + 1e-9) + p_.rounding;
        if (p_.other.apart(triangle, inA ? inverse : motion.centrePose(), within)) return true;
        std::uint64_t looked = 0;
        const bool apart = trianglesApart(inA ? triangle : p_.other, inA ? p_.other : triangle, motion,
                                          p_.margin * (1 + 1e-9), p_.rounding, mostLooks, looked);
        tests_ += looked / looksPerTest;
        return apart;
    }

    /// Marks a node, and its ancestors as far as both of their children are marked.
    void mark(std::uint32_t n) {
        p_.reached[n].store(1, std::memory_order_relaxed);
        while (n != 0) {
            n = p_.parents[n];
            const Bvh::Node& node = p_.tree.nodes[n];
            if (!p_.reached[node.first].load(std::memory_order_relaxed) ||
                !p_.reached[node.first + 1].load(std::memory_order_relaxed))
                return;
            p_.reached[n].store(1, std::memory_order_relaxed);
        }
    }

    /// The DOF to halve next: the one that moves the points of the ball most.
    std::size_t widest(const CellMotion& motion, const Ball& ball) const {
        const Vec3 x = p_.side == Side::B ? Vec3(motion.centrePose() * ball.centre) : ball.centre;
        auto share = motion.shares(x);
        // The turns move the ball's points about its centre too, which may lie on an axis and have no share
        // itself; and turns so wide that no bound exists for A are halved before anything else.
        const bool unbounded = p_.side == Side::A && motion.relativeMove() >= 1;
        for (std::size_t k = 0; k < motion.dofs(); ++k)
            share[k] = unbounded ? motion.relativeShare(k) : share[k] + motion.relativeShare(k) * ball.radius;
        return static_cast<std::size_t>(std::max_element(share.begin(), share.begin() + motion.dofs()) -
                                        share.begin());
    }

    Pass& p_;
    std::uint64_t tests_ = 0;
};

/// The nodes of the tree some levels down, about `count` of them, to be worked on in parallel.
std::vector<std::uint32_t> topNodes(const Bvh& tree, std::size_t count) {
    std::vector<std::uint32_t> now{0};
    for (bool grown = true; grown && now.size() < count;) {
        grown = false;
        std::vector<std::uint32_t> next;
        for (const std::uint32_t n : now) {
            const Bvh::Node& node = tree.nodes[n];
            if (node.count > 0) {
                next.push_back(n);
                continue;
            }
            next.insert(next.end(), {node.first, node.first + 1});
            grown = true;
        }
        now = std::move(next);
    }
    return now;
}

struct Kept {
    std::vector<Patch> patches;
    std::uint64_t tests = 0;
};

/// What is tested for a patch: the ball about it, or also its triangle.
enum class PatchTest { Ball, Triangle };

/// The patches that come near, without halving them.
Kept reached(std::span<const Patch> patches, Side side, const MeshQuery& other, const MotionRates& rates,
             const CellTree& cells, double resolution, double margin, PatchTest test, std::uint64_t mostTests,
             Poll& poll) {
    if (patches.empty()) return {};
    double own = 0;
    for (const Patch& patch : patches)
        for (const Vec3& c : patch.corners) own = std::max(own, c.norm());
    const double inA = side == Side::A ? own : other.extent(), inB = side == Side::A ? other.extent() : own;
    Pass p{side,   other, rates,     resolution,
           margin, poll,  mostTests, coordinateRounding(rates.motion(), inA, inB)};
    buildTree(p, patches);
    if (test == PatchTest::Triangle)
        for (const Patch& patch : patches)
            p.triangles.emplace_back(TriangleMesh{{patch.corners.begin(), patch.corners.end()}, {{0, 1, 2}}});
    const std::vector<std::uint32_t> nodes = topNodes(p.tree, 64);
    parallelFor(nodes.size(), [&](std::size_t i) { ReachSearch(p).run(cells, {nodes[i]}); });
    std::vector<char> keep(patches.size(), 0);
    for (std::uint32_t n = 0; n < p.tree.nodes.size(); ++n)
        for (std::uint32_t i = 0; i < p.tree.nodes[n].count; ++i)
            keep[p.tree.items[p.tree.nodes[n].first + i]] = p.reached[n];
    Kept kept;
    for (std::size_t i = 0; i < patches.size(); ++i)
        if (keep[i]) kept.patches.push_back(patches[i]);
    kept.tests = p.tests;
    return kept;
}

/// Limits the work, and remembers how small cells of Q may be for that.
struct Effort {
    double tests;       ///< of one pass over the cells, at most, about
    double tooFine = 0; ///< scene units: a resolution that took too many tests
    std::uint64_t ofSubtree() const { return static_cast<std::uint64_t>(tests / 4); }
};

/// The patches that come near, found in passes of finer and finer cells, each over what the pass before left,
/// until `size` or the effort is reached. The number of cells grows with the power of the DOFs; with coarser
/// cells more surface is kept than need be.
std::vector<Patch> reachedInBudget(std::vector<Patch> patches, Side side, const MeshQuery& other,
                                   const MotionRates& rates, const CellTree& cells, double size,
                                   double margin, PatchTest test, Effort& effort, Poll& poll) {
    const double growth = std::pow(2.0, static_cast<double>(rates.motion().dofCount()));
    double resolution = 8 * size;
    while (resolution < std::max(other.extent() / 16, effort.tooFine)) resolution *= 2;
    for (; !patches.empty(); resolution /= 2) {
        Kept kept =
            reached(patches, side, other, rates, cells, resolution, margin, test, effort.ofSubtree(), poll);
        patches = std::move(kept.patches);
        if (resolution <= size / 2 || poll.stopped()) break;
        if (static_cast<double>(kept.tests) * growth > effort.tests) {
            effort.tooFine = resolution;
            break;
        }
    }
    return patches;
}

/// Discards large triangles that stay apart but pass by closely, as the walls of fitted parts do. Balls about
/// them are too large to show it, and patches small enough would be a thousand times as many, so the
/// triangles themselves are tested. Not over more than two DOFs, where cells as small as the clearance are
/// too many.
std::vector<Patch> withoutLargeApart(std::vector<Patch> patches, Side side, const MeshQuery& other,
                                     const MotionRates& rates, const CellTree& cells, double size,
                                     double margin, double share, Poll& poll) {
    constexpr double large = 8;             // times `size`
    constexpr std::ptrdiff_t most = 20'000; // some kilobytes each
    if (rates.motion().dofCount() > 2) return patches;
    const auto rest = std::stable_partition(
        patches.begin(), patches.end(), [&](const Patch& patch) { return patch.radius() > large * size; });
    if (rest == patches.begin() || rest - patches.begin() > most) return patches;
    Effort effort{share * 4e5}; // tests of about ten microseconds each
    std::vector<Patch> near = reachedInBudget({patches.begin(), rest}, side, other, rates, cells, size,
                                              margin, PatchTest::Triangle, effort, poll);
    near.insert(near.end(), rest, patches.end());
    return near;
}

/// Halves a patch down to the radius. False: that makes too many patches.
bool halveTo(const Patch& patch, double radius, std::vector<Patch>& out) {
    constexpr std::size_t most = 8'000'000;
    if (out.size() >= most) return false;
    if (patch.radius() <= radius) {
        out.push_back(patch);
        return true;
    }
    const auto both = halves(patch);
    return halveTo(both[0], radius, out) && halveTo(both[1], radius, out);
}

double largestRadius(std::span<const Patch> patches) {
    double largest = 0;
    for (const Patch& patch : patches) largest = std::max(largest, patch.radius());
    return largest;
}

} // namespace

std::vector<Patch> findNearSurface(std::span<const Patch> patches, Side side, const MeshQuery& other,
                                   const Motion& motion, const CellTree& cells, double size, double margin,
                                   double share, const Progress& progress) {
    const MotionRates rates(motion);
    std::vector<Patch> now(patches.begin(), patches.end());
    Poll poll(progress, "reach");
    Effort effort{share * 4e6}; // tests of about a microsecond each
    // From coarse to fine, so that most of a mesh is discarded in large pieces.
    for (double step = std::max(size, largestRadius(now));; step = std::max(size, step / 4)) {
        std::vector<Patch> fine;
        const bool whole = std::all_of(now.begin(), now.end(),
                                       [&](const Patch& patch) { return halveTo(patch, step, fine); });
        if (!whole) break; // larger patches than asked for keep more of the surface than need be
        now = reachedInBudget(std::move(fine), side, other, rates, cells, step, margin, PatchTest::Ball,
                              effort, poll);
        now = withoutLargeApart(std::move(now), side, other, rates, cells, size, margin, share, poll);
        if (!report(progress, "reach", size / step) || now.empty()) break;
        if (step <= size) break;
    }
    return now;
}

} // namespace tss
