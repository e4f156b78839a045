// The queries: of one pose against vectors of pairs, and of vectors of poses against one pair after the
// other.
#include "bake/table/VectorTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/table/QueryKernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/table/Kernels.h"
#include "bake/table/QueryForms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

template <class Form>
bool hitNear(const KernelData& data, const void* pose, const NearBlocks& near) {
    using D = typename Form::D;
    const Broadcast<D, Form::values> p(pose);
    V<D> least = farthest<D>();
    SomeBlocks<Form>{data, near}.each(
        [&](const auto* block) { least = smaller(least, Form::offset(p.values + 1, LoadColumn<D>{block})); });
    return !hn::AllFalse(D(), hn::Le(least, p.values[0]));
}

template <class Form>
bool hit(const KernelData& data, const void* pose) {
    using D = typename Form::D;
    using T = hn::TFromD<D>;
    const Broadcast<D, Form::values> p(pose);
    const std::size_t step = Form::columns * hn::Lanes(D());
    const T *block = static_cast<const T*>(data.blocks), *end = static_cast<const T*>(data.end);
    // The first block starts the minimum; then two sums at a time, so that one need not wait for the other.
    V<D> least = Form::offset(p.values + 1, LoadColumn<D>{block});
    block += step;
    for (const T* last = end - step; block < last; block += 2 * step) {
        const V<D> one = Form::offset(p.values + 1, LoadColumn<D>{block});
        const V<D> two = Form::offset(p.values + 1, LoadColumn<D>{block + step});
        least = smaller(least, smaller(one, two));
    }
    if (block != end) least = smaller(least, Form::offset(p.values + 1, LoadColumn<D>{block}));
    return !hn::AllFalse(D(), hn::Le(least, p.values[0]));
}

/// The least lane, and the number of its test.
template <class D>
HWY_INLINE KernelGap leastOf(const Nearest<D>& nearest) {
    const D d;
    const hn::RebindToSigned<D> di;
    const V<D> least = hn::MinOfLanes(d, nearest.gap);
    // A pose that is not a number equals nothing: whatever lane that gives is as good as any.
    const auto equal = hn::Eq(nearest.gap, least);
    const std::size_t at = static_cast<std::size_t>(hn::FindFirstTrue(d, equal)) & (hn::Lanes(d) - 1);
    hn::TFromD<decltype(di)> numbers[hn::MaxLanes(D())];
    hn::StoreU(hn::BitCast(di, nearest.number), di, numbers);
    return {static_cast<double>(hn::GetLane(least)), static_cast<std::int32_t>(numbers[at])};
}

template <class Form>
KernelGap gap(const KernelData& data, const void* pose) {
    using D = typename Form::D;
    using T = hn::TFromD<D>;
    const Broadcast<D, Form::values> p(pose);
    const std::size_t step = Form::columns * hn::Lanes(D());
    const T *block = static_cast<const T*>(data.blocks), *end = static_cast<const T*>(data.end);
    const LoadColumn<D> first{block};
    Nearest<D> nearest{gapOf<Form>(p.values, first), first(Form::contactDistance + 1)};
    for (block += step; block < end; block += step) {
        const LoadColumn<D> column{block};
        nearest.take(gapOf<Form>(p.values, column), column(Form::contactDistance + 1));
    }
    return leastOf(nearest);
}

template <class Form>
KernelGap gapNear(const KernelData& data, const void* pose, const NearBlocks& near) {
    using D = typename Form::D;
    const Broadcast<D, Form::values> p(pose);
    Nearest<D> nearest{farthest<D>(), hn::BitCast(D(), hn::Set(hn::RebindToSigned<D>(), -1))};
    SomeBlocks<Form>{data, near}.each([&](const auto* block) {
        const LoadColumn<D> column{block};
        nearest.take(gapOf<Form>(p.values, column), column(Form::contactDistance + 1));
    });
    return leastOf(nearest);
}

template <class Form, class Blocks>
HWY_INLINE std::uint32_t allTestsWithin(const Blocks& blocks, const void* pose, double marginWide,
                                        std::uint32_t* out) {
    using D = typename Form::D;
    using T = hn::TFromD<D>;
    const D d;
    const Broadcast<D, Form::values> p(pose);
    const T margin = static_cast<T>(marginWide);
    const V<D> twice = hn::Set(d, 2 * margin), rest = hn::Add(hn::Set(d, margin * margin), p.values[0]);
    std::uint32_t count = 0;
    blocks.each([&](const T* block) {
        const LoadColumn<D> column{block};
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

template <class Form>
std::uint32_t testsWithin(const KernelData& data, const void* pose, double margin, std::uint32_t* out) {
    return allTestsWithin<Form>(AllBlocks<Form>{data}, pose, margin, out);
}
template <class Form>
std::uint32_t testsWithinNear(const KernelData& data, const void* pose, const NearBlocks& near, double margin,
                              std::uint32_t* out) {
    return allTestsWithin<Form>(SomeBlocks<Form>{data, near}, pose, margin, out);
}

template <class Form>
void hits(const KernelData& rows, const void* poses, std::uint32_t stride, std::uint32_t count,
          std::uint8_t* hit) {
    using D = typename Form::D;
    using T = hn::TFromD<D>;
    const D d;
    const std::uint32_t n = static_cast<std::uint32_t>(hn::Lanes(d));
    const T* end = static_cast<const T*>(rows.end);
    for (std::uint32_t i = 0; i < count; i += n) {
        V<D> p[Form::values + 1];
        for (std::uint32_t k = 0; k <= Form::values; ++k)
            p[k] = hn::LoadU(d, static_cast<const T*>(poses) + std::size_t(k) * stride + i);
        V<D> least = farthest<D>();
        for (const T* row = static_cast<const T*>(rows.blocks); row < end; row += Form::columns)
            least = smaller(least, Form::offset(p + 1, BroadcastColumn<D>{row}));
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(d, hn::Le(least, p[0]), bytes);
        for (std::uint32_t k = 0; k < n; ++k) hit[i + k] = bytes[k / 8] >> (k % 8) & 1;
    }
}

template <class D>
void queriesIn(const KernelShape& shape, KernelSet& set) {
    withForm<D>(shape, [&](auto form) {
        using Form = decltype(form);
        set.lanes = static_cast<std::uint32_t>(hn::Lanes(D()));
        set.hit = hit<Form>;
        set.gap = gap<Form>;
        set.testsWithin = testsWithin<Form>;
        set.hitNear = hitNear<Form>;
        set.gapNear = gapNear<Form>;
        set.testsWithinNear = testsWithinNear<Form>;
        set.hits = hits<Form>;
    });
}
template <class T>
void queries(const KernelShape& shape, KernelSet& set) {
    queriesIn<hn::ScalableTag<T>>(shape, set);
}
/// A pair at a time, with what this build may always use.
template <class T>
void scalarQueries(const KernelShape& shape, KernelSet& set) {
    queriesIn<hn::CappedTag<T, 1>>(shape, set);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tss {

template <class T>
void addQueries(KernelTarget target, const KernelShape& shape, KernelSet& set) {
    TSS_TARGETS(queries<T>(shape, set))
    HWY_STATIC_DISPATCH(scalarQueries<T>)(shape, set);
}
template void addQueries<float>(KernelTarget, const KernelShape&, KernelSet&);
template void addQueries<double>(KernelTarget, const KernelShape&, KernelSet&);

} // namespace tss
#endif
