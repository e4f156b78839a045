#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Motion.h"

#include <limits>
#include <optional>
#include <vector>

namespace tss {

/// Where a joint meets something when it goes on beyond one of its limits.
struct StopBeyond {
    std::size_t dof = 0;
    double value = 0; ///< of that DOF, the others at rest
};

/// A move of B that gives a joint room: x' = D(x + shift), the axes of D moved by `axes`.
struct FreeingMove {
    Vec3 shift = Vec3::Zero(); ///< in B's frame, scene units
    Vec3 axes = Vec3::Zero();  ///< of the origins of all turns, in A's frame, scene units
    Motion motion;             ///< with both
    double moved = 0;  ///< by how much B lies elsewhere than before, over the limits: root of the mean square
    double margin = 0; ///< scene units: what counts as apart
    std::size_t free = 0;  ///< of the poses tried, those where the surfaces are apart by the margin
    std::size_t meets = 0; ///< of the poses tried, those where they touch
    std::size_t poses = 0; ///< tried: rest and others spread over the limits
    std::size_t stops = 0; ///< of the poses tried, those that are stops of the joint and stay in contact
    bool freeAtRest = false;
    double atRest = 0; ///< distance of the surfaces there, scene units
    double least = 0;  ///< of the free poses
    std::vector<StopBeyond>
        beyond; ///< where nothing is met within the limits: what is met not far beyond them
};

struct FreeingOptions {
    bool axes = false;                                        ///< axes may be moved too
    double seconds = std::numeric_limits<double>::infinity(); ///< for looking; then what was found by then
};

/// Where surfaces that are apart at rest touch nevertheless at most of the poses.
struct TouchingElsewhere {
    std::size_t touching = 0, poses = 0; ///< of the poses tried
    std::vector<double> values;          ///< of the joint, in the middle of those that touch
};

/// Where surfaces that overlap at rest are apart all the same: of the poses tried the one where they are
/// farthest apart.
struct ApartElsewhere {
    std::size_t apart = 0, poses = 0; ///< of the poses tried
    double distance = 0;              ///< of the surfaces there, scene units
    std::vector<double> values;       ///< of the joint there
};

/// Moves, and whether there was time to look for all.
struct FreeingMoves {
    std::vector<FreeingMove> moves;
    bool complete = true;
    std::optional<TouchingElsewhere> elsewhere; ///< where they do not overlap at rest
    std::optional<ApartElsewhere> apart;        ///< where they do
};

/// Small moves of B that give a joint room whose surfaces overlap where it rests. They are sorted by how many
/// poses they free, and among equals by how little they move B. There are none where the surfaces do not
/// overlap at rest, or where no shift of up to a tenth of the smaller body helps. A pose at which the bodies
/// meet elsewhere than where they overlap at rest (teeth that bite, METHOD 2.4) is a stop of the joint: it
/// counts as free. Moves are found by trial on the meshes: they are small, but not proven to be the smallest.
/// The same for any number of threads, if complete.
FreeingMoves freeingMoves(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                          const FreeingOptions& options = {});

} // namespace tss
