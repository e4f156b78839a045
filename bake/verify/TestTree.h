#pragma once
#include "bake/verify/MeshProof.h"

namespace tss::verify {

/// The tests of a table in a tree of balls about the centres of their spheres, in A and in B: of hundreds of
/// thousands few are looked at for a box.
class TestTree {
public:
    explicit TestTree(const std::vector<MeshTest>& tests); ///< which must outlive it

    struct Found {
        double gap; ///< at the middle of the box
        std::uint32_t test;
        auto operator<=>(const Found&) const = default;
    };
    /// Of the tests whose gap may come to `limit` in the box, up to `most` of the deepest at its middle, the
    /// deepest first; none only where none may. Not always the very deepest: where not all are asked for, the
    /// search ends after `enoughLooks` once it has found one. work: counts what was looked at.
    std::vector<Found> deepest(const PoseBox& box, double limit, std::size_t most, std::uint64_t& work) const;

    /// The least gap of a test at a pose, or one that is no more than `enough`; infinity: there is no test.
    double leastGap(const Pose& pose, double enough, std::uint64_t& work) const;

private:
    struct Node {
        Vec3 centreA, centreB;
        double radiusA = 0, radiusB = 0;    ///< what the centres of its tests lie within
        double contactDistance = 0;         ///< the largest
        double differ = 0;                  ///< the least is smaller by this
        std::uint32_t first = 0, count = 0; ///< a leaf: its part of order_; else count is 0
        std::int32_t lower = -1, upper = -1;
    };
    struct Search;

    std::int32_t root() const { return static_cast<std::int32_t>(nodes_.size()) - 1; }
    std::int32_t join(std::uint32_t from, std::uint32_t to);
    Node around(std::uint32_t from, std::uint32_t to) const;
    std::uint32_t halve(const Node& node, std::uint32_t from, std::uint32_t to);
    template <typename Gap> // of centres and the distance at which they touch: gap, and how it may change
    void visit(std::int32_t node, const Gap& gap, Search& search) const;

    const std::vector<MeshTest>& tests_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace tss::verify
