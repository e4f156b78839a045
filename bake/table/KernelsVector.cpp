// The query kernels, compiled once for each vector target that the processor may have (Highway). Everything
// between HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE is seen several times.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/table/KernelsVector.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/table/KernelsScalar.h"

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
#define TSS_HAS_VECTORS 1

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
    static constexpr std::uint32_t reach = M + 2;
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
    static constexpr std::uint32_t reach = 7;
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

template <class T, class Form>
bool hit(const KernelData<T>& data, const T* pose, T shared) {
    const Lanes<T> d;
    V<T> p[Form::values > 0 ? Form::values : 1];
    for (std::uint32_t k = 0; k < Form::values; ++k) p[k] = hn::Set(d, pose[k]);
    const std::size_t step = Form::columns * hn::Lanes(d);
    const T *block = data.blocks, *end = block + data.blockCount * step;
    V<T> least = farthest<T>();
    V<T> other = least;
    // Two sums at a time, so that one need not wait for the other.
    for (const T* last = end - step; block < last; block += 2 * step) {
        least = hn::Min(least, Form::offset(p, LoadColumn<T>{block}));
        other = hn::Min(other, Form::offset(p, LoadColumn<T>{block + step}));
    }
    if (block < end) other = hn::Min(other, Form::offset(p, LoadColumn<T>{block}));
    return !hn::AllFalse(d, hn::Le(hn::Min(least, other), hn::Set(d, -shared)));
}

template <class T, class Form>
KernelGap<T> gap(const KernelData<T>& data, const T* pose, T shared) {
    const Lanes<T> d;
    const hn::RebindToSigned<Lanes<T>> di;
    V<T> p[Form::values > 0 ? Form::values : 1];
    for (std::uint32_t k = 0; k < Form::values; ++k) p[k] = hn::Set(d, pose[k]);
    const std::size_t step = Form::columns * hn::Lanes(d);
    const V<T> sharedAll = hn::Set(d, shared), zero = hn::Zero(d);
    V<T> best = farthest<T>();
    auto bestBlock = hn::Set(di, -1), number = hn::Zero(di);
    const auto one = hn::Set(di, 1);
    const T* block = data.blocks;
    for (const T* end = block + data.blockCount * step; block < end; block += step) {
        const LoadColumn<T> column{block};
        const V<T> square = hn::Max(hn::Add(Form::square(p, column), sharedAll), zero);
        const V<T> gap = hn::Sub(hn::Sqrt(square), column(Form::reach));
        const auto nearer = hn::Lt(gap, best);
        best = hn::Min(gap, best);
        bestBlock = hn::IfThenElse(hn::RebindMask(di, nearer), number, bestBlock);
        number = hn::Add(number, one);
    }
    const V<T> least = hn::MinOfLanes(d, best);
    const auto at = hn::FindFirstTrue(d, hn::Eq(best, least));
    if (at < 0) return {};
    HWY_ALIGN hwy::MakeSigned<T> blocks[hn::MaxLanes(Lanes<T>())];
    hn::Store(bestBlock, di, blocks);
    return {hn::GetLane(least),
            static_cast<std::int32_t>(blocks[at] * static_cast<std::int32_t>(hn::Lanes(d)) + at)};
}

template <class T, class Form>
std::uint32_t under(const KernelData<T>& data, const T* pose, T shared, T margin, std::uint32_t* out) {
    const Lanes<T> d;
    V<T> p[Form::values > 0 ? Form::values : 1];
    for (std::uint32_t k = 0; k < Form::values; ++k) p[k] = hn::Set(d, pose[k]);
    const std::size_t step = Form::columns * hn::Lanes(d);
    const V<T> twice = hn::Set(d, 2 * margin), rest = hn::Set(d, margin * margin - shared);
    std::uint32_t count = 0, first = 0;
    const T* block = data.blocks;
    for (const T* end = block + data.blockCount * step; block < end; block += step) {
        const LoadColumn<T> column{block};
        const auto in = hn::Le(Form::offset(p, column), hn::MulAdd(column(Form::reach), twice, rest));
        if (!hn::AllFalse(d, in)) {
            std::uint8_t bytes[8] = {};
            hn::StoreMaskBits(d, in, bytes);
            for (unsigned bits = bytes[0] | unsigned(bytes[1]) << 8; bits != 0; bits &= bits - 1)
                out[count++] = first + static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
        }
        first += static_cast<std::uint32_t>(hn::Lanes(d));
    }
    return count;
}

template <class T, class Form>
void hits(const KernelData<T>& rows, const T* poses, std::uint32_t stride, const T* shared,
          std::uint32_t count, T* least) {
    const Lanes<T> d;
    const std::uint32_t n = static_cast<std::uint32_t>(hn::Lanes(d));
    for (std::uint32_t i = 0; i < count; i += n) {
        V<T> p[Form::values > 0 ? Form::values : 1];
        for (std::uint32_t k = 0; k < Form::values; ++k) p[k] = hn::LoadU(d, poses + k * stride + i);
        V<T> best = farthest<T>();
        const T* row = rows.blocks;
        for (const T* end = row + rows.blockCount * Form::columns; row < end; row += Form::columns)
            best = hn::Min(best, Form::offset(p, BroadcastColumn<T>{row}));
        hn::StoreU(hn::Add(best, hn::LoadU(d, shared + i)), d, least + i);
    }
}

