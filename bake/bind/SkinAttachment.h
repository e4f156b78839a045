#pragma once
#include "bake/bind/SkinParameters.h"
#include "bake/bind/SkinShares.h"
#include "bake/motion/ClosestPointQuery.h"
#include "bake/motion/MuscleDeformer.h"

#include <memory>

namespace tss {

/// A skin with the bones and muscles under it, and what all steps of makeSkinRig() need to know of their
/// geometry.
struct SkinAnatomy {
    SkinAnatomy(const TriangleMesh& mesh, const std::vector<std::shared_ptr<const MuscleDeformer>>& under,
                const SkinParameters& parameters);

    /// #V: the first vertex at the same position: texture seams duplicate vertices.
    std::vector<std::uint32_t> first;
    TriangleMesh skin; ///< the mesh, its triangles on first vertices only, wound outwards
    const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies;
    SkinGraph graph;
    std::vector<Vec3> normals;
    std::vector<ClosestPointQuery> locators;       ///< one per body
    bool inverted = false;                         ///< the mesh as given is wound inwards, towards the bodies
    std::vector<std::vector<Vec3>> surfaceNormals; ///< per body: vertex normals
    /// Per body #V: the vertex is inside of it at rest.
    std::vector<std::vector<bool>> inside;
    Vec3 centre = Vec3::Zero(); ///< of the bounds of the skin's triangles
    double size = 0;            ///< diagonal of these bounds, scene units; 1 where it is 0
    /// Length over which deformation of the skin dies away, scene units: l of the foundation.
    double length = 0;
};

/// What each vertex of a skin follows before any contact.
struct SkinAttachment {
    std::vector<std::vector<double>> frames; ///< #frames of #V: skinning weights
    /// #bodies of #V: share of the muscle's displacement; empty: a bone.
    std::vector<std::vector<double>> muscles;
    /// #bodies of #V: the point of the muscle that a vertex with a share is bound to.
    std::vector<std::vector<NearestPoint>> bindings;
    std::vector<double> firmness; ///< #V, >= 1: factor on the foundation's stiffness
};

/// The frame of each body, see SkinParameters::frames.
std::vector<int> framesOf(const SkinAnatomy& anatomy, const SkinParameters& parameters);

/// The motions of so many frames where swings end: ShareOptions::motions.
std::vector<std::vector<DualPose>> endMotions(const SkinParameters& parameters,
                                              const std::vector<int>& frames, std::size_t count);

/// Which bones and muscles each vertex of a skin follows, and by how much (METHOD 6.3, 6.4): skinInfluences()
/// finds the vertices that are certainly a bone's, claimedShares() the shares of all others. Shares that the
/// parameters give are taken as they are; tethered vertices keep the rest of their shares at rest.
SkinAttachment attachSkin(const SkinAnatomy& anatomy, const SkinParameters& parameters);

/// The influences on a skin (METHOD 6.3), one per frame and, where needed, one more that never moves. Of
/// each: every vertex's distance from the bones of the frame (its muscles, if it has no bones), and the
/// vertices that certainly belong to it, see SkinSides.
///
/// A connected part of the skin that is far from every bone, or hidden from all of them, belongs to bones
/// that are not given, unless it is a hollow such as a mouth. Where some bone never moves, the first of these
/// that applies says what the part follows:
///   1. a trunk on both sides of a row of vertebrae is divided among them;
///   2. the one influence that it is attached to alone;
///   3. the moving bone that it continues, as a hand continues a forearm;
///   4. a bone that never moves, as a trunk beside an arm does.
/// Where all bones move, the part stays at rest, unless it is the smaller end of one bone.
std::vector<SkinInfluence> skinInfluences(const SkinAnatomy& anatomy, const SkinParameters& parameters,
                                          const std::vector<int>& frames);

} // namespace tss
