// The queries of many poses: vectors of poses against one pair after the other.
#include "bake/table/VectorTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/table/CrowdKernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/table/KernelsVector.h"
#include "bake/table/QueryForms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

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
void crowdIn(const KernelShape& shape, KernelSet& set) {
    withForm<D>(shape, [&](auto form) { set.hits = hits<decltype(form)>; });
}
template <class T>
void crowd(const KernelShape& shape, KernelSet& set) {
    crowdIn<hn::ScalableTag<T>>(shape, set);
}
template <class T>
void scalarCrowd(const KernelShape& shape, KernelSet& set) {
    crowdIn<hn::CappedTag<T, 1>>(shape, set);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <hwy/targets.h>

namespace tss {

template <class T>
void addCrowd(KernelTarget target, const KernelShape& shape, KernelSet& set) {
    TSS_TARGETS(crowd<T>(shape, set))
    (void)target;
    HWY_STATIC_DISPATCH(scalarCrowd<T>)(shape, set);
}
template void addCrowd<float>(KernelTarget, const KernelShape&, KernelSet&);
template void addCrowd<double>(KernelTarget, const KernelShape&, KernelSet&);

} // namespace tss
#endif
