#pragma once
#include "bake/table/KernelTarget.h"
#include "bake/table/Table.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tss {

/// The tests of a large table by its spheres: those of each body in a tree of bounding spheres, and which of
/// two leaves' spheres are tests (METHOD 5.1). A few thousand spheres stand for hundreds of thousands of
/// tests, and stay in the processor's caches.
class PairTree {
public:
    static constexpr std::uint32_t fan = 8;

    PairTree(const Table& table, KernelTarget target);

    /// Writes the indices of all tests whose gap at a pose (B to A) is at most `margin`, scene units, to
    /// `out`, which has room for all tests; always in the same order. Some with a larger gap are among them:
    /// by what floats may round, or because tests have different rest gaps. Stops once it has found more than
    /// `enough`. Returns how many were written.
    std::uint32_t testsWithin(const Pose& pose, double margin, std::uint32_t enough,
                              std::uint32_t* out) const;

    /// Eight spheres of a body, or the bounding spheres of eight blocks of the level below. An unused place
    /// has a radius of -1e18, so that it touches nothing.
    struct alignas(32) Block {
        float x[fan], y[fan], z[fan], r[fan];
    };
    struct Side {
        Vec3 origin = Vec3::Zero(); ///< that coordinates count from
        double extent = 0;          ///< no sphere reaches farther from it
        /// From one block to the leaves; child c of block k is block fan * k + c of the next level.
        std::vector<std::vector<Block>> levels;
        Block root; ///< whose first sphere bounds the first block
    };
    /// The tests between the spheres of two leaves: at fan * b + a the index of the test of A's sphere a with
    /// B's sphere b, both numbered within their leaves; -1 where the two are no test.
    using LeafTests = std::array<std::int32_t, fan * fan>;

    const Side& a() const { return a_; }
    const Side& b() const { return b_; }
    /// Null where no sphere of these leaves is tested against another.
    const LeafTests* leafTests(std::uint32_t leafA, std::uint32_t leafB) const {
        const std::uint32_t at = leafPairs_[std::size_t(leafA) * b_.levels.back().size() + leafB];
        return at == 0 ? nullptr : &tests_[at - 1];
    }

    /// A question: B to A with coordinates counted from both origins, row-major, and by how much the distance
    /// of two centres may exceed the sum of the radii.
    struct Question {
        float pose[12];
        float reach = 0;
        std::uint32_t enough = 0;
    };
    using Kernel = std::uint32_t (*)(const PairTree& tree, const Question& question, std::uint32_t* out);

private:
    void fillTests(const Table& table, std::span<const std::uint32_t> orderA,
                   std::span<const std::uint32_t> orderB);

    Side a_, b_;
    std::vector<std::uint32_t> leafPairs_; ///< by leaf of A, then of B: 1 + index in `tests_`; 0: no test
    std::vector<LeafTests> tests_;
    double mostRest_ = 0; ///< of the tests' rest gaps
    Kernel ask_ = nullptr;
};

/// How a tree is asked with the instructions of one target.
PairTree::Kernel pairTreeKernel(KernelTarget target);

} // namespace tss
