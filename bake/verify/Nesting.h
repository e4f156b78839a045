#pragma once
#include "bake/base/Progress.h"
#include "bake/verify/MeshProof.h"
#include "bake/verify/RegionProof.h"

namespace tss::verify {

struct NestingResult {
    std::string reason;       ///< what was found, or could not be shown; empty: shown
    std::vector<double> pose; ///< where
    std::uint64_t cells = 0;
    std::uint64_t work = 0; ///< tests, and groups of them, looked at
};

/// Shows that at no pose at which a test fires a body, or a component of one, is wholly inside the other with
/// the surfaces more than `early` apart. Where neither is wide enough for that nothing is asked. In a box of
/// Q it is enough that
/// - no test fires in it, or
/// - the surfaces cross, or are as near as that, all over it, or
/// - every component of both bodies keeps a point outside the other body, or so near its surface.
NestingResult proveNoNesting(const VerifiedBody& a, const VerifiedBody& b, const Motion& motion, double size,
                             const std::vector<MeshTest>& tests, double early, const Progress& progress);

} // namespace tss::verify
