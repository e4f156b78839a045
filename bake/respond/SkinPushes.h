#pragma once
#include "bake/respond/SkinContact.h"

#include <array>

namespace tss {

/// The small problem of the contacts that push (METHOD 6.5): pushes p >= 0 along the planes' normals, so that
/// with the moves that they make through the columns of the foundation no plane is broken. Starts from
/// nothing every time: what came before leaves no trace. Keeps its lists between calls.
class SkinPushes {
public:
    explicit SkinPushes(const SkinFoundation& foundation);

    /// Forgets all planes.
    void clear();

    /// Solves for planes of a skin that stands as `base`, starting from their pushes. Planes that were there
    /// at the last call since clear() come first and may have other normals and levels only. deepest: what
    /// any lacks as the skin is carried, which bounds the pushes. sweeps: at most; they end when no place
    /// changes any more.
    void solve(std::span<SkinPlane> planes, std::span<const Move> base, float deepest, int sweeps);

    /// Adds the moves by the planes' pushes to #touched places, and marks the blocks of those. Returns how
    /// many planes push.
    std::size_t apply(std::span<const SkinPlane> planes, std::span<Move> places, std::span<char> blocks);

private:
    using Four = Eigen::Array4f;
    static constexpr std::uint32_t none = ~0u;
    /// A plane that has some of a node, and which has before it.
    struct Owner {
        std::uint32_t plane;
        float value;
        std::uint32_t before;
    };
    /// Free to push more or less.
    bool inside(std::span<const SkinPlane> planes, std::size_t r) const {
        return planes[r].push > 0 && planes[r].push < most_[r];
    }
    void gather(std::span<const SkinPlane> planes);
    void couple();
    void prepare(std::span<SkinPlane> planes, std::span<const Move> base, float deepest);
    void spread(std::size_t r, float change);
    void addRow(std::size_t r, float factor, std::vector<float>& sums) const;
    Four four(const std::vector<float>& values, std::uint32_t first) const {
        return Eigen::Map<const Four>(values.data() + first);
    }
    void setPush(SkinPlane& plane, std::size_t r, float push);
    float sweep(std::span<SkinPlane> planes, bool backwards);
    float energy(std::span<const SkinPlane> planes) const;
    void answer();
    int findStep(std::span<const SkinPlane> planes, int steps);
    void goStep(std::span<SkinPlane> planes);

    const SkinFoundation& foundation_;
    Lists<SkinEntry> own_;    ///< what each plane has of the nodes
    Lists<SkinEntry> column_; ///< how the nodes move when it pushes
    Lists<SkinEntry>
        before_; ///< of each plane those before it that it moves, and how much; the same both ways
    std::vector<std::uint32_t> coupleStart_; ///< one per plane and an end
    std::vector<Four> coupling_, matrix_;    ///< how much nearer to their goal four other planes come by it
    std::vector<std::uint32_t> fours_;       ///< of coupling_: the first of the four
    std::vector<Owner> owners_;
    std::vector<float> sums_;
    std::vector<char> summed_;
    std::vector<float> peak_; ///< of each plane: most that its push moves a node
    std::vector<float> dense_, self_, most_;
    std::vector<float> asked_, lack_; ///< one per plane, up to whole fours
    std::array<std::vector<float>, 3> normals_;
    std::vector<float> step_, way_, left_, answer_; ///< of conjugate gradients
    std::vector<std::uint32_t> seen_, stamp_;
    std::vector<std::uint32_t> lastOwner_; ///< of each node
    std::vector<Move> nodes_;
    std::uint32_t round_ = 0;
};

} // namespace tss
