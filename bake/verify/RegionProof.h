#pragma once
#include "bake/motion/Motion.h"
#include "bake/table/RestRegion.h"
#include "bake/verify/VerifiedBody.h"

#include <string>

namespace tss::verify {

/// What a region at rest leaves out of what is proven.
struct ExemptShare {
    double areaA = 0, areaB = 0;   ///< scene units squared
    double shareA = 0, shareB = 0; ///< of the whole surface, 0 to 1
};
ExemptShare exemptShare(const TriangleMesh& a, const TriangleMesh& b, const RestRegion& region);

/// Why the region may not be exempt; empty: it may. The surfaces must meet at rest, and every connected piece
/// of the region must have a point in the other body, or no farther than `slack` from it.
std::string refuteRegion(const VerifiedBody& a, const VerifiedBody& b, const Motion& motion,
                         const RestRegion& region, double slack);

} // namespace tss::verify
