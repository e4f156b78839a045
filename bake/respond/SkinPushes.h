#pragma once
#include "bake/respond/SkinContact.h"

#include <array>
#include <utility>

namespace tss {

/// Sums at few of many places: those that are added to are listed.
template <class T>
class SparseSums {
public:
    SparseSums(std::size_t count, const T& zero) : zero_(zero) { resize(count); }
    void resize(std::size_t count) {
        sums_.resize(count, zero_);
        listed_.resize(count, 0);
    }

    T& operator[](std::uint32_t place) {
        if (!std::exchange(listed_[place], 1)) places_.push_back(place);
        return sums_[place];
    }
    const T& at(std::uint32_t place) const { return sums_[place]; }
    std::vector<std::uint32_t>& places() { return places_; }

    /// Calls visit(place, sum) for those listed, and lists none any more.
    template <class Visit>
    void take(const Visit& visit) {
        for (const std::uint32_t place : places_) {
            listed_[place] = 0;
            visit(place, std::exchange(sums_[place], zero_));
        }
        places_.clear();
    }

private:
    T zero_;
    std::vector<T> sums_;
    std::vector<char> listed_;
    std::vector<std::uint32_t> places_;
};

/// Solves for the contact forces (METHOD 6.5), and displaces the skin by them: pushes p >= 0 along the
/// planes' normals such that no plane is violated once the skin has moved by the columns of the foundation
/// times p. A linear complementarity problem, or quadratic programme with bounds, solved by projected
/// Gauss-Seidel sweeps. Buffers are kept between calls, results are not.
class SkinPushes {
public:
    /// Keeps a reference to the rig.
    explicit SkinPushes(const SkinRig& rig);

    /// Removes all planes.
    void clear();

    /// Solves for the pushes of the planes, starting from those they have. base: skin before any push. The
    /// planes of the last call since clear() come first, and may have changed in normal and level only.
    /// sweeps: most iterations; they end early when no vertex moves any more.
    void solve(std::span<SkinPlane> planes, std::span<const Move> base, int sweeps);

    /// Displaces the skin, as muscles and bones carry it, by the planes' pushes. Returns how many planes have
    /// a push.
    std::size_t apply(std::span<const SkinPlane> planes, SkinScene& scene);

    /// Displacement of a node, as apply() has found it. Where it is set, displace() makes the skin follow.
    const Move& nodeMove(std::uint32_t node) const { return nodes_.at(node); }
    void moveNode(std::uint32_t node, const Move& move) { nodes_[node] = move; }
    void displace(SkinScene& scene);

    /// Moves all vertices that are displaced back to where muscles and bones carry them.
    void undo(SkinScene& scene);

    /// Whether vertices of a block may be displaced, whether a vertex is by more than `settled`, and the
    /// largest displacement.
    bool reaches(std::size_t block) const { return reached_[block] != 0; }
    bool displaced(std::size_t vertex) const { return displaced_[vertex] != 0; }
    float farthest() const { return farthest_; }

private:
    using Four = Eigen::Array4f;
    /// Four columns of a row of the symmetric matrix, without its diagonal. "Coupling" of two planes: by how
    /// much a push of 1 of one would move the other's constrained point along its normal if both normals were
    /// equal.
    struct Block {
        std::uint32_t first = 0; ///< column
        Four coupling = Four::Zero();
        Four matrix = Four::Zero(); ///< coupling times the cosine between both normals
    };
    void addColumns(std::span<const SkinPlane> planes);
    void addCouplings();
    void prepare(std::span<SkinPlane> planes, std::span<const Move> base);
    void addPush(std::size_t r, float change);
    float sweep(std::span<SkinPlane> planes, bool backwards);

    const SkinRig& rig_;
    // Of the planes so far, kept by solve() from call to call until clear().
    Lists<SkinEntry> weights_; ///< per plane: its weights on nodes
    Lists<SkinEntry> column_;  ///< per plane: displacement of nodes by a push of 1
    std::vector<float> self_;  ///< per plane: coupling with itself
    std::vector<std::vector<Block>>
        rows_; ///< per plane, and empty ones: couplings with others, columns rising
    std::vector<std::vector<SkinEntry>> nodePlanes_; ///< per node: planes that constrain it, and its weights

    // Per plane, padded to whole blocks of four.
    std::vector<float> lack_;                   ///< violation with the current pushes (residual)
    std::array<std::vector<float>, 3> normals_; ///< x, y and z

    SparseSums<float> sums_;      ///< over nodes
    SparseSums<float> couplings_; ///< over planes
    SparseSums<Move> nodes_;      ///< displacements of nodes

    std::vector<char> reached_;   ///< #blocks
    std::vector<char> displaced_; ///< #touched
    float farthest_ = 0;          ///< run-time length
};

} // namespace tss
