#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/ClosestPointQuery.h"

#include <array>
#include <span>

namespace tss {

/// The volume enclosed by a closed mesh, positive when it is outward oriented.
double enclosedVolume(const std::vector<Vec3>& vertices, const std::vector<Tri>& triangles);

/// The mesh with its openings closed by flat fans: a muscle's volume is what this encloses.
TriangleMesh closed(TriangleMesh mesh);

/// The area of a mesh's openings as a share of its own, each projected where it is largest.
double openShare(const TriangleMesh& mesh);
/// Above this share of openings a muscle's volume is not well defined, and the muscle is refused.
constexpr double mostOpenShare = 0.25;

/// Whether the volume of a mesh, its openings closed, is positive by more than the rounding of a flat one.
bool enclosesVolume(const TriangleMesh& mesh);

/// Six times the volume of a closed mesh whose vertices are places + k swelling, less six times `wanted`: a
/// cubic in k, c[0] + c[1] k + c[2] k^2 + c[3] k^3. Places should lie near the origin, or rounding is large.
std::array<double, 4> swollenVolume(double wanted, std::span<const Vec3> places,
                                    std::span<const Vec3> swelling, const std::vector<Tri>& triangles);

/// The root of such a cubic next to `start`. Where the volume hardly changes with k, by less than a billionth
/// of `wanted`, any k will do: start.
double swellingFor(double wanted, const std::array<double, 4>& cubic, double start);

/// A root that changes continuously with the cubic and stays within [least, most]: that of the cubic modified
/// so that its slope is nowhere less than leastSlope, > 0. Where the slope is no less anyway, the root
/// itself.
double boundedSwelling(const std::array<double, 4>& cubic, double leastSlope, double least, double most);

/// For each vertex of a closed surface the vector from the medial surface to it: the radius of the largest
/// inscribed ball that touches there along the smoothed normal, both smoothed over the surface so that coarse
/// or rough meshes thicken evenly, and not less than by what fills the volume (METHOD 6.1). #V, scene units.
std::vector<Vec3> medialOffsets(const TriangleMesh& mesh, const ClosestPointQuery& locator,
                                const std::vector<Vec3>& normals);

} // namespace tss
