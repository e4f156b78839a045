// The queries of one pose, against vectors of pairs.
#include "bake/table/VectorTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/table/QueryKernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/table/KernelsVector.h"
#include "bake/table/QueryForms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR

template <class T, class Form>
bool hitNear(const KernelData& data, const void* pose, const NearBlocks& near) {
    const Lanes<T> d;
    const Broadcast<T, Form::values> p(pose);
    V<T> least = farthest<T>();
    SomeBlocks<T, Form>{data, near}.each(
        [&](const T* block) { least = hn::Min(least, Form::offset(p.values + 1, LoadColumn<T>{block})); });
    return !hn::AllFalse(d, hn::Le(least, p.values[0]));
}

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

/// The least lane, and the number of its test.
template <class T>
HWY_INLINE KernelGap leastOf(const Nearest<T>& nearest) {
    using Number = hwy::MakeSigned<T>;
    const Lanes<T> d;
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
KernelGap gap(const KernelData& data, const void* pose) {
    const Broadcast<T, Form::values> p(pose);
    const std::size_t step = Form::columns * hn::Lanes(Lanes<T>());
    const T *block = static_cast<const T*>(data.blocks), *end = static_cast<const T*>(data.end);
    const LoadColumn<T> first{block};
    Nearest<T> nearest{gapOf<T, Form>(p.values, first), first(Form::contactDistance + 1)};
    for (block += step; block < end; block += step) {
        const LoadColumn<T> column{block};
        nearest.take(gapOf<T, Form>(p.values, column), column(Form::contactDistance + 1));
    }
    return leastOf(nearest);
}

template <class T, class Form>
KernelGap gapNear(const KernelData& data, const void* pose, const NearBlocks& near) {
    const Lanes<T> d;
    const Broadcast<T, Form::values> p(pose);
    Nearest<T> nearest{farthest<T>(), hn::BitCast(d, hn::Set(hn::RebindToSigned<Lanes<T>>(), -1))};
    SomeBlocks<T, Form>{data, near}.each([&](const T* block) {
        const LoadColumn<T> column{block};
        nearest.take(gapOf<T, Form>(p.values, column), column(Form::contactDistance + 1));
    });
    return leastOf(nearest);
}

template <class T, class Form, class Blocks>
HWY_INLINE std::uint32_t allTestsWithin(const Blocks& blocks, const void* pose, double marginWide,
                                        std::uint32_t* out) {
    const Lanes<T> d;
    const Broadcast<T, Form::values> p(pose);
    const T margin = static_cast<T>(marginWide);
    const V<T> twice = hn::Set(d, 2 * margin), rest = hn::Add(hn::Set(d, margin * margin), p.values[0]);
    std::uint32_t count = 0;
    blocks.each([&](const T* block) {
        const LoadColumn<T> column{block};
        const auto in = hn::Le(Form::offset(p.values + 1, column),
                               hn::MulAdd(column(Form::contactDistance), twice, rest));
        if (hn::AllFalse(d, in)) return;
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(d, in, bytes);
        const T* numbers = block + (Form::contactDistance + 1) * hn::Lanes(d);
        for (unsigned bits = bytes[0] | unsigned(bytes[1]) << 8; bits != 0; bits &= bits - 1) {
            hwy::MakeSigned<T> number;
            hwy::CopyBytes<sizeof(T)>(numbers + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits), &number);
            out[count++] = static_cast<std::uint32_t>(number);
        }
    });
    return count;
}

template <class T, class Form>
std::uint32_t testsWithin(const KernelData& data, const void* pose, double margin, std::uint32_t* out) {
    return allTestsWithin<T, Form>(AllBlocks<T, Form>{data}, pose, margin, out);
}
template <class T, class Form>
std::uint32_t testsWithinNear(const KernelData& data, const void* pose, const NearBlocks& near, double margin,
                              std::uint32_t* out) {
    return allTestsWithin<T, Form>(SomeBlocks<T, Form>{data, near}, pose, margin, out);
}

template <class T>
void queries(const KernelShape& shape, KernelSet& set) {
    withForm<T>(shape, [&](auto form) {
        using Form = decltype(form);
        set.lanes = static_cast<std::uint32_t>(hn::Lanes(Lanes<T>()));
        set.hit = hit<T, Form>;
        set.gap = gap<T, Form>;
        set.testsWithin = testsWithin<T, Form>;
        set.hitNear = hitNear<T, Form>;
        set.gapNear = gapNear<T, Form>;
        set.testsWithinNear = testsWithinNear<T, Form>;
    });
}

#endif

} // namespace
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

template <class T>
void addQueries(KernelTarget target, const KernelShape& shape, KernelSet& set) {
    TSS_TARGETS(queries<T>(shape, set))
    (void)target, (void)shape, (void)set;
}
template void addQueries<float>(KernelTarget, const KernelShape&, KernelSet&);
template void addQueries<double>(KernelTarget, const KernelShape&, KernelSet&);

} // namespace tss
#endif
