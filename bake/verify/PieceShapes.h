#pragma once
#include "bake/verify/SurfaceTree.h"

#include <vector>

namespace tss::verify {

/// A node of a tree, or a part of the triangle of one without children: its longest edge halved again and
/// again (SurfacePart::cuts).
struct Piece {
    std::int32_t node = 0;
    std::uint32_t cuts = 1;

    bool operator==(const Piece&) const = default;
};

/// One of the two halves of a piece that is divisible().
Piece half(const SurfaceTree& tree, Piece piece, std::uint32_t side);
bool divisible(const SurfaceTree& tree, Piece piece);

/// The shapes of the pieces of a surface. Those of parts of triangles that were asked for last are kept: most
/// are asked for many times, in boxes next to each other and for their own halves, and cutting a triangle
/// down to one takes as long as all else that is done with it. For one thread; what it says depends on
/// nothing else.
class PieceShapes {
public:
    explicit PieceShapes(const SurfaceTree& tree) : tree_(tree), kept_(count) {}

    Shape of(Piece piece);

private:
    static constexpr std::size_t count = 4096; ///< a power of two; 700 kB
    struct Kept {
        Piece piece{-1, 0};
        Shape shape;
    };

    const SurfaceTree& tree_;
    std::vector<Kept> kept_;
};

} // namespace tss::verify
