#pragma once
#include "bake/base/Progress.h"
#include "bake/table/Table.h"
#include "bake/verify/RegionProof.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tss {

/// What came out of proving a table, or a proof that two bodies never collide, against the meshes themselves.
struct MeshVerdict {
    std::string reason;       ///< what does not hold, in words; empty: all that is claimed holds
    std::vector<double> pose; ///< DOF values that break it, or at which it could not be told; may be empty
    bool miss = false;        ///< shown: no contact of the meshes is missed beyond the stored bound
    bool early = false;       ///< shown: contact is reported only when the meshes are as near as stated
    std::optional<double>
        earlyBound;        ///< how near they are, as far as the meshes show it; none: not asked for
    bool fillings = false; ///< what is behind openings of a mesh counts as body in that
    verify::ExemptShare exempt;
    double farthestExempt = 0; ///< no connected piece of that is farther from the other body at rest
    double band = 0;           ///< rounding granted to lengths, scene units
    std::uint64_t cells = 0;   ///< boxes of Q looked at
    std::uint64_t work = 0;    ///< comparisons of patches
    bool holds() const { return reason.empty(); }
};

/// Proves what a certified table says of the meshes, from both alone, with code that nothing else uses
/// (METHOD 3.6): for every q of Q, that is not empty,
/// - wherever the surfaces have a common point, the exempt parts between each other excepted, the gap of some
///   test, counted from its threshold, is at most boundMiss (not asked where that is not known);
/// - wherever a test fires the surfaces are at most boundEarly apart (not asked where that is not known);
/// and that what is exempt is where the meshes meet at rest; and that nothing stored contradicts its record
/// (StickingOut.h): protrusions are shown for the stored spheres. What the record says of spheres that are
/// not stored, and the method, are not read. All triangles of the meshes count, those without area as
/// segments and points. Deterministic. work: give up after about so many comparisons of patches; 0: never.
MeshVerdict verifyOnMeshes(const TriangleMesh& a, const TriangleMesh& b, const Table& table,
                           const Motion& motion, std::uint64_t work = 0, const Progress& progress = {});

/// The same for a proof that the bodies never collide: Q is not empty, rest is in it, the stored clearance is
/// positive, and the surfaces stay as far apart at every pose, what is exempt excepted.
MeshVerdict verifyOnMeshes(const TriangleMesh& a, const TriangleMesh& b, const NeverCollides& proof,
                           const Motion& motion, std::uint64_t work = 0, const Progress& progress = {});

} // namespace tss
