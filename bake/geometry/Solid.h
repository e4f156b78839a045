#pragma once
#include "bake/geometry/MeshQuery.h"

#include <string>

namespace tss {

/// What an open mesh stands for.
enum class Interior {
    Filled, ///< the body behind it, as far as closing fans over its openings
    Hollow, ///< nothing but its surface: a cup, a bent sheet, the shell of a housing
};

/// The body that a mesh bounds: all points whose winding number about the mesh and its closing fans is not 0,
/// and the surface itself. Several closed components count as their union, cavities stay cavities.
/// A hollow one is its surface alone, and nothing is inside.
/// Its boundary lies on the triangles and the fans, so that for every point p inside, the ball about p of
/// radius distance(p) is inside: this is what the protrusion of spheres is proven with.
class Solid {
public:
    /// Throws InputError as checkIndices() does.
    explicit Solid(const TriangleMesh& mesh, Interior interior = Interior::Filled);

    /// The mesh alone, without fans.
    const TriangleMesh& mesh() const { return mesh_; }

    /// Triangles and fans together; of a hollow one the triangles.
    const MeshQuery& boundary() const { return boundary_; }

    bool inside(const Vec3& p) const { return !hollow_ && boundary_.inside(p); }

    /// The mesh has openings, cracks too.
    bool open() const { return open_; }
    bool hollow() const { return hollow_; }

    /// A bound on how far a point of the ball lies from the solid, >= 0; 0 for a ball that is inside.
    double protrusion(const Vec3& centre, double radius) const;

    /// Bounding diagonal of the mesh, scene units.
    double diagonal() const { return diagonal_; }

    /// What was taken for granted about an imperfect mesh, for people; empty for a closed one.
    const std::string& assumptions() const { return assumptions_; }

private:
    TriangleMesh mesh_;
    bool hollow_ = false;
    bool open_ = false;
    MeshQuery boundary_;
    double diagonal_ = 0;
    std::string assumptions_;
};

} // namespace tss
