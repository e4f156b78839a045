#pragma once
#include "bake/geometry/MeshQuery.h"
#include "bake/geometry/SurfacePart.h"
#include "bake/motion/MotionBound.h"

namespace tss {

/// A surface that is looked at node by node and triangle by triangle.
class TriangleTree {
public:
    explicit TriangleTree(const TriangleMesh& mesh);

    const MeshQuery& query() const { return query_; }
    bool empty() const { return query_.bvh().empty(); }
    const std::vector<Bvh::Node>& nodes() const { return query_.bvh().nodes; }
    /// About query().centre(), as the nodes are; in the order of their items.
    const Corners& triangle(std::uint32_t item) const { return triangles_[item]; }

private:
    MeshQuery query_;
    std::vector<Corners> triangles_;
};

/// Whether any two triangles of A and B stay farther apart than `distance` all over the cell. Two are told
/// apart along one direction: B's corners move along it by no more than the slope there says and what second
/// order adds, so that surfaces which slide past each other may be as near as they like. false: not shown.
/// rounding: see coordinateRounding(). looked: counts pairs of nodes and triangles; beyond `most` it gives
/// up.
bool trianglesApart(const TriangleTree& a, const TriangleTree& b, const CellMotion& motion, double distance,
                    double rounding, std::uint64_t most, std::uint64_t& looked);

} // namespace tss
