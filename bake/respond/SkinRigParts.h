#pragma once
#include "bake/respond/SkinRig.h"

// The steps of makeSkinRig(), each in its own source.
namespace tss::rig {

/// Neighbours of each vertex of a mesh, rising; rim[v]: v lies on an open or non-manifold edge.
struct Rings {
    std::vector<std::vector<std::uint32_t>> ring;
    std::vector<bool> rim;
};
Rings rings(const TriangleMesh& mesh);

/// What one skin vertex has to do with one muscle.
struct Closeness {
    std::uint32_t vertex = 0; ///< of the skin mesh
    MusclePoint point;        ///< as the muscle carries it
    double close = 0;         ///< 1 right above the muscle, falling smoothly to 0
    double attach = 0;        ///< 1 where the muscle is attached to the skin, falling smoothly to 0
};

/// The vertices of a skin that a muscle carries. reach: height at which it lets go.
std::vector<Closeness> closeness(const TriangleMesh& skin, const std::vector<Vec3>& normals,
                                 const MuscleDeformer& muscle, double reach);

/// Distance along the edges from the nearest source, infinity beyond `limit`.
std::vector<double> edgeDistances(const TriangleMesh& skin, const Rings& rings,
                                  const std::vector<std::uint32_t>& sources, double limit);

/// Fills edges, bends and ring of the sheet of the touched vertices. Its inverse masses are there already.
void addSheet(SkinRig& rig, const Rings& rings, const std::vector<std::uint32_t>& indexOf);

/// Solves the drag of each muscle for its nodes.
void addDrag(SkinRig& rig, const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles);

/// The triangles behind each sphere: those that reach into it; a triangle that reaches into none goes to the
/// nearest one.
void addBehind(SkinMuscle& muscle, const TriangleMesh& surface, const SphereSet& spheres);

/// The muscle vertices that could poke through the skin, and where under it they are at each node.
void addPokes(SkinRig& rig, const MuscleDeformer& muscle, std::uint32_t index, double radius, double reach);

/// Fills rig.across.
void addAcross(SkinRig& rig);

} // namespace tss::rig
