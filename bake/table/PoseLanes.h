#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/table/KernelTarget.h"

#include <cstdint>

namespace tss {

/// So many poses side by side are worked on at once: one vector of floats, or some of doubles.
inline constexpr std::uint32_t poseLanes = 16;

/// A body's places in as many configurations: 3 by 4, row-major, rotation first, number k of configuration i
/// at numbers[k][i].
struct BodyLanes {
    alignas(64) double numbers[12][poseLanes];
};

/// Poses as direct kernels read them, B to A between a table's origins: 0, then the 12 numbers.
struct PoseLanes {
    union {
        alignas(64) double doubles[13][poseLanes];
        float floats[13][poseLanes];
    };
    PoseLanes() : doubles{} {}
};

/// What is done with places side by side, in the vectors of one target.
struct LaneKernels {
    /// parent * own, of which the doubles are read.
    void (*compose)(const BodyLanes& parent, const PoseLanes& own, BodyLanes& out) = nullptr;

    /// A bit for each configuration in which the point inA of A's frame and inB of B's are no farther apart
    /// than the root of farSquared.
    std::uint32_t (*near)(const BodyLanes& a, const Vec3& inA, const BodyLanes& b, const Vec3& inB,
                          double farSquared) = nullptr;

    /// B to A, from the origin originB of B's frame to originA of A's, in floats or in doubles.
    void (*between)(const BodyLanes& a, const Vec3& originA, const BodyLanes& b, const Vec3& originB,
                    bool floats, PoseLanes& out) = nullptr;
};

/// target: one that is available.
LaneKernels laneKernels(KernelTarget target);

} // namespace tss
