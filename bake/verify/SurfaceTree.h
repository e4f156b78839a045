#pragma once
#include "bake/geometry/SurfacePart.h"

#include <optional>
#include <span>
#include <vector>

namespace tss::verify {

/// A flat piece of space: all points that are no farther than `half` from a plane and, along it, no farther
/// than `radius` from the centre. What patches of a surface lie in.
struct Slab {
    Vec3 centre = Vec3::Zero(), axis = Vec3::UnitX(); ///< the axis is of length 1 to rounding
    double radius = 0, half = 0;
    double reach = 0; ///< no point is farther from the centre

    /// No point of it lies farther in a direction, from the centre, than this times the direction's length.
    double support(const Vec3& direction) const;
    /// No point of it is farther from p.
    double farthest(const Vec3& p) const;
};

/// What holds all three corners, and so all of the triangle.
Slab slabOf(const Corners& corners);

/// A piece of surface: a slab about it, and its corners where it is one triangle.
struct Shape {
    Slab slab;
    std::optional<Corners> corners;

    /// No point of it lies farther in a direction, from the slab's centre, than this times the direction's
    /// length.
    double support(const Vec3& direction) const;
};

/// A triangle of a mesh, or a part of one. exempt: it is of the parts that were named when the tree was made.
struct SurfacePatch {
    Corners corners;
    std::uint32_t triangle = 0;
    bool exempt = false;
};

/// Slabs about slabs, down to the patches of a surface. All triangles count, those without area too.
struct SurfaceTree {
    struct Node {
        Slab slab;
        std::int32_t first = -1, second = -1; ///< children; -1 for a patch
        std::uint32_t patch = 0;
        bool exempt = false; ///< all patches below are
    };
    std::vector<Node> nodes; ///< the root is the last; empty for an empty mesh
    std::vector<SurfacePatch> patches;

    /// parts: those of the surface that are exempt from something. Throws InputError for parts that the mesh
    /// does not have.
    SurfaceTree(const TriangleMesh& mesh, std::span<const SurfacePart> parts);
    std::int32_t root() const { return static_cast<std::int32_t>(nodes.size()) - 1; }

private:
    std::int32_t join(std::vector<std::uint32_t>& order, std::size_t from, std::size_t to);
};

/// A node of a tree, or a part of the triangle of one without children: its longest edge halved again and
/// again (SurfacePart::cuts).
struct Piece {
    std::int32_t node = 0;
    std::uint32_t cuts = 1;

    bool operator==(const Piece&) const = default;
};

struct PiecePair {
    Piece a, b;
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
