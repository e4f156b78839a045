#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Motion.h"

#include <vector>

namespace tss {

/// A shift of B that gives a joint room: x' = D(x + shift).
struct FreeingShift {
    Vec3 shift = Vec3::Zero(); ///< in B's frame, scene units
    std::size_t free = 0;      ///< of the poses tried, those where the surfaces are apart by the margin
    std::size_t poses = 0;     ///< tried: rest and others spread over the limits
    bool freeAtRest = false;
    double atRest = 0; ///< distance of the surfaces there, scene units
    double least = 0;  ///< of the free poses
};

/// The smallest shifts found, each with more free poses than those before, for surfaces that overlap where
/// the joint rests; none where they do not, or where no shift of up to a tenth of the smaller body gives it
/// any room. They are found by trying, with the meshes alone: small, not proven to be the smallest. The same
/// for any number of threads.
std::vector<FreeingShift> freeingShifts(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion);

} // namespace tss
