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

namespace hn = hwy::HWY_NAMESPACE;

// D: the tag of the vectors, those of the target whole or of one lane.
template <class D>
using V = hn::Vec<D>;

/// Far enough for a pair that is none, and its square and root still finite.
template <class D>
V<D> farthest() {
    return hn::Set(D(), hn::TFromD<D>(3e38));
}

/// The smaller of two that are numbers: Highway's vectors of one lane would look for others first.
template <class Vector>
HWY_INLINE Vector smaller(Vector a, Vector b) {
    if constexpr (hn::MaxLanes(hn::DFromV<Vector>()) == 1)
        return hn::IfThenElse(hn::Lt(a, b), a, b);
    else
        return hn::Min(a, b);
}

/// A row of the fold with M features, for vectors of pairs (LoadColumn) or for one pair and vectors of poses
/// (BroadcastColumn); the pose's values are vectors either way.
template <class Tag, std::uint32_t M>
struct FoldForm {
    using D = Tag;
    static constexpr std::uint32_t values = M, columns = foldColumns(M);
    /// The squared distance less the squared contact distance, and the squared distance.
    template <class Column>
    static HWY_INLINE V<D> offset(const V<D>* pose, Column column) {
        return plusFeatures(column(0), pose, column);
    }
    template <class Column>
    static HWY_INLINE V<D> square(const V<D>* pose, Column column) {
        return plusFeatures(column(M + 1), pose, column);
    }
    template <class Column>
    static HWY_INLINE V<D> plusFeatures(V<D> sum, const V<D>* pose, Column column) {
        for (std::uint32_t k = 0; k < M; ++k) sum = hn::MulAdd(column(k + 1), pose[k], sum);
        return sum;
    }
    static constexpr std::uint32_t contactDistance = M + 2;
};

template <class Tag>
struct DirectForm {
    using D = Tag;
    static constexpr std::uint32_t values = 12, columns = directColumns;
    template <class Column>
    static HWY_INLINE V<D> offset(const V<D>* p, Column column) {
        const Between t(p, column);
        return hn::MulAdd(t.x, t.x, hn::MulAdd(t.y, t.y, hn::MulSub(t.z, t.z, column(6))));
    }
    template <class Column>
    static HWY_INLINE V<D> square(const V<D>* p, Column column) {
        const Between t(p, column);
        return hn::MulAdd(t.x, t.x, hn::MulAdd(t.y, t.y, hn::Mul(t.z, t.z)));
    }
    /// From the centre of A's sphere to that of B's.
    struct Between {
        V<D> x, y, z;
        template <class Column>
        HWY_INLINE Between(const V<D>* p, Column column) {
            const V<D> bx = column(0), by = column(1), bz = column(2);
            x = axis(p, bx, by, bz, column(3));
            y = axis(p + 4, bx, by, bz, column(4));
            z = axis(p + 8, bx, by, bz, column(5));
        }
        static HWY_INLINE V<D> axis(const V<D>* p, V<D> x, V<D> y, V<D> z, V<D> a) {
            return hn::MulAdd(p[2], z, hn::MulAdd(p[1], y, hn::MulAdd(p[0], x, hn::Sub(p[3], a))));
        }
    };
    static constexpr std::uint32_t contactDistance = 7;
};

template <class D>
struct LoadColumn {
    const hn::TFromD<D>* block;
    HWY_INLINE V<D> operator()(std::uint32_t k) const { return hn::Load(D(), block + k * hn::Lanes(D())); }
};

template <class D>
struct BroadcastColumn {
    const hn::TFromD<D>* row;
    HWY_INLINE V<D> operator()(std::uint32_t k) const { return hn::Set(D(), row[k]); }
};

/// The pose's values, each in all lanes; the first is less the shared term.
template <class D, std::uint32_t count>
struct Broadcast {
    V<D> values[count + 1];
    explicit HWY_INLINE Broadcast(const void* pose) {
        for (std::uint32_t k = 0; k <= count; ++k)
            values[k] = hn::Set(D(), static_cast<const hn::TFromD<D>*>(pose)[k]);
    }
};

/// Calls take(block) for every block.
template <class Form>
struct AllBlocks {
    using T = hn::TFromD<typename Form::D>;
    const KernelData& data;
    template <class Take>
    HWY_INLINE void each(Take take) const {
        const std::size_t step = Form::columns * hn::Lanes(typename Form::D());
        const T *block = static_cast<const T*>(data.blocks), *end = static_cast<const T*>(data.end);
        for (; block < end; block += step) take(block);
    }
};

/// The same for those that are near.
template <class Form>
struct SomeBlocks {
    using T = hn::TFromD<typename Form::D>;
    const KernelData& data;
    const NearBlocks& near;
    template <class Take>
    HWY_INLINE void each(Take take) const {
        constexpr std::uint32_t perGroup = NearBlocks::codesPerGroup, header = NearBlocks::headerCodes;
        const std::size_t step = Form::columns * hn::Lanes(typename Form::D());
        const T* blocks = static_cast<const T*>(data.blocks);
#if HWY_TARGET == HWY_SCALAR
        for (std::uint32_t i = header; i < perGroup * near.groups; ++i)
            if (near.codes[i] <= near.limit) take(blocks + (i - header) * step);
#else
        const hn::FixedTag<std::uint8_t, perGroup> bytes;
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
#endif
    }
};

/// Smallest gap so far and the number of its test, in every lane.
template <class D>
struct Nearest {
    V<D> gap, number;
    HWY_INLINE void take(V<D> otherGap, V<D> otherNumber) {
        number = hn::IfThenElse(hn::Lt(otherGap, gap), otherNumber, number);
        gap = smaller(otherGap, gap);
    }
};

template <class Form, class Column>
HWY_INLINE auto gapOf(const V<typename Form::D>* pose, Column column) {
    const auto square = hn::Sub(Form::square(pose + 1, column), pose[0]);
    return hn::Sub(hn::Sqrt(hn::Max(square, hn::Zero(typename Form::D()))), column(Form::contactDistance));
}

/// Calls use(DirectForm), or use(FoldForm) of the fold with so many features; not at all where there is none.
template <class D, class Use>
void withForm(const KernelShape& shape, Use use) {
    if (!shape.folds) return use(DirectForm<D>{});
    [&]<std::uint32_t... M>(std::integer_sequence<std::uint32_t, M...>) {
        ((shape.features == M ? use(FoldForm<D, M>{}) : void()), ...);
    }
    (std::make_integer_sequence<std::uint32_t, maxFoldFeatures + 1>{});
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#endif