template <class T, class Form>
void gaps(const KernelData<T>& rows, const T* poses, std::uint32_t stride, const T* shared,
          std::uint32_t count, T* gap, std::int32_t* test) {
    const Lanes<T> d;
    const hn::RebindToSigned<Lanes<T>> di;
    const std::uint32_t n = static_cast<std::uint32_t>(hn::Lanes(d));
    HWY_ALIGN hwy::MakeSigned<T> tests[hn::MaxLanes(Lanes<T>())];
    for (std::uint32_t i = 0; i < count; i += n) {
        V<T> p[Form::values > 0 ? Form::values : 1];
        for (std::uint32_t k = 0; k < Form::values; ++k) p[k] = hn::LoadU(d, poses + k * stride + i);
        const V<T> sharedThese = hn::LoadU(d, shared + i);
        V<T> best = farthest<T>();
        auto bestTest = hn::Set(di, -1), number = hn::Zero(di);
        const T* row = rows.blocks;
        for (const T* end = row + rows.blockCount * Form::columns; row < end; row += Form::columns) {
            const BroadcastColumn<T> column{row};
            const V<T> square = hn::Max(hn::Add(Form::square(p, column), sharedThese), hn::Zero(d));
            const V<T> here = hn::Sub(hn::Sqrt(square), column(Form::reach));
            bestTest = hn::IfThenElse(hn::RebindMask(di, hn::Lt(here, best)), number, bestTest);
            best = hn::Min(here, best);
            number = hn::Add(number, hn::Set(di, 1));
        }
        hn::StoreU(best, d, gap + i);
        hn::Store(bestTest, di, tests);
        for (std::uint32_t k = 0; k < n; ++k) test[i + k] = static_cast<std::int32_t>(tests[k]);
    }
}

template <class T, class Form>
KernelSet<T> kernels() {
    return {static_cast<std::uint32_t>(hn::Lanes(Lanes<T>())),
            hit<T, Form>,
            gap<T, Form>,
            under<T, Form>,
            hits<T, Form>,
            gaps<T, Form>};
}

template <class T>
KernelSet<T> fold(std::uint32_t features) {
    switch (features) {
    case 0:
        return kernels<T, FoldForm<T, 0>>();
    case 1:
        return kernels<T, FoldForm<T, 1>>();
    case 2:
        return kernels<T, FoldForm<T, 2>>();
    case 3:
        return kernels<T, FoldForm<T, 3>>();
    case 4:
        return kernels<T, FoldForm<T, 4>>();
    case 5:
        return kernels<T, FoldForm<T, 5>>();
    case 6:
        return kernels<T, FoldForm<T, 6>>();
    case 7:
        return kernels<T, FoldForm<T, 7>>();
    case 8:
        return kernels<T, FoldForm<T, 8>>();
    case 9:
        return kernels<T, FoldForm<T, 9>>();
    case 10:
        return kernels<T, FoldForm<T, 10>>();
    }
    return {};
}

template <class T>
KernelSet<T> direct() {
    return kernels<T, DirectForm<T>>();
}

#endif

} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <hwy/targets.h>

namespace tss {

bool available(KernelTarget target) {
    const auto has = [](std::int64_t bit) { return (hwy::SupportedTargets() & HWY_TARGETS & bit) != 0; };
    switch (target) {
    case KernelTarget::Best:
    case KernelTarget::Scalar:
        return true;
    case KernelTarget::Sse2:
        return has(HWY_SSSE3);
    case KernelTarget::Avx2:
        return has(HWY_AVX2);
    case KernelTarget::Avx512:
        return has(HWY_AVX3);
    case KernelTarget::Neon:
        return has(HWY_NEON);
    }
    return false;
}

// Each namespace exists only where this build compiles for it.
#if HWY_TARGETS & HWY_SSSE3
#define TSS_SSE2(call)                                                                                       \
    if (target == KernelTarget::Sse2) return N_SSSE3::call;
#else
#define TSS_SSE2(call)
#endif
#if HWY_TARGETS & HWY_AVX2
#define TSS_AVX2(call)                                                                                       \
    if (target == KernelTarget::Avx2) return N_AVX2::call;
#else
#define TSS_AVX2(call)
#endif
#if HWY_TARGETS & HWY_AVX3
#define TSS_AVX512(call)                                                                                     \
    if (target == KernelTarget::Avx512) return N_AVX3::call;
#else
#define TSS_AVX512(call)
#endif
#if HWY_TARGETS & HWY_NEON
#define TSS_NEON(call)                                                                                       \
    if (target == KernelTarget::Neon) return N_NEON::call;
#else
#define TSS_NEON(call)
#endif
#define TSS_TARGETS(call) TSS_SSE2(call) TSS_AVX2(call) TSS_AVX512(call) TSS_NEON(call)

template <class T>
KernelSet<T> vectorFoldKernels(KernelTarget target, std::uint32_t features) {
    TSS_TARGETS(fold<T>(features))
    (void)target, (void)features;
    return {};
}
template <class T>
KernelSet<T> vectorDirectKernels(KernelTarget target) {
    TSS_TARGETS(direct<T>())
    (void)target;
    return {};
}
template KernelSet<float> vectorFoldKernels<float>(KernelTarget, std::uint32_t);
template KernelSet<double> vectorFoldKernels<double>(KernelTarget, std::uint32_t);
template KernelSet<float> vectorDirectKernels<float>(KernelTarget);
template KernelSet<double> vectorDirectKernels<double>(KernelTarget);

} // namespace tss
#endif
