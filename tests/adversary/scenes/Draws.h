#pragma once
#include "tests/adversary/scenes/Bodies.h"
#include "tests/adversary/scenes/Scene.h"
#include "tests/extreme/scenes/Builders.h"

#include <numbers>

/// What the kinds share, and the kinds themselves.
namespace adversary {

using extreme::joined;
using joints::slide;
using joints::turn;
using tss::Dof;
using tss::Motion;

constexpr double pi = std::numbers::pi;

/// About a unit in radius: lumpy, box, ball or spiked.
TriangleMesh anyBody(Random& random);

/// B beside A so that their bounding balls are `clearance` apart (< 0: overlap); returns the way from A to B.
Vec3 putBeside(Random& random, const TriangleMesh& a, TriangleMesh& b, double clearance);

/// The least distance of the surfaces of two small meshes.
double apartBy(const TriangleMesh& a, const TriangleMesh& b);

/// B moved along `way` (of unit length) until the surfaces are `clearance` apart, from outside; < 0: by so
/// much beyond touching.
void bringTogether(const TriangleMesh& a, TriangleMesh& b, const Vec3& way, double clearance);

/// A hinge beside two bodies that stand along `way` from one another: it swings B at A and past it.
Dof hingePast(Random& random, const Vec3& way, double reach);

/// Draws the settings that any scene may have; lengths are of the draft before scaling.
void anySettings(Random& random, Draft& draft);

// Named by what is nasty in them.
Draft bumps(std::uint64_t seed);
Draft needles(std::uint64_t seed);
Draft slivers(std::uint64_t seed);
Draft nested(std::uint64_t seed);
Draft wires(std::uint64_t seed);
Draft openMeshes(std::uint64_t seed);
Draft overlaps(std::uint64_t seed);
Draft touching(std::uint64_t seed);
Draft plates(std::uint64_t seed);
Draft components(std::uint64_t seed);
Draft cracks(std::uint64_t seed);
Draft sockets(std::uint64_t seed);

Draft farAxes(std::uint64_t seed);
Draft farBodies(std::uint64_t seed);
Draft tinyRanges(std::uint64_t seed);
Draft fullTurns(std::uint64_t seed);
Draft corneredPaths(std::uint64_t seed);
Draft planes(std::uint64_t seed);
Draft chains(std::uint64_t seed);
Draft units(std::uint64_t seed);
Draft fixed(std::uint64_t seed);

} // namespace adversary
