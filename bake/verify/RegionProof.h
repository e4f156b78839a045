#pragma once
#include "bake/geometry/Solid.h"
#include "bake/motion/Motion.h"
#include "bake/table/Table.h"

#include <optional>
#include <string>

namespace tss::verify {

/// One body of a pair as the verifier takes it, from its mesh alone.
struct VerifiedBody {
    const TriangleMesh& mesh;
    MeshQuery surface;          ///< all triangles, those without area too
    std::optional<Solid> solid; ///< openings filled; nothing for a mesh of segments and points

    /// Throws InputError for a mesh that cannot be used. `mesh` must outlive it.
    explicit VerifiedBody(const TriangleMesh& mesh);
    VerifiedBody(const VerifiedBody&) = delete;
    VerifiedBody& operator=(const VerifiedBody&) = delete;
};

/// What a region at rest leaves out of what is proven.
struct ExemptShare {
    double areaA = 0, areaB = 0;   ///< scene units squared
    double shareA = 0, shareB = 0; ///< of the whole surface, 0 to 1
};
ExemptShare exemptShare(const TriangleMesh& a, const TriangleMesh& b, const RestRegion& region);

/// What came out of looking at a region.
struct RegionVerdict {
    std::string reason;  ///< why it may not be exempt; empty: it may
    double farthest = 0; ///< no connected piece of it is farther from the other body at rest, scene units
};

/// The surfaces must meet at rest, and every connected piece of the region must have a point in the other
/// body, or no farther from it than a fiftieth of the smaller body's diagonal: whatever the file says.
RegionVerdict judgeRegion(const VerifiedBody& a, const VerifiedBody& b, const Motion& motion,
                          const RestRegion& region);

} // namespace tss::verify
