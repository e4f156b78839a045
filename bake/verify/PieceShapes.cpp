#include "bake/verify/PieceShapes.h"

#include <bit>

namespace tss::verify {

Piece half(const SurfaceTree& tree, Piece piece, std::uint32_t side) {
    const SurfaceTree::Node& node = tree.nodes[static_cast<std::size_t>(piece.node)];
    if (node.first >= 0) return {side ? node.second : node.first, 1};
    return {piece.node, piece.cuts << 1 | side};
}

bool divisible(const SurfaceTree& tree, Piece piece) {
    return tree.nodes[static_cast<std::size_t>(piece.node)].first >= 0 ||
           std::bit_width(piece.cuts) < mostCuts;
}

Shape PieceShapes::of(Piece piece) {
    const SurfaceTree::Node& node = tree_.nodes[static_cast<std::size_t>(piece.node)];
    if (node.first >= 0) return {node.slab, {}};
    if (piece.cuts == 1) return {node.slab, tree_.patches[node.patch].corners};
    const std::uint32_t mixed = static_cast<std::uint32_t>(piece.node) * 0x9E3779B1u + piece.cuts;
    Kept& kept = kept_[(mixed ^ mixed >> 16) % count];
    if (kept.piece == piece) return kept.shape;
    const Corners corners = halves(*of({piece.node, piece.cuts >> 1}).corners)[piece.cuts & 1];
    kept = {piece, {slabOf(corners), corners}};
    return kept.shape;
}

} // namespace tss::verify
