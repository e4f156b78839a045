#pragma once
#include "bake/bind/SkinAttachment.h"
#include "bake/bind/SkinCut.h"

namespace tss {

/// Influences that swings of a joint move together.
struct MovedGroup {
    std::vector<char> moved; ///< #influences
    std::vector<Pose> ends;  ///< where the swings end: motions since rest, in the skin's frame
};

/// Which skin moves in each swing of a joint: the inside of a minimum cut between the seeds of the influences
/// that the swing moves and those of the others. A cut costs, per length, how far the swing moves the skin
/// there: what is torn apart. So a limb is separated from its body around its joint, even where large parts
/// of either have no bones.
class SkinSides {
public:
    SkinSides(const SkinAnatomy& anatomy, const std::vector<SkinInfluence>& influences,
              const std::vector<MovedGroup>& groups);

    /// The influences that a part of the skin may be attached to, the nearest along the skin first: to cut it
    /// off from all others costs next to nothing. Empty if there are no swings.
    std::vector<std::size_t> ownersOf(const std::vector<std::uint32_t>& part) const;

    /// Assigns to each influence its certain vertices: those farther from every cut than the cut there is
    /// from the seeds.
    void assignCertain(std::vector<SkinInfluence>& influences) const;

private:
    struct Swing {
        std::vector<char> moved;     ///< #influences
        std::vector<double> price;   ///< #V: how far it moves a place of the skin, scene units
        std::vector<double> far;     ///< #V: distance along the skin to the farther group of seeds
        std::vector<SkinSide> fixed; ///< #V: sides of the seeds, Either for all others
    };
    using Sides = std::vector<std::vector<SkinSide>>; ///< #swings of #V

    Sides sidesOf(const std::vector<SkinInfluence>& influences) const;
    std::vector<std::size_t> fitting(const std::vector<SkinSide>& sides, std::uint32_t v) const;

    const SkinAnatomy& anatomy_;
    std::vector<std::vector<double>> along_; ///< #influences of #V: distance along the skin to its seeds
    std::vector<char> seeded_;               ///< #influences: it has seeds
    std::vector<Swing> swings_;              ///< those with seeds on both sides
};

} // namespace tss
