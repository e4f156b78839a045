// The query kernels, compiled once for each vector target that the processor may have (Highway). Everything
// between HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE is seen several times.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/table/KernelsVector.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/table/Contact.h"
#include "bake/table/Fold.h"
#include "bake/table/KernelsScalar.h"

#include <algorithm>
#include <cmath>

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

/// The pose's values, each in all lanes; the first is less the shared term.
template <class T, std::uint32_t count>
struct Broadcast {
    V<T> values[count + 1];
    explicit HWY_INLINE Broadcast(const void* pose) {
        for (std::uint32_t k = 0; k <= count; ++k)
            values[k] = hn::Set(Lanes<T>(), static_cast<const T*>(pose)[k]);
    }
};

template <class T, class Form>
bool hit(const KernelData& data, const void* pose) {
    const Lanes<T> d;
    const Broadcast<T, Form::values> p(pose);
    const std::size_t step = Form::columns * hn::Lanes(d);
    const T *block = static_cast<const T*>(data.blocks), *end = static_cast<const T*>(data.end);
    // The first block starts the minimum; then two sums at a time, so that one need not wait for the other.
    V<T> least = Form::offset(p.values + 1, LoadColumn<T>{block});
    block += step;
    for (const T* last = end - step; block < last; block += 2 * step) {
        const V<T> one = Form::offset(p.values + 1, LoadColumn<T>{block});
        const V<T> two = Form::offset(p.values + 1, LoadColumn<T>{block + step});
        least = hn::Min(least, hn::Min(one, two));
    }
    if (block != end) least = hn::Min(least, Form::offset(p.values + 1, LoadColumn<T>{block}));
    return !hn::AllFalse(d, hn::Le(least, p.values[0]));
}

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
    return hn::Sub(hn::Sqrt(hn::Max(square, hn::Zero(Lanes<T>()))), column(Form::reach));
}

template <class T, class Form>
KernelGap gap(const KernelData& data, const void* pose) {
    using Number = hwy::MakeSigned<T>;
    const Lanes<T> d;
    const Broadcast<T, Form::values> p(pose);
    const std::size_t step = Form::columns * hn::Lanes(d);
    const T *block = static_cast<const T*>(data.blocks), *end = static_cast<const T*>(data.end);
    const LoadColumn<T> first{block};
    Nearest<T> nearest{gapOf<T, Form>(p.values, first), first(Form::reach + 1)};
    for (block += step; block < end; block += step) {
        const LoadColumn<T> column{block};
        nearest.take(gapOf<T, Form>(p.values, column), column(Form::reach + 1));
    }
    const V<T> least = hn::MinOfLanes(d, nearest.gap);
    // A pose that is not a number equals nothing: whatever lane that gives is as good as any.
    const auto equal = hn::Eq(nearest.gap, least);
    const std::size_t at = static_cast<std::size_t>(hn::FindFirstTrue(d, equal)) & (hn::Lanes(d) - 1);
    Number numbers[hn::MaxLanes(Lanes<T>())];
    hn::StoreU(hn::BitCast(hn::RebindToSigned<Lanes<T>>(), nearest.number), hn::RebindToSigned<Lanes<T>>(),
               numbers);
    return {static_cast<double>(hn::GetLane(least)), static_cast<std::int32_t>(numbers[at])};
}

