// The shapes that are kept are those that would be made anew.
#include "bake/verify/SurfaceTree.h"
#include "tests/Shapes.h"

#include <bit>
#include <catch2/catch.hpp>
#include <random>

using namespace tss;
using namespace tss::verify;

TEST_CASE("a part of a triangle has the shape that halving the triangle gives, however many were asked for") {
    const SurfaceTree tree(ballMesh({1, 2, 3}, 5, 3), {});
    std::vector<std::int32_t> leaves;
    for (std::int32_t k = 0; k < tree.root(); ++k)
        if (tree.nodes[k].first < 0) leaves.push_back(k);
    PieceShapes shapes(tree);
    std::mt19937 random(1);
    std::size_t wrong = 0;
    for (int asked = 0; asked < 40'000; ++asked) { // far more pieces than are kept, neighbours among them
        const std::int32_t node = leaves[random() % 20];
        const std::uint32_t cuts = 1u << (random() % 12);
        const Piece piece{node, cuts + static_cast<std::uint32_t>(random()) % cuts};
        const SurfacePatch& patch = tree.patches[tree.nodes[node].patch];
        Corners corners = patch.corners;
        for (int bit = std::bit_width(piece.cuts) - 2; bit >= 0; --bit)
            corners = halves(corners)[piece.cuts >> bit & 1];
        const Slab slab = slabOf(corners);
        const Shape shape = shapes.of(piece);
        wrong += !shape.corners || *shape.corners != corners || shape.slab.reach != slab.reach ||
                 shape.slab.centre != slab.centre || shape.slab.half != slab.half;
    }
    CHECK(wrong == 0);
    const Shape whole = shapes.of({tree.root(), 1});
    CHECK_FALSE(whole.corners);
    CHECK(whole.slab.reach == tree.nodes.back().slab.reach);
}
