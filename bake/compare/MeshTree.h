#pragma once
#include "bake/compare/EnclosingTree.h"
#include "bake/compare/Methods.h"
#include "bake/geometry/Solid.h"
#include "bake/geometry/SurfacePart.h"

#include <span>

namespace tss::compare {

// Sphere trees made from a mesh: each node's ball contains the piece of surface below it, but not the balls
// below it. What touches is found all the same, since every ball above a common point contains it.

/// The trees of the two bodies of a pair.
struct BodyTrees {
    EnclosingTree a, b;

    std::size_t bytes() const { return a.bytes() + b.bytes(); }
    std::string leavesText() const; ///< "12 + 34 leaves"
};

/// A method that asks two trees.
std::unique_ptr<CollisionMethod> makeTreeMethod(BodyTrees trees, Description description);

/// A method of two medial sphere trees. how: they are made, in words; remark: what else is to be said.
std::unique_ptr<CollisionMethod>
makeMedialTrees(const ComparedPair& problem, int levels,
                EnclosingTree (*build)(const TriangleMesh&, const Solid&, int), const std::string& name,
                const std::string& how, const std::string& remark = "");

/// The largest protrusion of a leaf from the solid, scene units: a bound.
double leafProtrusion(const EnclosingTree& tree, const Solid& solid);

/// Elements of the surface (triangles, split where they are large), each with the inner medial ball nearest
/// to it: what Hubbard's and Bradshaw and O'Sullivan's trees are made from.
struct MedialSurface {
    std::vector<Corners> elements;
    std::vector<Sphere> balls; ///< inner medial balls, by the Voronoi vertices of the elements' corners
    std::vector<std::uint32_t> ballOf; ///< #elements
    std::vector<std::pair<std::uint32_t, std::uint32_t>>
        neighbours; ///< elements that share an edge or corner
};
/// The distance from a centre to the farthest corner of an element.
double reach(const Vec3& centre, const Corners& element);
MedialSurface medialSurface(const TriangleMesh& mesh, const Solid& solid);

/// The ball about a set of elements that sticks out of the solid least, among those about the medial centres
/// given and the minimal ball of the corners.
Sphere fitBall(const MedialSurface& surface, const Solid& solid, std::span<const std::uint32_t> elements,
               std::span<const Vec3> centres);

} // namespace tss::compare
