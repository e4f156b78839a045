#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Motion.h"
#include "bake/spheres/SphereSet.h"
#include "bake/table/Table.h"
#include "bake/verify/PoseBox.h"
#include "bake/verify/RegionProof.h"
#include "bake/verify/SurfaceTree.h"

#include <cstdint>
#include <optional>
#include <string>

namespace tss::verify {

/// A test of a table: where its spheres stand in their bodies, and the distance of centres at which it
/// reports contact, its threshold counted.
struct MeshTest {
    Vec3 centreA = Vec3::Zero(), centreB = Vec3::Zero();
    double contactDistance = 0;
    double threshold = 0;                   ///< what that is more than the sum of radii
    std::uint32_t sphereA = 0, sphereB = 0; ///< in the table: the same number is the same sphere
    double radiusA = 0, radiusB = 0;
};
std::vector<MeshTest> meshTests(const Table& table);

/// Wherever the two surfaces come as near as `near`, pairs of exempt patches excepted, the gap of some test
/// is at most `miss`.
struct MeshClaim {
    std::vector<MeshTest> tests;
    double miss = 0, near = 0;
    double band = 0;        ///< granted to `miss` (to `near`, where there are no tests) for rounding
    std::uint64_t work = 0; ///< give up after about so many comparisons of patches; 0: never
};

struct MeshProofResult {
    bool proven = false;
    std::string reason;       ///< why not; empty when proven
    std::vector<double> pose; ///< that breaks the claim, or where it could not be told; may be empty
    std::uint64_t cells = 0;  ///< boxes of Q looked at
    std::uint64_t work = 0;   ///< comparisons of patches
};

/// Proves the claim for every pose of the motion's limits from the surfaces themselves, by branch and bound
/// over boxes of Q and pairs of patches, or finds a pose that breaks it. `size`: no coordinate on the way
/// from B to A is larger. Rounding is bounded and counts against the claim. Deterministic.
MeshProofResult proveMeshClaim(const SurfaceTree& a, const SurfaceTree& b, const Motion& motion, double size,
                               const MeshClaim& claim, const Progress& progress);

/// Whether some plane whose normal is the axis of a turn keeps the two bodies more than `clearance` (scene
/// units) apart at every pose of the limits: what moves B along that normal is bounded DOF by DOF, in
/// extended precision. false: not shown.
bool apartAcrossAxis(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion, double clearance);

/// Where a sphere of A contains a piece of its surface, one of B another, and the two are a test, that test
/// fires wherever the pieces meet: at every pose, with nothing to be known of the motion. Of a table that
/// asks nearly all pairs of its spheres these are nearly all pairs of pieces. Returns the pairs that are left
/// to be shown, which together with those are all of both surfaces; nothing where they are too many to list.
std::optional<std::vector<PiecePair>> pairsNotHeld(const SurfaceTree& a, const SurfaceTree& b,
                                                   const MeshClaim& claim);

} // namespace tss::verify
