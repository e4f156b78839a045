#pragma once
#include "bake/respond/SkinContact.h"

#include <array>

namespace tss {

/// Solves for the contact forces (METHOD 6.5): pushes p >= 0 along the planes' normals such that no plane is
/// violated once the skin has moved by the columns of the foundation times p. A linear complementarity
/// problem, or quadratic programme with bounds, solved by projected Gauss-Seidel sweeps. Buffers are kept
/// between calls, results are not.
class SkinPushes {
public:
    explicit SkinPushes(const SkinFoundation& foundation);

    /// Removes all planes.
    void clear();

    /// Solves for the pushes of the planes, starting from those they have. base: skin before any push. The
    /// planes of the last call since clear() come first, and may have changed in normal and level only.
    /// sweeps: most iterations; they end early when no vertex moves any more.
    void solve(std::span<SkinPlane> planes, std::span<const Move> base, int sweeps);

    /// Adds the displacements by the planes' pushes to #touched positions, and marks their blocks. Returns
    /// how many planes have a push.
    std::size_t apply(std::span<const SkinPlane> planes, std::span<Move> places, std::span<char> blocks);

    /// Displacement of a node, as apply() has found or moveNode() has set it.
    Move nodeMove(std::uint32_t node) const {
        return stamp_[node] == round_ ? nodes_[node] : Move(Move::Zero());
    }
    void moveNode(std::uint32_t node, const Move& move);

    /// Adds the displacements of the nodes to #touched positions, and marks their blocks.
    void displace(std::span<Move> places, std::span<char> blocks) const;

private:
    using Four = Eigen::Array4f;
    static constexpr std::uint32_t none = ~0u;
    /// Entry of a linked list, one per node, of the planes that constrain the node.
    struct NodePlane {
        std::uint32_t plane;
        float weight;           ///< of the node in the plane
        std::uint32_t previous; ///< entry in nodePlanes_, or `none`
    };
    void addColumns(std::span<const SkinPlane> planes);
    void addCouplings();
    void prepare(std::span<SkinPlane> planes, std::span<const Move> base);
    void addPush(std::size_t r, float change);
    Four blockAt(const std::vector<float>& values, std::uint32_t first) const {
        return Eigen::Map<const Four>(values.data() + first);
    }
    float sweep(std::span<SkinPlane> planes, bool backwards);

    const SkinFoundation& foundation_;
    // Of the planes so far, kept by solve() from call to call until clear(). "Coupling" of two planes: by how
    // much a push of 1 of one would move the other's constrained point along its normal if both normals were
    // equal.
    Lists<SkinEntry> weights_; ///< per plane: its weights on nodes
    Lists<SkinEntry> column_;  ///< per plane: displacement of nodes by a push of 1
    Lists<SkinEntry> before_;  ///< per plane: coupling with planes of lower index (symmetric)
    std::vector<float> self_;  ///< per plane: coupling with itself
    std::vector<NodePlane> nodePlanes_;
    std::vector<std::uint32_t> lastPlane_; ///< per node: last entry of its list in nodePlanes_, or `none`

    // The off-diagonal rows of the symmetric matrix, in blocks of four columns.
    std::vector<std::uint32_t> rowStart_; ///< #planes + 1, into the next three
    std::vector<Four> coupling_;
    std::vector<Four> matrix_;               ///< coupling times the cosine between both normals
    std::vector<std::uint32_t> firstColumn_; ///< of each block

    // Per plane; those read in blocks are padded to whole blocks of four.
    std::vector<float> demand_;                 ///< violation before any push (right-hand side), padded
    std::vector<float> lack_;                   ///< violation with the current pushes (residual), padded
    std::array<std::vector<float>, 3> normals_; ///< x, y and z, padded

    // Sparse accumulators over nodes and over planes.
    std::vector<float> dense_;
    std::vector<std::uint32_t> touched_, stamp_; ///< nodes touched in this round; per node: its last round
    std::uint32_t round_ = 0;
    std::vector<float> sums_;
    std::vector<char> summed_;
    std::vector<Move> nodes_;          ///< displacements
    std::vector<std::uint32_t> moved_; ///< nodes that are displaced, rising
};

} // namespace tss
