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

    /// The parts of this surface that are inside the other body or within `reach` of its boundary, some a few
    /// `size` farther; what is left out is outside and at least `reach` away. Parts of `known` are left out
    /// too. size: radius below which parts are not cut further, > 0. toOther: from this body's frame.
    /// Stopped, fewer are found.
    std::vector<SurfacePart> meeting(const ContactSurface& other, const Pose& toOther, double reach,
                                     double size, const PartSet& known, Poll& poll) const;

private:
    struct Probe;
    struct Cut;
    void visit(const Probe& probe, std::uint32_t node, std::vector<SurfacePart>& found) const;
    void addAll(const Probe& probe, std::uint32_t node, std::vector<SurfacePart>& found) const;
    void visit(const Probe& probe, SurfacePart part, const Corners& corners, Cut* whole,
               std::vector<SurfacePart>& found) const;
    bool isInside(const Probe& probe, Cut& cut) const;
    bool inside(const Vec3& x) const { return bounds_.contains(x) && solid_.inside(x); }

    const Solid& solid_;
    const MeshQuery& surface_;
    Eigen::AlignedBox3d bounds_;
    Bvh tree_; ///< over the triangles
};

/// Parts sorted into sets that hang together: parts that share a corner do.
std::vector<std::vector<SurfacePart>> connected(const TriangleMesh& mesh,
                                                const std::vector<SurfacePart>& parts);

} // namespace tss
