#include "bake/table/PreparedTable.h"

#include <algorithm>

namespace tss {

void PreparedTable::instanceFeatures(const double* q, std::uint32_t count, InstanceFeatures& out) const {
    // Kernels take whole vectors of poses, 16 at most; what is beyond the count is computed and not looked
    // at.
    out.count = count;
    out.stride = (count + 15) / 16 * 16;
    const std::size_t n = featureCount(), dofs = dofCount();
    if (float_) {
        out.floats.resize(n * out.stride);
        out.sharedFloats.resize(out.stride);
    } else {
        out.doubles.resize(n * out.stride);
        out.sharedDoubles.resize(out.stride);
    }
    TableFeatures one;
    for (std::uint32_t i = 0; i < count; ++i) {
        features(q + i * dofs, one);
        if (float_) {
            for (std::size_t k = 0; k < n; ++k) out.floats[k * out.stride + i] = one.floats[k];
            out.sharedFloats[i] = float(one.shared);
        } else {
            for (std::size_t k = 0; k < n; ++k) out.doubles[k * out.stride + i] = one.doubles[k];
            out.sharedDoubles[i] = one.shared;
        }
    }
}

void PreparedTable::hits(const InstanceFeatures& f, std::uint8_t* hit) const {
    constexpr std::uint32_t chunk = 256;
    for (std::uint32_t first = 0; first < f.count; first += chunk) {
        const std::uint32_t n = std::min(chunk, f.count - first);
        if (float_) {
            alignas(64) float least[chunk];
            floatSet_.hits(floatRows_, f.floats.data() + first, f.stride, f.sharedFloats.data() + first, n,
                           least);
            for (std::uint32_t i = 0; i < n; ++i) hit[first + i] = least[i] <= 0;
        } else {
            alignas(64) double least[chunk];
            doubleSet_.hits(doubleRows_, f.doubles.data() + first, f.stride, f.sharedDoubles.data() + first,
                            n, least);
            for (std::uint32_t i = 0; i < n; ++i) hit[first + i] = least[i] <= 0;
        }
    }
}

void PreparedTable::gaps(const InstanceFeatures& f, float* gap, std::int32_t* test) const {
    constexpr std::uint32_t chunk = 256;
    alignas(64) std::int32_t tests[chunk];
    for (std::uint32_t first = 0; first < f.count; first += chunk) {
        const std::uint32_t n = std::min(chunk, f.count - first);
        if (float_) {
            alignas(64) float least[chunk];
            floatSet_.gaps(floatRows_, f.floats.data() + first, f.stride, f.sharedFloats.data() + first, n,
                           least, tests);
            std::copy_n(least, n, gap + first);
        } else {
            alignas(64) double least[chunk];
            doubleSet_.gaps(doubleRows_, f.doubles.data() + first, f.stride, f.sharedDoubles.data() + first,
                            n, least, tests);
            std::transform(least, least + n, gap + first, [](double g) { return float(g); });
        }
        std::copy_n(tests, n, test + first);
    }
}

} // namespace tss
