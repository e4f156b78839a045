#include "bake/search/UndecidedCells.h"

#include "bake/base/Parallel.h"
#include "bake/base/Poll.h"
#include "bake/motion/CellTools.h"
#include "bake/search/NodePairs.h"

#include <algorithm>

namespace tss {

namespace {

enum class Verdict { Contact, Free, Open };

struct UndecidedInput {
    const LevelSpheres &a, &b;
    SphereTree treeA, treeB;
    MotionRates rates;
    UndecidedOptions options;
    double rounding = coordinateRounding(rates.motion(), treeA.extent(), treeB.extent());

    const Motion& motion() const { return rates.motion(); }

    bool excepted(std::uint32_t i, std::uint32_t j) const {
        return !a.region.empty() && !b.region.empty() && a.region[i] && b.region[j];
    }
};

/// Whether the inscribed balls of spheres i and j overlap at every pose of the cell. distance: of their
/// centres at the cell's centre pose. move: how far the centre of B's sphere may move in the cell.
bool overlapEverywhere(const UndecidedInput& p, std::uint32_t i, std::uint32_t j, double distance,
                       double move) {
    const double innerA = p.a.inner[i], innerB = p.b.inner[j];
    // A ball of radius 0 is a point of the surface: inside a ball of the other body it is contact. Two points
    // show nothing.
    return innerA + innerB > 0 && distance + (move + p.rounding) <= innerA + innerB - p.options.depth;
}

/// Descends from the inherited pairs of nodes to those that can touch in the cell. open: receives the pairs
/// that a smaller cell has to decide. largestMove: raised to how far B's nodes of these may move.
Verdict classify(const UndecidedInput& p, const CellMotion& motion, const std::vector<NodePair>& inherited,
                 std::vector<NodePair>& open, double& largestMove) {
    std::vector<NodePair> stack(inherited);
    bool hit = false;
    descend(p.treeA, p.treeB, stack,
            [&](NodePair pair, const SphereTree::Node& na, const SphereTree::Node& nb) {
                if (hit) return false;
                const Vec3 x = motion.centrePose() * nb.centre;
                const double move = motion.pointMotion(x).move, sum = na.radius + nb.radius;
                const double distance = (x - na.centre).norm();
                if (distance - move > sum + p.options.margin + p.rounding) return false;
                const bool leaves = na.leaf() && nb.leaf();
                if (leaves && p.excepted(na.sphere, nb.sphere)) return false;
                hit = leaves && overlapEverywhere(p, na.sphere, nb.sphere, distance, move);
                // Where the motion in the cell exceeds the balls, splitting the balls decides nothing.
                if (!leaves && !(sum < move && move > p.options.resolution)) return true;
                open.push_back(pair);
                largestMove = std::max(largestMove, move);
                return false;
            });
    return hit ? Verdict::Contact : open.empty() ? Verdict::Free : Verdict::Open;
}

class Decider {
public:
    Decider(const UndecidedInput& problem, Poll& poll) : p_(problem), poll_(poll) {}

    /// What is left of the tree, or nothing.
    std::optional<CellTree> decide(const CellTree& tree, const std::vector<NodePair>& inherited) {
        CellTree left{tree.cell, {}};
        if (!shrinkToPlanes(p_.motion(), left.cell)) return std::nullopt;
        if (poll_.stopped()) return tree;
        const CellMotion motion(p_.rates, left.cell);
        std::vector<NodePair> open;
        double move = 0;
        const Verdict verdict = classify(p_, motion, inherited, open, move);
        hits |= verdict == Verdict::Contact;
        if (verdict != Verdict::Open) return std::nullopt;
        const std::size_t k = widestDof(motion, p_.treeB[0].centre, p_.treeB[0].radius);
        if (tree.children.empty() && (move <= p_.options.resolution || !canSplit(left.cell, k))) return left;
        for (const CellTree& part : tree.children.empty() ? halves(left.cell, k) : tree.children)
            if (std::optional<CellTree> kept = decide(part, open)) left.children.push_back(std::move(*kept));
        if (left.children.empty()) return std::nullopt;
        return left;
    }

    bool hits = false;

private:
    std::vector<CellTree> halves(const Cell& cell, std::size_t k) const {
        const auto [lower, upper] = splitCell(p_.rates, cell, k);
        return {CellTree{lower, {}}, CellTree{upper, {}}};
    }

    const UndecidedInput& p_;
    Poll& poll_;
};

/// Subtrees that together make up the tree, about `count` of them, to be worked on in parallel.
std::vector<CellTree> subtrees(const UndecidedInput& p, const CellTree& tree, std::size_t count) {
    std::vector<CellTree> now{tree};
    for (int round = 0; round < 16 && now.size() < count; ++round) {
        std::vector<CellTree> next;
        for (const CellTree& piece : now) {
            if (!piece.children.empty()) {
                next.insert(next.end(), piece.children.begin(), piece.children.end());
                continue;
            }
            const CellMotion motion(p.rates, piece.cell);
            const std::size_t k = widestDof(motion, p.treeB[0].centre, p.treeB[0].radius);
            if (!(piece.cell.upper[k] > piece.cell.lower[k])) {
                next.push_back(piece);
                continue;
            }
            const auto [lower, upper] = splitCell(p.rates, piece.cell, k);
            next.push_back({lower, {}});
            next.push_back({upper, {}});
        }
        if (next.size() == now.size()) break;
        now = std::move(next);
    }
    return now;
}

} // namespace

std::size_t CellTree::leaves() const {
    if (children.empty()) return 1;
    std::size_t count = 0;
    for (const CellTree& child : children) count += child.leaves();
    return count;
}

CellTree wholeQ(const Motion& motion) {
    return {wholeBox(motion), {}};
}

Undecided undecidedCells(const LevelSpheres& a, const LevelSpheres& b, const Motion& motion,
                         const CellTree& from, const UndecidedOptions& options, const Progress& progress) {
    if (a.spheres.empty() || b.spheres.empty()) return {};
    Poll poll(progress, "undecided cells");
    const auto asked = [&] { return poll.stopped(); };
    const UndecidedInput problem{
        a, b, SphereTree(a.spheres, asked), SphereTree(b.spheres, asked), MotionRates(motion), options};
    if (poll.stopped() || !report(progress, "undecided cells", 0)) return {from, false};
    const std::vector<CellTree> pieces = subtrees(problem, from, 64);
    std::vector<std::optional<CellTree>> kept(pieces.size());
    std::vector<char> hits(pieces.size(), 0);
    parallelFor(pieces.size(), [&](std::size_t k) {
        Decider decider(problem, poll);
        kept[k] = decider.decide(pieces[k], {{0, 0}});
        hits[k] = decider.hits;
    });
    Undecided result;
    result.hits = std::count(hits.begin(), hits.end(), 1) > 0;
    CellTree left{from.cell, {}};
    for (std::optional<CellTree>& part : kept)
        if (part) left.children.push_back(std::move(*part));
    if (!left.children.empty()) result.cells = std::move(left);
    return result;
}

} // namespace tss
