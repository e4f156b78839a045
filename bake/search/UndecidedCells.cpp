#include "bake/search/UndecidedCells.h"

#include "bake/base/Parallel.h"
#include "bake/base/Poll.h"
#include "bake/motion/CellTools.h"
#include "bake/search/NodePairs.h"

#include <algorithm>

namespace tss {

namespace {

enum class Verdict { Hit, Free, Open };

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

/// Whether the pair of inscribed spheres fires for certain all over the cell.
bool firesEverywhere(const UndecidedInput& p, std::uint32_t i, std::uint32_t j, double distance,
                     double move) {
    move += p.rounding;
    const double inA = p.a.inner[i], inB = p.b.inner[j];
    // One of them may be a point of a surface, which the other body then has inside; two points say nothing.
    return inA + inB > 0 && distance + move <= inA + inB - p.options.depth;
}

/// Sorts out the pairs that can touch in the cell from those inherited.
Verdict judge(const UndecidedInput& p, const CellMotion& motion, const std::vector<NodePair>& inherited,
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
                hit = leaves && firesEverywhere(p, na.sphere, nb.sphere, distance, move);
                // Smaller balls do not help where the motion is what blurs the answer.
                if (!leaves && !(sum < move && move > p.options.resolution)) return true;
                open.push_back(pair);
                largestMove = std::max(largestMove, move);
                return false;
            });
    return hit ? Verdict::Hit : open.empty() ? Verdict::Free : Verdict::Open;
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
        const Verdict verdict = judge(p_, motion, inherited, open, move);
        hits |= verdict == Verdict::Hit;
        if (verdict != Verdict::Open) return std::nullopt;
        const std::size_t k = widestDof(motion, p_.treeB[0].centre, p_.treeB[0].radius);
        if (tree.parts.empty() && (move <= p_.options.resolution || !canSplit(left.cell, k))) return left;
        for (const CellTree& part : tree.parts.empty() ? halves(left.cell, k) : tree.parts)
            if (std::optional<CellTree> kept = decide(part, open)) left.parts.push_back(std::move(*kept));
        if (left.parts.empty()) return std::nullopt;
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

/// The tree cut into about `count` parts of it, each of its own.
std::vector<CellTree> pieces(const UndecidedInput& p, const CellTree& tree, std::size_t count) {
    std::vector<CellTree> now{tree};
    for (int round = 0; round < 16 && now.size() < count; ++round) {
        std::vector<CellTree> next;
        for (const CellTree& piece : now) {
            if (!piece.parts.empty()) {
                next.insert(next.end(), piece.parts.begin(), piece.parts.end());
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
    if (parts.empty()) return 1;
    std::size_t count = 0;
    for (const CellTree& part : parts) count += part.leaves();
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
    const std::vector<CellTree> parts = pieces(problem, from, 64);
    std::vector<std::optional<CellTree>> kept(parts.size());
    std::vector<char> hits(parts.size(), 0);
    parallelFor(parts.size(), [&](std::size_t k) {
        Decider decider(problem, poll);
        kept[k] = decider.decide(parts[k], {{0, 0}});
        hits[k] = decider.hits;
    });
    Undecided result;
    result.hits = std::count(hits.begin(), hits.end(), 1) > 0;
    CellTree left{from.cell, {}};
    for (std::optional<CellTree>& part : kept)
        if (part) left.parts.push_back(std::move(*part));
    if (!left.parts.empty()) result.cells = std::move(left);
    return result;
}

} // namespace tss
