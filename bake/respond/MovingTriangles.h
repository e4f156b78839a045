#pragma once
#include "bake/geometry/Bvh.h"
#include "bake/motion/ClosestPointQuery.h"

namespace tss {

/// The triangles of a skin that moves from one sampled state (station) to the next, in a box tree that is
/// refitted at each: finds the triangles that a point comes near to, at a station or on the way to it.
class MovingTriangles {
public:
    explicit MovingTriangles(TriangleMesh rest);

    /// Sets where the vertices are, and where they were at the station before.
    void moveTo(const std::vector<Vec3>& places, const std::vector<Vec3>& before);

    const TriangleMesh& now() const { return now_; }
    const std::vector<Vec3>& rest() const { return rest_; }
    bool changed(std::size_t vertex) const { return now_.vertices[vertex] != rest_[vertex]; }
    /// How far a vertex has come since the station before.
    const Vec3& moveOf(std::size_t vertex) const { return moves_[vertex]; }

    struct Met : NearestPoint {
        double half = 0; ///< half the length of their relative motion since the last station: on the way
                         ///< they may have been nearer by this
    };
    /// Points that are asked about together.
    struct Group {
        Eigen::AlignedBox3d places, facings, moves; ///< moves: empty where the station alone counts
    };
    /// Whether nearest() may find a triangle for some point of a group. Zero is among the facings where it is
    /// asked for triangles that face any way.
    bool mayMeet(const Group& group, double reach, bool onlyChanged) const;

    /// The nearest triangle, of those whose normal n has n . facing > 0 (zero facing: of all) and, with
    /// `onlyChanged`, that are not where they are at rest. It is nearer to x than `reach`, or may have been
    /// on the way on which x came by *move; null: at the station alone.
    Met nearest(const Vec3& x, const Vec3& facing, double reach, bool onlyChanged,
                const Vec3* move = nullptr) const;

private:
    /// Of what is in a node of the tree.
    struct Bounds {
        Eigen::AlignedBox3d places, moves, normals;
        bool changed = false;
        void extend(const Bounds& other);
    };
    Bounds boundsOf(std::uint32_t triangle) const;
    bool hasChanged(std::uint32_t triangle) const;
    /// From a group to what nearest() may find in a node; infinite where that is nothing.
    double squaredDistanceOf(std::uint32_t node, const Group& group, double reach, bool onlyChanged) const;
    double halfOf(std::uint32_t triangle, const Vec3& weights, const Vec3& move) const;

    TriangleMesh now_;
    std::vector<Vec3> rest_, moves_;
    Bvh tree_;                   ///< of the triangles at rest
    std::vector<Bounds> bounds_; ///< of its nodes
};

} // namespace tss
