#include "bake/table/TableKernels.h"

#include <algorithm>

namespace tss {

namespace {

/// Kernels take whole vectors of poses, 16 at most.
constexpr std::uint32_t vectorRoom = 16;

template <class T>
const T* from(const std::vector<T>& values, std::uint32_t first) {
    return values.data() + first;
}

/// The pose of one of many instances.
TableFeatures featuresOf(const InstanceFeatures& f, std::uint32_t instance, bool single) {
    TableFeatures one;
    const std::size_t values = (single ? f.floats.size() : f.doubles.size()) / f.stride;
    for (std::size_t k = 0; k < values; ++k)
        if (single)
            one.floats[k] = f.floats[k * f.stride + instance];
        else
            one.doubles[k] = f.doubles[k * f.stride + instance];
    return one;
}

} // namespace

void TableKernels::instanceFeatures(const double* q, std::uint32_t count, InstanceFeatures& out) const {
    // What is beyond the count is computed and not looked at.
    out.count = count;
    out.stride = (count + vectorRoom - 1) / vectorRoom * vectorRoom;
    const std::size_t values = featureCount() + 1, dofs = dofCount();
    if (float_)
        out.floats.resize(values * out.stride);
    else
        out.doubles.resize(values * out.stride);
    if (kernels_.poses) {
        kernels_.poses(plan_, q, count, out.stride,
                       float_ ? static_cast<void*>(out.floats.data()) : out.doubles.data());
        return;
    }
    TableFeatures one;
    for (std::uint32_t i = 0; i < count; ++i) {
        features(q + i * dofs, one);
        for (std::size_t k = 0; k < values; ++k)
            if (float_)
                out.floats[k * out.stride + i] = one.floats[k];
            else
                out.doubles[k * out.stride + i] = one.doubles[k];
    }
}

void TableKernels::hits(const InstanceFeatures& f, std::uint8_t* hit) const {
    if (!clusters_.empty()) {
        for (std::uint32_t i = 0; i < f.count; ++i) hit[i] = hitInClusters(featuresOf(f, i, float_));
        return;
    }
    const std::uint32_t whole = f.count / vectorRoom * vectorRoom, rest = f.count - whole;
    const auto run = [&](std::uint32_t first, std::uint32_t count, std::uint8_t* out) {
        if (count == 0) return;
        const void* poses = float_ ? static_cast<const void*>(from(f.floats, first)) : from(f.doubles, first);
        kernels_.hits(rows_, poses, f.stride, count, out);
    };
    run(0, whole, hit);
    std::uint8_t last[vectorRoom];
    run(whole, rest, last);
    std::copy_n(last, rest, hit + whole);
}

} // namespace tss
