#pragma once
#include "bake/base/Poll.h"
#include "bake/geometry/PartSet.h"
#include "bake/geometry/Solid.h"
#include "bake/motion/Motion.h"

namespace tss {

/// One of two bodies, looked at for where its surface meets the other.
class ContactSurface {
public:
    /// Both must outlive this. surface: of the mesh alone.
    ContactSurface(const Solid& solid, const MeshQuery& surface);

    const Solid& solid() const { return solid_; }
    const MeshQuery& surface() const { return surface_; }
    const TriangleMesh& mesh() const { return solid_.mesh(); }

    /// The parts of this surface that are inside the other body or within `reach` of its boundary, scene
    /// units. Conservative: what is left out is outside and at least `reach` away, or in `known`; what is
    /// found may be a few times `size` farther away. size: radius below which parts are not halved, scene
    /// units, > 0. toOther: from this body's frame to the other's. Stopped through `poll`, fewer are found.
    std::vector<SurfacePart> meeting(const ContactSurface& other, const Pose& toOther, double reach,
                                     double size, const PartSet& known, Poll& poll) const;

private:
    struct Query;
    struct Centre;
    void visitNode(const Query& query, std::uint32_t node, std::vector<SurfacePart>& found) const;
    void addAll(const Query& query, std::uint32_t node, std::vector<SurfacePart>& found) const;
    void visitPart(const Query& query, SurfacePart part, const Corners& corners, Centre* parent,
                   std::vector<SurfacePart>& found) const;
    bool isInside(const Query& query, Centre& centre) const;
    bool inside(const Vec3& x) const { return bounds_.contains(x) && solid_.inside(x); }

    const Solid& solid_;
    const MeshQuery& surface_;
    Eigen::AlignedBox3d bounds_;
    Bvh tree_; ///< over the triangles
};

/// The connected components of a set of parts: parts that share a corner are connected.
std::vector<std::vector<SurfacePart>> connected(const TriangleMesh& mesh,
                                                const std::vector<SurfacePart>& parts);

} // namespace tss
