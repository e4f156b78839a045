#pragma once
#include "bake/respond/SkinRig.h"

// The steps of makeSkinRig(), each in its own source.
namespace tss::rig {

/// The indices of some points in the order of a curve that fills space (Morton's), so that what is near stays
/// near in memory.
std::vector<std::uint32_t> alongCurve(const std::vector<Vec3>& points);

/// Neighbours of each vertex of a mesh, rising, and those of them along open or non-manifold edges.
struct Rings {
    std::vector<std::vector<std::uint32_t>> ring, rim;
};
Rings rings(const TriangleMesh& mesh);

/// A skin vertex that a muscle carries.
struct Carried {
    std::uint32_t vertex = 0; ///< of the skin mesh
    MusclePoint point;        ///< as the muscle carries it
    double pull = 0;          ///< share of the muscle's move that the vertex makes; all muscles together < 1
    double contracted = 0;    ///< how far the muscle's contraction would ever move it, scene units
};

/// What each muscle carries of a skin: firmly what it is attached to and what is grown into it, weakly what
/// lies over it. The pull falls off so slowly that the skin between two vertices is not stretched much,
/// whatever the mesh. thickness: of the skin.
std::vector<std::vector<Carried>>
carriedSkin(const TriangleMesh& skin, const std::vector<Vec3>& normals, const Rings& rings,
            const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles,
            const SkinParameters& parameters, double thickness);

/// Distance along the edges from the nearest source, infinity beyond `limit`.
std::vector<double> edgeDistances(const TriangleMesh& skin, const Rings& rings,
                                  const std::vector<std::uint32_t>& sources, double limit);

/// Fills edges, bends and ring of the sheet of the touched vertices. Its inverse masses are there already.
void addSheet(SkinRig& rig, const Rings& rings, const std::vector<std::uint32_t>& indexOf);

/// The part of the sheet within a distance, along the skin, of some touched vertices.
SheetPatch patchAround(const SkinRig& rig, const TriangleMesh& skin, const Rings& rings,
                       const std::vector<std::uint32_t>& touched, double reach);

/// Solves the drag of a muscle for its nodes on a patch of the sheet around what it carries.
void addDrag(const SkinRig& rig, const SheetPatch& patch, SkinMuscle& muscle);

/// Follows each row over the nodes of its muscle's drag, from activation 0 outwards, over the muscle's
/// surface.
void addRowTriangles(SkinRig& rig, std::uint32_t muscle, double reach);

/// The muscle vertices that could poke through the skin, and where under it they are at each node.
void addPokes(SkinRig& rig, std::uint32_t muscle, double radius, double reach);

/// The vertices that may meet another part of the skin, and where: found at rest, at both ends of each muscle
/// and along the swings of the bones. radius: of the skin; reach: how far a vertex is seen from.
void addFolds(SkinRig& rig, double radius, double reach);

} // namespace tss::rig
