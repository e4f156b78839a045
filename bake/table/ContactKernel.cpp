// Gap, point, normal and gradient of one test in vectors of four doubles.
#include "bake/table/VectorTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/table/ContactKernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/table/ContactTest.h"
#include "bake/table/Kernels.h"

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

#if HWY_MAX_BYTES >= 32 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
namespace hn = hwy::HWY_NAMESPACE;

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
    out.gap = length - test.contactDistance;
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
[[maybe_unused]] constexpr auto contact = plainContact;
#endif

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tss {

void addContact(KernelTarget target, KernelSet& set) {
    const auto kernel = [target]() -> decltype(set.contact) {
        TSS_TARGETS(contact)
        return plainContact;
    };
    set.contact = kernel();
}

} // namespace tss
#endif
