// What a query reads of a pose, in vectors: of one pose four numbers at a time, of many poses one value of
// several poses at a time.
#include "bake/table/VectorTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/table/PoseKernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/table/Kernels.h"
#include "bake/table/PosePlan.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
namespace hn = hwy::HWY_NAMESPACE;

/// sinVersin of as many angles as a vector has lanes.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void sineVersine(D d, V x, V& sine, V& versine) {
    const hn::RebindToSigned<D> di;
    const auto number = [&](double v) { return hn::Set(d, v); };
    constexpr SineSeries series;
    const V shifted = hn::MulAdd(x, number(series.perTurn), number(series.shift));
    const V turns = hn::Sub(shifted, number(series.shift));
    const V r = hn::NegMulAdd(turns, number(series.low), hn::NegMulAdd(turns, number(series.high), x));
    const V z = hn::Mul(r, r), z2 = hn::Mul(z, z), z4 = hn::Mul(z2, z2);
    // Sums of sums, so that few terms wait for one another.
    const auto sum = [&](const double(&c)[8]) {
        const auto pair = [&](int k) { return hn::MulAdd(number(c[k + 1]), z, number(c[k])); };
        return hn::MulAdd(hn::MulAdd(pair(6), z2, pair(4)), z4, hn::MulAdd(pair(2), z2, pair(0)));
    };
    const V s = hn::MulAdd(hn::Mul(r, z), sum(series.sine), r), v = hn::Mul(z, sum(series.versine));
    // By quadrant: which of the two is the sine, and what is added to the other.
    const auto quadrant = hn::BitCast(di, shifted);
    const auto odd = hn::MaskFromVec(hn::BitCast(d, hn::Neg(hn::And(quadrant, hn::Set(di, 1)))));
    const V sign = hn::BitCast(d, hn::ShiftLeft<62>(hn::And(quadrant, hn::Set(di, 2))));
    const V one = number(1), base = hn::IfThenElse(odd, one, hn::Sub(one, hn::Xor(one, sign)));
    sine = hn::Xor(hn::IfThenElse(odd, hn::Sub(one, v), s), sign);
    versine = hn::Add(base, hn::Xor(hn::IfThenElse(odd, s, v), sign));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void store(D d, V value, double* to) {
    hn::StoreU(value, d, to);
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store(D, V value, float* to) {
    const hn::Rebind<float, D> single;
    hn::StoreU(hn::DemoteTo(single, value), single, to);
}

// ---- many poses ----

using Doubles = hn::ScalableTag<double>;
using V = hn::Vec<Doubles>;

/// Both factors of DOF k at poses i and on.
HWY_INLINE void factorsOf(const PosePlan& plan, std::size_t k, const double* q, std::uint32_t i,
                          std::uint32_t count, V& first, V& second) {
    const Doubles d;
    HWY_ALIGN double values[hn::MaxLanes(Doubles())];
    for (std::uint32_t j = 0; j < hn::Lanes(d); ++j)
        values[j] = q[std::min(i + j, count - 1) * plan.dofs + k];
    const V x = hn::Sub(hn::Load(d, values), hn::Set(d, plan.middle[k]));
    if (plan.turn[k]) {
        sineVersine(d, x, first, second);
    } else {
        first = x;
        second = hn::Mul(x, x);
    }
}

template <class T>
void foldPoses(const PosePlan& plan, const double* q, std::uint32_t count, std::uint32_t stride,
               void* poses) {
    const Doubles d;
    V u[FeatureForm::maxDofs][3];
    for (auto& ofDof : u) ofDof[2] = hn::Set(d, 1);
    const auto product = [&](const PosePlan::Products& products, std::size_t lane) {
        V value = hn::Set(d, 1);
        for (std::size_t k = 0; k < plan.dofs; ++k)
            value = hn::Mul(value, u[k][products.factor[k][2 * lane] / 2]);
        return hn::Sub(value, hn::Set(d, products.centre[lane]));
    };
    for (std::uint32_t i = 0; i < count; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
        for (std::size_t k = 0; k < plan.dofs; ++k) factorsOf(plan, k, q, i, count, u[k][0], u[k][1]);
        V shared = hn::Zero(d);
        for (const PosePlan::Products& products : plan.shared)
            for (std::size_t lane = 0; lane < PosePlan::lanes; ++lane)
                shared = hn::MulAdd(hn::Set(d, products.weight[lane]), product(products, lane), shared);
        T* to = static_cast<T*>(poses) + i;
        store(d, hn::Neg(shared), to);
        for (std::size_t f = 0; f < plan.featureCount; ++f)
            store(d, product(plan.features[f / PosePlan::lanes], f % PosePlan::lanes), to += stride);
    }
}

template <class T>
void directPoses(const PosePlan& plan, const double* q, std::uint32_t count, std::uint32_t stride,
                 void* poses) {
    const Doubles d;
    for (std::uint32_t i = 0; i < count; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
        V whole[12];
        std::fill_n(whole, 12, hn::Zero(d)); // which compilers cannot see to be overwritten
        for (std::size_t k = plan.dofs; k-- > 0;) {
            V first, second, own[12];
            factorsOf(plan, k, q, i, count, first, second);
            const PosePlan::Step& step = plan.steps[k];
            for (int n = 0; n < 12; ++n)
                own[n] =
                    hn::MulAdd(second, hn::Set(d, step.second[n]),
                               hn::MulAdd(first, hn::Set(d, step.first[n]), hn::Set(d, step.constant[n])));
            if (k + 1 == plan.dofs) {
                std::copy(own, own + 12, whole);
                continue;
            }
            for (int c = 0; c < 4; ++c) {
                const V x = whole[c], y = whole[4 + c], z = whole[8 + c];
                for (int r = 0; r < 12; r += 4) {
                    const V sum = hn::MulAdd(own[r + 2], z, hn::MulAdd(own[r + 1], y, hn::Mul(own[r], x)));
                    whole[r + c] = c < 3 ? sum : hn::Add(sum, own[r + 3]);
                }
            }
        }
        T* to = static_cast<T*>(poses) + i;
        store(d, hn::Zero(d), to);
        for (const V& value : whole) store(d, value, to += stride);
    }
}

// ---- one pose ----

#if HWY_MAX_BYTES >= 32
using Four = hn::FixedTag<double, 4>;
using V4 = hn::Vec<Four>;

/// Both factors of DOFs k to k + 3; of those beyond the last, of 0.
HWY_INLINE void factorsOf(const PosePlan& plan, std::size_t k, const double* q, V4& first, V4& second) {
    const Four d;
    // The middle beyond the last DOF is 0, too.
    const V4 x =
        hn::Sub(hn::MaskedLoad(hn::FirstN(d, plan.dofs - k), d, q + k), hn::Load(d, plan.middle + k));
    first = x;
    second = hn::Mul(x, x);
    if (!plan.turns) return;
    V4 sine, versine;
    sineVersine(d, x, sine, versine);
    const hn::RebindToSigned<Four> di;
    const auto turn = hn::MaskFromVec(hn::BitCast(d, hn::Load(di, plan.turn + k)));
    first = hn::IfThenElse(turn, sine, first);
    second = hn::IfThenElse(turn, versine, second);
}

template <class T, std::size_t dofs>
void foldPose(const PosePlan& plan, const double* q, void* pose) {
    const Four d;
    // Numbers of 64 bits are picked as two halves: their indices need no unpacking.
    const hn::FixedTag<float, 8> halves;
    V4 first = hn::Zero(d), second = first;
    if constexpr (dofs > 0) factorsOf(plan, 0, q, first, second);
    const V4 one = hn::Set(d, 1);
    const V4 even = hn::InterleaveLower(d, first, second), odd = hn::InterleaveUpper(d, first, second);
    // Of each DOF: first factor, second, 1, 1.
    const V4 of[3] = {hn::ConcatUpperLower(d, one, even), hn::ConcatUpperLower(d, one, odd),
                      hn::ConcatUpperUpper(d, one, even)};
    const auto products = [&](const PosePlan::Products& p) {
        V4 value = one;
        for (std::size_t k = 0; k < dofs; ++k) {
            const auto picked =
                hn::BitCast(d, hn::TableLookupLanes(hn::BitCast(halves, of[k]),
                                                    hn::SetTableIndices(halves, p.factor[k])));
            value = k == 0 ? picked : hn::Mul(value, picked);
        }
        return hn::Sub(value, hn::Load(d, p.centre));
    };
    T* to = static_cast<T*>(pose);
    T* feature = to + 1;
    for (const PosePlan::Products& p : plan.features) {
        store(d, products(p), feature);
        feature += PosePlan::lanes;
    }
    if (plan.shared.empty()) {
        *to = 0;
        return;
    }
    V4 sum = hn::Zero(d);
    for (const PosePlan::Products& p : plan.shared) sum = hn::MulAdd(products(p), hn::Load(d, p.weight), sum);
    const hn::Half<Four> half;
    const auto two = hn::Add(hn::LowerHalf(half, sum), hn::UpperHalf(half, sum));
    *to = static_cast<T>(-hn::GetLane(hn::SumOfLanes(half, two)));
}

template <class T>
void directPose(const PosePlan& plan, const double* q, void* pose) {
    const Four d;
    alignas(32) double first[PosePlan::room], second[PosePlan::room];
    for (std::size_t k = 0; k < plan.dofs; k += PosePlan::lanes) {
        V4 f, s;
        factorsOf(plan, k, q, f, s);
        hn::Store(f, d, first + k);
        hn::Store(s, d, second + k);
    }
    const auto ownRow = [&](std::size_t k, int r) {
        const PosePlan::Step& step = plan.steps[k];
        return hn::MulAdd(hn::Set(d, second[k]), hn::LoadU(d, step.second.data() + r),
                          hn::MulAdd(hn::Set(d, first[k]), hn::LoadU(d, step.first.data() + r),
                                     hn::LoadU(d, step.constant.data() + r)));
    };
    std::size_t k = plan.dofs - 1;
    V4 x = ownRow(k, 0), y = ownRow(k, 4), z = ownRow(k, 8);
    const auto rotation = hn::FirstN(d, 3);
    while (k-- > 0) {
        const auto times = [&](V4 own) {
            alignas(32) double number[4];
            hn::Store(own, d, number);
            const V4 move = hn::IfThenZeroElse(rotation, own);
            return hn::MulAdd(
                hn::Set(d, number[2]), z,
                hn::MulAdd(hn::Set(d, number[1]), y, hn::MulAdd(hn::Set(d, number[0]), x, move)));
        };
        const V4 newX = times(ownRow(k, 0)), newY = times(ownRow(k, 4)), newZ = times(ownRow(k, 8));
        x = newX;
        y = newY;
        z = newZ;
    }
    T* to = static_cast<T*>(pose);
    *to = 0;
    store(d, x, to + 1);
    store(d, y, to + 5);
    store(d, z, to + 9);
}
#endif

template <class T>
void poses(const KernelShape& shape, KernelSet& set) {
    set.poses = shape.folds ? foldPoses<T> : directPoses<T>;
#if HWY_MAX_BYTES >= 32
    set.pose = !shape.folds      ? directPose<T>
               : shape.dofs == 0 ? foldPose<T, 0>
               : shape.dofs == 1 ? foldPose<T, 1>
               : shape.dofs == 2 ? foldPose<T, 2>
                                 : foldPose<T, 3>;
#endif
}

#endif

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tss {

template <class T>
void addPoses(KernelTarget target, const KernelShape& shape, KernelSet& set) {
    TSS_TARGETS(poses<T>(shape, set))
    (void)shape, (void)set;
}
template void addPoses<float>(KernelTarget, const KernelShape&, KernelSet&);
template void addPoses<double>(KernelTarget, const KernelShape&, KernelSet&);

} // namespace tss
#endif
