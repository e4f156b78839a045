// What the queries in vectors are made of: the two forms of a row, how a block or a broadcast row is read,
// which blocks are visited, the nearest of a block. Seen once for each kind of vectors (VectorTargets.h).
#if defined(TSS_QUERY_FORMS) == defined(HWY_TARGET_TOGGLE)
#ifdef TSS_QUERY_FORMS
#undef TSS_QUERY_FORMS
#else
#define TSS_QUERY_FORMS
#endif

#include "bake/table/Kernels.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;

template <class T>
using Lanes = hn::ScalableTag<T>;
template <class T>
using V = hn::Vec<Lanes<T>>;

/// Far enough for a pair that is none, and its square and root still finite.
template <class T>
V<T> farthest() {
    return hn::Set(Lanes<T>(), T(3e38));
}

/// A row of the fold with M features, for vectors of pairs (Load) or for one pair and vectors of poses
/// (Broadcast); the pose's values are vectors either way.
template <class T, std::uint32_t M>
struct FoldForm {
    static constexpr std::uint32_t values = M, columns = foldColumns(M);
    template <class Column>
    static HWY_INLINE V<T> offset(const V<T>* pose, Column column) {
        V<T> sum = column(0);
        for (std::uint32_t k = 0; k < M; ++k) sum = hn::MulAdd(column(k + 1), pose[k], sum);
        return sum;
    }
    template <class Column>
    static HWY_INLINE V<T> square(const V<T>* pose, Column column) {
        V<T> sum = column(M + 1);
        for (std::uint32_t k = 0; k < M; ++k) sum = hn::MulAdd(column(k + 1), pose[k], sum);
        return sum;
    }
    static constexpr std::uint32_t contactDistance = M + 2;
};

template <class T>
struct DirectForm {
    static constexpr std::uint32_t values = 12, columns = directColumns;
    template <class Column>
    static HWY_INLINE V<T> axis(const V<T>* p, V<T> x, V<T> y, V<T> z, V<T> a) {
        return hn::MulAdd(p[2], z, hn::MulAdd(p[1], y, hn::MulAdd(p[0], x, hn::Sub(p[3], a))));
    }
    template <class Column>
    static HWY_INLINE V<T> offset(const V<T>* p, Column column) {
        const V<T> bx = column(0), by = column(1), bz = column(2);
        const V<T> x = axis<Column>(p, bx, by, bz, column(3));
        const V<T> y = axis<Column>(p + 4, bx, by, bz, column(4));
        const V<T> z = axis<Column>(p + 8, bx, by, bz, column(5));
        return hn::MulAdd(x, x, hn::MulAdd(y, y, hn::MulSub(z, z, column(6))));
    }
    template <class Column>
    static HWY_INLINE V<T> square(const V<T>* p, Column column) {
        const V<T> bx = column(0), by = column(1), bz = column(2);
        const V<T> x = axis<Column>(p, bx, by, bz, column(3));
        const V<T> y = axis<Column>(p + 4, bx, by, bz, column(4));
        const V<T> z = axis<Column>(p + 8, bx, by, bz, column(5));
        return hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    }
    static constexpr std::uint32_t contactDistance = 7;
};

template <class T>
struct LoadColumn {
    const T* block;
    HWY_INLINE V<T> operator()(std::uint32_t k) const {
        const Lanes<T> d;
        return hn::Load(d, block + k * hn::Lanes(d));
    }
};

template <class T>
struct BroadcastColumn {
    const T* row;
    HWY_INLINE V<T> operator()(std::uint32_t k) const { return hn::Set(Lanes<T>(), row[k]); }
};

/// The pose's values, each in all lanes; the first is less the shared term.
template <class T, std::uint32_t count>
struct Broadcast {
    V<T> values[count + 1];
    explicit HWY_INLINE Broadcast(const void* pose) {
        for (std::uint32_t k = 0; k <= count; ++k)
            values[k] = hn::Set(Lanes<T>(), static_cast<const T*>(pose)[k]);
    }
};

/// Calls take(block) for every block.
template <class T, class Form>
struct AllBlocks {
    const KernelData& data;
    template <class Take>
    HWY_INLINE void each(Take take) const {
        const std::size_t step = Form::columns * hn::Lanes(Lanes<T>());
        const T *block = static_cast<const T*>(data.blocks), *end = static_cast<const T*>(data.end);
        for (; block < end; block += step) take(block);
    }
};

/// The same for those that are near.
template <class T, class Form>
struct SomeBlocks {
    const KernelData& data;
    const NearBlocks& near;
    template <class Take>
    HWY_INLINE void each(Take take) const {
        constexpr std::uint32_t perGroup = NearBlocks::codesPerGroup, header = NearBlocks::headerCodes;
        const hn::FixedTag<std::uint8_t, perGroup> bytes;
        const std::size_t step = Form::columns * hn::Lanes(Lanes<T>());
        const T* blocks = static_cast<const T*>(data.blocks);
        const auto limit = hn::Set(bytes, near.limit);
        unsigned mask = 0xffffu << header;
        for (std::uint32_t group = 0; group < near.groups; ++group) {
            const auto codes = hn::LoadU(bytes, near.codes + perGroup * group);
            std::uint8_t in[8] = {};
            hn::StoreMaskBits(bytes, hn::Eq(hn::Min(codes, limit), codes), in);
            for (mask &= in[0] | unsigned(in[1]) << 8; mask != 0; mask &= mask - 1)
                take(blocks + (perGroup * group + hwy::Num0BitsBelowLS1Bit_Nonzero32(mask) - header) * step);
            mask = 0xffffu;
        }
    }
};

/// Smallest gap so far and the number of its test, in every lane.
template <class T>
struct Nearest {
    V<T> gap, number;
    HWY_INLINE void take(V<T> otherGap, V<T> otherNumber) {
        number = hn::IfThenElse(hn::Lt(otherGap, gap), otherNumber, number);
        gap = hn::Min(otherGap, gap);
    }
};

template <class T, class Form, class Column>
HWY_INLINE V<T> gapOf(const V<T>* pose, Column column) {
    const V<T> square = hn::Sub(Form::square(pose + 1, column), pose[0]);
    return hn::Sub(hn::Sqrt(hn::Max(square, hn::Zero(Lanes<T>()))), column(Form::contactDistance));
}

/// Calls use(DirectForm), or use(FoldForm) of the fold with so many features; not at all where there is none.
template <class T, class Use>
void withForm(const KernelShape& shape, Use use) {
    if (!shape.folds) return use(DirectForm<T>{});
    [&]<std::uint32_t... M>(std::integer_sequence<std::uint32_t, M...>) {
        ((shape.features == M ? use(FoldForm<T, M>{}) : void()), ...);
    }
    (std::make_integer_sequence<std::uint32_t, maxFoldFeatures + 1>{});
}

#endif

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#endif