template <class T, class Form>
std::uint32_t under(const KernelData& data, const void* pose, double marginWide, std::uint32_t* out) {
    const Lanes<T> d;
    const Broadcast<T, Form::values> p(pose);
    const T margin = static_cast<T>(marginWide);
    const std::size_t step = Form::columns * hn::Lanes(d);
    const V<T> twice = hn::Set(d, 2 * margin), rest = hn::Add(hn::Set(d, margin * margin), p.values[0]);
    std::uint32_t count = 0, first = 0;
    const T *block = static_cast<const T*>(data.blocks), *end = static_cast<const T*>(data.end);
    for (; block < end; block += step) {
        const LoadColumn<T> column{block};
        const auto in =
            hn::Le(Form::offset(p.values + 1, column), hn::MulAdd(column(Form::reach), twice, rest));
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
void hits(const KernelData& rows, const void* poses, std::uint32_t stride, std::uint32_t count,
          std::uint8_t* hit) {
    const Lanes<T> d;
    const std::uint32_t n = static_cast<std::uint32_t>(hn::Lanes(d));
    const T* end = static_cast<const T*>(rows.end);
    for (std::uint32_t i = 0; i < count; i += n) {
        V<T> p[Form::values + 1];
        for (std::uint32_t k = 0; k <= Form::values; ++k)
            p[k] = hn::LoadU(d, static_cast<const T*>(poses) + std::size_t(k) * stride + i);
        V<T> least = farthest<T>();
        for (const T* row = static_cast<const T*>(rows.blocks); row < end; row += Form::columns)
            least = hn::Min(least, Form::offset(p + 1, BroadcastColumn<T>{row}));
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(d, hn::Le(least, p[0]), bytes);
        for (std::uint32_t k = 0; k < n; ++k) hit[i + k] = bytes[k / 8] >> (k % 8) & 1;
    }
}

template <class T, class Form>
void gaps(const KernelData& rows, const void* poses, std::uint32_t stride, std::uint32_t count, float* gap,
          std::int32_t* test) {
    const Lanes<T> d;
    const hn::RebindToSigned<Lanes<T>> di;
    const std::uint32_t n = static_cast<std::uint32_t>(hn::Lanes(d));
    const T* end = static_cast<const T*>(rows.end);
    HWY_ALIGN hwy::MakeSigned<T> tests[hn::MaxLanes(Lanes<T>())];
    HWY_ALIGN T least[hn::MaxLanes(Lanes<T>())];
    for (std::uint32_t i = 0; i < count; i += n) {
        V<T> p[Form::values + 1];
        for (std::uint32_t k = 0; k <= Form::values; ++k)
            p[k] = hn::LoadU(d, static_cast<const T*>(poses) + std::size_t(k) * stride + i);
        Nearest<T> nearest{farthest<T>(), hn::BitCast(d, hn::Set(di, -1))};
        for (const T* row = static_cast<const T*>(rows.blocks); row < end; row += Form::columns) {
            const BroadcastColumn<T> column{row};
            nearest.take(gapOf<T, Form>(p, column), column(Form::reach + 1));
        }
        hn::Store(nearest.gap, d, least);
        hn::Store(hn::BitCast(di, nearest.number), di, tests);
        for (std::uint32_t k = 0; k < n; ++k) {
            gap[i + k] = static_cast<float>(least[k]);
            test[i + k] = static_cast<std::int32_t>(tests[k]);
        }
    }
}

/// sinVersin of as many angles as a vector has lanes.
HWY_INLINE void sineVersine(V<double> x, V<double>& sine, V<double>& versine) {
    const Lanes<double> d;
    const hn::RebindToSigned<Lanes<double>> di;
    const auto number = [&](double v) { return hn::Set(d, v); };
    const SineSeries series;
    const V<double> shifted = hn::MulAdd(x, number(series.perTurn), number(series.shift));
    const V<double> turns = hn::Sub(shifted, number(series.shift));
    const V<double> r =
        hn::NegMulAdd(turns, number(series.low), hn::NegMulAdd(turns, number(series.high), x));
    const V<double> z = hn::Mul(r, r);
    V<double> s = number(series.sine[7]), v = number(series.versine[7]);
    for (int k = 7; k-- > 0;) {
        s = hn::MulAdd(s, z, number(series.sine[k]));
        v = hn::MulAdd(v, z, number(series.versine[k]));
    }
    s = hn::MulAdd(hn::Mul(r, z), s, r);
    v = hn::Mul(v, z);
    const auto quadrant = hn::BitCast(di, shifted);
    const auto odd = hn::MaskFromVec(hn::BitCast(d, hn::Neg(hn::And(quadrant, hn::Set(di, 1)))));
    const auto sign = hn::BitCast(d, hn::ShiftLeft<62>(hn::And(quadrant, hn::Set(di, 2))));
    const V<double> one = number(1), base = hn::IfThenElse(odd, one, hn::Sub(one, hn::Xor(one, sign)));
    sine = hn::Xor(hn::IfThenElse(odd, hn::Sub(one, v), s), sign);
    versine = hn::Add(base, hn::Xor(hn::IfThenElse(odd, s, v), sign));
}

HWY_INLINE void storePoses(V<double> value, double* to) {
    hn::StoreU(value, Lanes<double>(), to);
}
HWY_INLINE void storePoses(V<double> value, float* to) {
    const hn::Rebind<float, Lanes<double>> d;
    hn::StoreU(hn::DemoteTo(d, value), d, to);
}

template <class T>
void foldPoses(const Fold& fold, const double* q, std::uint32_t count, std::uint32_t stride, void* poses) {
    const Lanes<double> d;
    const std::uint32_t n = static_cast<std::uint32_t>(hn::Lanes(d));
    const std::size_t dofs = fold.factors.size();
    HWY_ALIGN double values[hn::MaxLanes(Lanes<double>())];
    V<double> u[Fold::maxDofs][3];
    const auto product = [&](const Fold::Feature& feature) {
        V<double> value = hn::Set(d, 1);
        for (std::size_t k = 0; k < dofs; ++k)
            if (feature.factor[k] != 0) value = hn::Mul(value, u[k][feature.factor[k]]);
        return hn::Sub(value, hn::Set(d, feature.centre));
    };
    for (std::uint32_t i = 0; i < count; i += n) {
        for (std::size_t k = 0; k < dofs; ++k) {
            for (std::uint32_t j = 0; j < n; ++j) values[j] = q[std::min(i + j, count - 1) * dofs + k];
            const V<double> x = hn::Sub(hn::Load(d, values), hn::Set(d, fold.factors[k].middle));
            if (fold.factors[k].turn) {
                sineVersine(x, u[k][1], u[k][2]);
            } else {
                u[k][1] = x;
                u[k][2] = hn::Mul(x, x);
            }
        }
        V<double> shared = hn::Zero(d);
        for (std::size_t k = 0; k < fold.sharedFeatures.size(); ++k)
            shared = hn::MulAdd(hn::Set(d, fold.sharedWeights[k]), product(fold.sharedFeatures[k]), shared);
        T* to = static_cast<T*>(poses) + i;
        storePoses(hn::Neg(shared), to);
        for (const Fold::Feature& feature : fold.features) storePoses(product(feature), to += stride);
    }
}

#if HWY_MAX_BYTES >= 32
/// plainContact with a point in one vector, its last number being 1 or 0.
void contact(const ContactTest& test, const MotionFrame& frame, std::size_t dofs, TableContact& out) {
    const hn::FixedTag<double, 4> d;
    const auto splat = [&](double v) { return hn::Set(d, v); };
    const auto sum = [&](auto v) {
        const hn::Half<decltype(d)> half;
        return hn::GetLane(hn::SumOfLanes(half, hn::Add(hn::LowerHalf(half, v), hn::UpperHalf(half, v))));
    };
    HWY_ALIGN constexpr std::int64_t later[4] = {1, 2, 0, 3}, shifted[4] = {3, 0, 1, 2};
    const auto yzx = hn::SetTableIndices(d, later), wxyz = hn::SetTableIndices(d, shifted);

    const double* columns = frame.pose.data();
    auto centre = hn::MulAdd(hn::LoadU(d, columns), splat(test.b[0]), hn::LoadU(d, columns + 12));
    centre = hn::MulAdd(hn::LoadU(d, columns + 4), splat(test.b[1]), centre);
    centre = hn::MulAdd(hn::LoadU(d, columns + 8), splat(test.b[2]), centre);
    const auto a = hn::Load(d, test.a);
    const auto between = hn::Sub(centre, a);
    const auto distance = hn::Sqrt(hn::Set(d, sum(hn::Mul(between, between))));
    HWY_ALIGN constexpr double unitX[4] = {1, 0, 0, 0};
    // No distance but 0 is below 2e-162: what is not taken is not 0 / 0 then.
    const auto divisor = hn::Max(distance, splat(1e-200));
    const auto normal =
        hn::IfThenElse(hn::Gt(distance, hn::Zero(d)), hn::Div(between, divisor), hn::Load(d, unitX));
    const double length = hn::GetLane(distance);
    out.gap = length - test.reach;
    // The fourth number of each is overwritten by what comes after it, of the gradient if nothing else.
    hn::StoreU(hn::MulAdd(normal, splat(0.5 * length + test.middle), a), d, out.point.data());
    hn::StoreU(normal, d, out.normal.data());
    const auto arm = hn::TableLookupLanes(hn::MulSub(centre, hn::TableLookupLanes(normal, yzx),
                                                     hn::Mul(hn::TableLookupLanes(centre, yzx), normal)),
                                          yzx);
    // Of turn and slide, six numbers in a row, the first four and the last four: what is double weighs
    // nothing.
    const auto slideOnly = hn::TableLookupLanes(normal, wxyz);
    for (std::size_t k = 0; k < dofs; ++k) {
        const double* twist = frame.twists[k].turn.data();
        out.gradient[k] =
            sum(hn::MulAdd(hn::LoadU(d, twist), arm, hn::Mul(hn::LoadU(d, twist + 2), slideOnly)));
    }
}
#else
constexpr auto contact = plainContact;
#endif

template <class T, class Form>
KernelSet kernels() {
    return {static_cast<std::uint32_t>(hn::Lanes(Lanes<T>())),
            hit<T, Form>,
            gap<T, Form>,
            under<T, Form>,
            hits<T, Form>,
            gaps<T, Form>,
            nullptr,
            contact};
}

template <class T, std::uint32_t M>
KernelSet folded() {
    KernelSet set = kernels<T, FoldForm<T, M>>();
    set.foldPoses = foldPoses<T>;
    return set;
}

template <class T>
KernelSet fold(std::uint32_t features) {
    switch (features) {
    case 0:
        return folded<T, 0>();
    case 1:
        return folded<T, 1>();
    case 2:
        return folded<T, 2>();
    case 3:
        return folded<T, 3>();
    case 4:
        return folded<T, 4>();
    case 5:
        return folded<T, 5>();
    case 6:
        return folded<T, 6>();
    case 7:
        return folded<T, 7>();
    case 8:
        return folded<T, 8>();
    case 9:
        return folded<T, 9>();
    case 10:
        return folded<T, 10>();
    }
    return {};
}

template <class T>
KernelSet direct() {
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
KernelSet vectorFoldKernels(KernelTarget target, std::uint32_t features) {
    TSS_TARGETS(fold<T>(features))
    (void)target, (void)features;
    return {};
}
template <class T>
KernelSet vectorDirectKernels(KernelTarget target) {
    TSS_TARGETS(direct<T>())
    (void)target;
    return {};
}
template KernelSet vectorFoldKernels<float>(KernelTarget, std::uint32_t);
template KernelSet vectorFoldKernels<double>(KernelTarget, std::uint32_t);
template KernelSet vectorDirectKernels<float>(KernelTarget);
template KernelSet vectorDirectKernels<double>(KernelTarget);

} // namespace tss
#endif
