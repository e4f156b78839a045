#include "bake/table/KernelsScalar.h"

#include "bake/table/Contact.h"

#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

namespace tss {

namespace {

/// Squared distance less `constant` of the fold's row.
template <class T>
struct FoldRow {
    static T offset(const T* row, const T* pose, std::uint32_t stride, std::uint32_t columns) {
        T sum = row[0];
        for (std::uint32_t k = 0; k < columns; ++k) sum += row[k + 1] * pose[k * stride];
        return sum;
    }
    static T square(const T* row, const T* pose, std::uint32_t stride, std::uint32_t columns) {
        T sum = row[columns + 1];
        for (std::uint32_t k = 0; k < columns; ++k) sum += row[k + 1] * pose[k * stride];
        return sum;
    }
    static T reach(const T* row, std::uint32_t columns) { return row[columns + 2]; }
    static std::uint32_t width(std::uint32_t columns) { return foldColumns(columns); }
};

template <class T>
struct DirectRow {
    static T square(const T* row, const T* p, std::uint32_t s, std::uint32_t) {
        const T x = (p[3 * s] - row[3]) + p[0] * row[0] + p[s] * row[1] + p[2 * s] * row[2];
        const T y = (p[7 * s] - row[4]) + p[4 * s] * row[0] + p[5 * s] * row[1] + p[6 * s] * row[2];
        const T z = (p[11 * s] - row[5]) + p[8 * s] * row[0] + p[9 * s] * row[1] + p[10 * s] * row[2];
        return x * x + y * y + z * z;
    }
    static T offset(const T* row, const T* p, std::uint32_t s, std::uint32_t c) {
        return square(row, p, s, c) - row[6];
    }
    static T reach(const T* row, std::uint32_t) { return row[7]; }
    static std::uint32_t width(std::uint32_t) { return directColumns; }
};

template <class T, class Row>
T leastOffset(const KernelData& data, const T* pose, std::uint32_t stride) {
    T least = std::numeric_limits<T>::max();
    const T* end = static_cast<const T*>(data.end);
    for (const T* row = static_cast<const T*>(data.blocks); row < end; row += Row::width(data.columns))
        least = std::min(least, Row::offset(row, pose + stride, stride, data.columns));
    return least;
}

template <class T, class Row>
KernelGap leastGap(const KernelData& data, const T* pose, std::uint32_t stride) {
    T best = std::numeric_limits<T>::max();
    using Number = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
    std::int32_t test = -1;
    const T* end = static_cast<const T*>(data.end);
    for (const T* row = static_cast<const T*>(data.blocks); row < end; row += Row::width(data.columns)) {
        const T square = Row::square(row, pose + stride, stride, data.columns) - pose[0];
        const T gap = std::sqrt(std::max(square, T(0))) - Row::reach(row, data.columns);
        if (gap < best) {
            best = gap;
            // Not a count: the one row of an empty table is no test.
            test = static_cast<std::int32_t>(std::bit_cast<Number>(row[Row::width(data.columns) - 1]));
        }
    }
    return {static_cast<double>(best), test};
}

template <class T, class Row>
bool hit(const KernelData& data, const void* pose) {
    const T* values = static_cast<const T*>(pose);
    return leastOffset<T, Row>(data, values, 1) <= values[0];
}

template <class T, class Row>
KernelGap gap(const KernelData& data, const void* pose) {
    return leastGap<T, Row>(data, static_cast<const T*>(pose), 1);
}

template <class T, class Row>
std::uint32_t under(const KernelData& data, const void* pose, double marginWide, std::uint32_t* out) {
    const T* values = static_cast<const T*>(pose);
    const T margin = static_cast<T>(marginWide);
    std::uint32_t count = 0, number = 0;
    const T* end = static_cast<const T*>(data.end);
    for (const T* row = static_cast<const T*>(data.blocks); row < end; row += Row::width(data.columns)) {
        const T allowed = margin * (2 * Row::reach(row, data.columns) + margin) + values[0];
        if (Row::offset(row, values + 1, 1, data.columns) <= allowed) out[count++] = number;
        ++number;
    }
    return count;
}

template <class T, class Row>
void hits(const KernelData& rows, const void* poses, std::uint32_t stride, std::uint32_t count,
          std::uint8_t* hit) {
    const T* values = static_cast<const T*>(poses);
    for (std::uint32_t i = 0; i < count; ++i)
        hit[i] = leastOffset<T, Row>(rows, values + i, stride) <= values[i];
}

template <class T, class Row>
void gaps(const KernelData& rows, const void* poses, std::uint32_t stride, std::uint32_t count, float* gap,
          std::int32_t* test) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const KernelGap best = leastGap<T, Row>(rows, static_cast<const T*>(poses) + i, stride);
        gap[i] = static_cast<float>(best.gap);
        test[i] = best.test;
    }
}

template <class T, class Row>
KernelSet kernels() {
    return {1,       hit<T, Row>, gap<T, Row>, under<T, Row>, hits<T, Row>, gaps<T, Row>,
            nullptr, nullptr,     plainContact};
}

} // namespace

template <class T>
KernelSet scalarFoldKernels() {
    return kernels<T, FoldRow<T>>();
}
template <class T>
KernelSet scalarDirectKernels() {
    return kernels<T, DirectRow<T>>();
}
template KernelSet scalarFoldKernels<float>();
template KernelSet scalarFoldKernels<double>();
template KernelSet scalarDirectKernels<float>();
template KernelSet scalarDirectKernels<double>();

} // namespace tss
