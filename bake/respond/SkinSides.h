#pragma once
#include "bake/respond/SkinCarry.h"
#include "bake/respond/SkinCut.h"

#include <optional>

namespace tss {

/// Which skin goes along in each swing of a joint: that inside of the cut that parts the skin most easily
/// between what the bones that it moves hold beyond doubt and what the others do, where a cut costs as much
/// as it is far from the farther one of the two. So a limb is parted from its body around its root, however
/// much of either no bone is named for.
class SkinSides {
public:
    /// moved: #swings of #holders.
    SkinSides(const SkinGround& ground, const std::vector<SkinHolder>& holders,
              const std::vector<std::vector<char>>& moved);

    /// What a part hangs on alone: to part it from all others costs next to nothing.
    std::optional<std::size_t> ownerOf(const std::vector<std::uint32_t>& part) const;

    /// Gives each holder what is its own for certain: beyond every cut by more than the cut there is from
    /// what it parts.
    void hold(std::vector<SkinHolder>& holders) const;

private:
    struct Swing {
        std::vector<char> moved;         ///< #holders
        std::vector<double> price;       ///< #V: the distance along the skin to the farther one
        std::vector<SkinSide> undoubted; ///< #V
    };
    using Sides = std::vector<std::vector<SkinSide>>; ///< #swings of #V

    Sides sidesOf(const std::vector<SkinHolder>& holders) const;
    std::optional<std::size_t> holderOf(const std::vector<SkinSide>& sides, std::uint32_t v) const;

    const SkinGround& ground_;
    std::vector<std::vector<double>> along_; ///< #holders of #V: distance to its seeds
    std::vector<char> seeded_;               ///< #holders
    std::vector<Swing> swings_;              ///< those that have seeds on both sides
};

} // namespace tss
