// Places of bodies in many configurations, in vectors of configurations.
#include "bake/table/VectorTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/table/LaneKernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/table/PoseLanes.h"

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, poseLanes>;
using V = hn::Vec<Doubles>;

/// Calls take(first lane) for each vector of the lanes.
template <class Take>
HWY_INLINE void eachVector(Take take) {
    for (std::uint32_t i = 0; i < poseLanes; i += static_cast<std::uint32_t>(hn::Lanes(Doubles()))) take(i);
}

HWY_INLINE V load(const BodyLanes& body, int k, std::uint32_t lane) {
    return hn::Load(Doubles(), body.numbers[k] + lane);
}
HWY_INLINE V all(double value) {
    return hn::Set(Doubles(), value);
}

/// The row (x, y, z) times the column (a, b, c), plus `sum`.
HWY_INLINE V rowTimes(V x, V y, V z, V a, V b, V c, V sum) {
    return hn::MulAdd(x, a, hn::MulAdd(y, b, hn::MulAdd(z, c, sum)));
}

void compose(const BodyLanes& parent, const PoseLanes& own, BodyLanes& out) {
    eachVector([&](std::uint32_t lane) {
        V right[12];
        for (int k = 0; k < 12; ++k) right[k] = hn::Load(Doubles(), own.doubles[k + 1] + lane);
        for (int r = 0; r < 12; r += 4) {
            const V x = load(parent, r, lane), y = load(parent, r + 1, lane), z = load(parent, r + 2, lane);
            for (int c = 0; c < 4; ++c) {
                const V move = c < 3 ? hn::Zero(Doubles()) : load(parent, r + 3, lane);
                hn::Store(rowTimes(x, y, z, right[c], right[4 + c], right[8 + c], move), Doubles(),
                          out.numbers[r + c] + lane);
            }
        }
    });
}

/// One coordinate, outside of the body's frame, of a point given in it. row: the first number of its row.
HWY_INLINE V coordinate(const BodyLanes& body, int row, const Vec3& point, std::uint32_t lane) {
    return rowTimes(load(body, row, lane), load(body, row + 1, lane), load(body, row + 2, lane),
                    all(point.x()), all(point.y()), all(point.z()), load(body, row + 3, lane));
}

std::uint32_t near(const BodyLanes& a, const Vec3& inA, const BodyLanes& b, const Vec3& inB,
                   double farSquared) {
    const Doubles d;
    std::uint32_t found = 0;
    eachVector([&](std::uint32_t lane) {
        V sum = hn::Zero(d);
        for (int row = 0; row < 12; row += 4) {
            const V off = hn::Sub(coordinate(b, row, inB, lane), coordinate(a, row, inA, lane));
            sum = hn::MulAdd(off, off, sum);
        }
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::Le(sum, all(farSquared)), bits);
        found |= std::uint32_t(bits[0]) << lane;
    });
    return found;
}

HWY_INLINE void store(V value, double* to) {
    hn::Store(value, Doubles(), to);
}
HWY_INLINE void store(V value, float* to) {
    using Floats = hn::Rebind<float, Doubles>;
    hn::Store(hn::DemoteTo(Floats(), value), Floats(), to);
}

template <class T>
void between(const BodyLanes& a, const Vec3& originA, const BodyLanes& b, const Vec3& originB,
             T (&out)[13][poseLanes]) {
    eachVector([&](std::uint32_t lane) {
        V turnA[12], move[3], turnB[12];
        for (int k = 0; k < 12; ++k) {
            turnA[k] = load(a, k, lane);
            turnB[k] = load(b, k, lane);
        }
        for (int r = 0; r < 3; ++r) move[r] = hn::Sub(coordinate(b, 4 * r, originB, lane), turnA[4 * r + 3]);
        store(hn::Zero(Doubles()), out[0] + lane);
        for (int r = 0; r < 3; ++r) {
            const V x = turnA[r], y = turnA[4 + r], z = turnA[8 + r];
            for (int c = 0; c < 3; ++c)
                store(rowTimes(x, y, z, turnB[c], turnB[4 + c], turnB[8 + c], hn::Zero(Doubles())),
                      out[1 + 4 * r + c] + lane);
            store(rowTimes(x, y, z, move[0], move[1], move[2], all(-originA[r])), out[1 + 4 * r + 3] + lane);
        }
    });
}

void between(const BodyLanes& a, const Vec3& originA, const BodyLanes& b, const Vec3& originB, bool floats,
             PoseLanes& out) {
    floats ? between(a, originA, b, originB, out.floats) : between(a, originA, b, originB, out.doubles);
}

LaneKernels kernels() {
    LaneKernels made;
    made.compose = compose;
    made.near = near;
    made.between = between;
    return made;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tss {

LaneKernels laneKernels(KernelTarget target) {
    if (target == KernelTarget::Best) target = bestTarget();
    TSS_TARGETS(kernels())
    return HWY_STATIC_DISPATCH(kernels)(); // what this build may always use
}

} // namespace tss
#endif
