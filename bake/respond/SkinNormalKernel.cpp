// The normals of a skin that has moved, in vectors of one vertex or two.
#include "bake/table/VectorTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/respond/SkinNormalKernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/respond/SkinNormalKernel.h"

#include <Eigen/Core>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
using V = Eigen::Array4f;
constexpr std::size_t together = 1; ///< vertices in a vector

HWY_INLINE V load(const float* places) {
    return V::Map(places);
}

HWY_INLINE V placeAt(const float* places, const std::uint32_t* ring) {
    return load(places + ring[0]);
}

HWY_INLINE V rotated(const V& x) {
    return {x[1], x[2], x[0], x[3]};
}

HWY_INLINE bool finish(const V& sum, float outward, float* out) {
    const V squares = sum * sum;
    const float squared = (squares[0] + squares[2]) + (squares[1] + squares[3]);
    V::Map(out) = rotated(sum) * (outward / std::sqrt(squared > 0 ? squared : 1));
    return squared > 0;
}
#else
namespace hn = hwy::HWY_NAMESPACE;

using Four = hn::FixedTag<float, 4>;
#if HWY_MAX_BYTES >= 32
using Floats = hn::FixedTag<float, 8>;
#else
using Floats = Four;
#endif
using V = hn::Vec<Floats>;
constexpr std::size_t together = hn::MaxLanes(Floats()) / 4; ///< vertices in a vector

HWY_INLINE V load(const float* places) {
    return hn::LoadU(Floats(), places);
}

/// Places that the rings of these vertices name at one position.
HWY_INLINE V placeAt(const float* places, const std::uint32_t* ring) {
    const Four four;
#if HWY_MAX_BYTES >= 32
    return hn::Combine(Floats(), hn::Load(four, places + ring[1]), hn::Load(four, places + ring[0]));
#else
    return hn::Load(four, places + ring[0]);
#endif
}

/// Of each vertex the components y, z, x: a cross product is a difference of two such products.
HWY_INLINE V rotated(V x) {
    const hn::Repartition<std::uint8_t, Floats> bytes;
    HWY_ALIGN static constexpr std::uint8_t from[16] = {4, 5, 6, 7, 8, 9, 10, 11, 0, 1, 2, 3, 12, 13, 14, 15};
    return hn::BitCast(Floats(), hn::TableLookupBytes(hn::BitCast(bytes, x), hn::LoadDup128(bytes, from)));
}

/// Makes unit vectors of sums in the order z, x, y. Returns whether none was 0.
HWY_INLINE bool finish(V sum, float outward, float* out) {
    const Floats d;
    const V squares = hn::Mul(sum, sum), two = hn::Add(squares, hn::Shuffle1032(squares)),
            squared = hn::Add(two, hn::Shuffle2301(two));
    const auto any = hn::Gt(squared, hn::Zero(d));
    const V length = hn::Sqrt(hn::IfThenElse(any, squared, hn::Set(d, 1)));
    const V unit = hn::Mul(rotated(sum), hn::Div(hn::Set(d, outward), length));
    const Four four;
#if HWY_MAX_BYTES >= 32
    hn::StoreU(hn::LowerHalf(four, unit), four, out);
    hn::StoreU(hn::UpperHalf(four, unit), four, out + 3);
#else
    hn::StoreU(unit, four, out);
#endif
    return hn::AllTrue(d, any);
}
#endif

bool normals(const Lists<std::uint32_t>& rings, const float* places, float outward, std::size_t first,
             std::size_t last, float* out) {
    bool all = true;
    for (std::size_t pair = first; pair < last; ++pair) {
        const auto ring = rings[pair];
        for (std::size_t k = 0; k < 2; k += together, out += 3 * together) {
            const V own = load(places + 8 * pair + 4 * k);
            V sum = own - own; // z, x, y
            V before = placeAt(places, ring.data() + ring.size() - 2 + k);
            for (std::size_t i = k; i < ring.size(); i += 4) {
                const V spoke = placeAt(places, ring.data() + i) - own,
                        next = placeAt(places, ring.data() + i + 2), rim = next - before;
                sum = sum + (spoke * rotated(rim) - rotated(spoke) * rim);
                before = next;
            }
            all = finish(sum, outward, out) && all;
        }
    }
    return all;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tss {

SkinNormalKernel skinNormalKernel(KernelTarget target) {
    TSS_TARGETS(normals)
    return HWY_STATIC_DISPATCH(normals); // what this build may always use
}

} // namespace tss
#endif
