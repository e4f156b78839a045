#include "bake/table/KernelsScalar.h"

#include <cmath>
#include <limits>

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
T leastOffset(const KernelData<T>& data, const T* pose, std::uint32_t stride) {
    T least = std::numeric_limits<T>::max();
    const std::uint32_t width = Row::width(data.columns);
    for (std::uint32_t i = 0; i < data.blockCount; ++i)
        least = std::min(least, Row::offset(data.blocks + i * width, pose, stride, data.columns));
    return least;
}

template <class T, class Row>
KernelGap<T> leastGap(const KernelData<T>& data, const T* pose, std::uint32_t stride, T shared) {
    KernelGap<T> best{std::numeric_limits<T>::max(), -1};
    const std::uint32_t width = Row::width(data.columns);
    for (std::uint32_t i = 0; i < data.blockCount; ++i) {
        const T* row = data.blocks + i * width;
        const T square = Row::square(row, pose, stride, data.columns) + shared;
        const T gap = std::sqrt(std::max(square, T(0))) - Row::reach(row, data.columns);
        if (gap < best.gap) best = {gap, static_cast<std::int32_t>(i)};
    }
    return best;
}

template <class T, class Row>
bool hit(const KernelData<T>& data, const T* pose, T shared) {
    return leastOffset<T, Row>(data, pose, 1) <= -shared;
}

template <class T, class Row>
KernelGap<T> gap(const KernelData<T>& data, const T* pose, T shared) {
    return leastGap<T, Row>(data, pose, 1, shared);
}

template <class T, class Row>
std::uint32_t under(const KernelData<T>& data, const T* pose, T shared, T margin, std::uint32_t* out) {
    std::uint32_t count = 0;
    const std::uint32_t width = Row::width(data.columns);
    for (std::uint32_t i = 0; i < data.blockCount; ++i) {
        const T* row = data.blocks + i * width;
        const T allowed = margin * (2 * Row::reach(row, data.columns) + margin) - shared;
        if (Row::offset(row, pose, 1, data.columns) <= allowed) out[count++] = i;
    }
    return count;
}

template <class T, class Row>
void hits(const KernelData<T>& rows, const T* poses, std::uint32_t stride, const T* shared,
          std::uint32_t count, T* least) {
    for (std::uint32_t i = 0; i < count; ++i)
        least[i] = leastOffset<T, Row>(rows, poses + i, stride) + shared[i];
}

template <class T, class Row>
void gaps(const KernelData<T>& rows, const T* poses, std::uint32_t stride, const T* shared,
          std::uint32_t count, T* gap, std::int32_t* test) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const KernelGap<T> best = leastGap<T, Row>(rows, poses + i, stride, shared[i]);
        gap[i] = best.gap;
        test[i] = best.test;
    }
}

template <class T, class Row>
KernelSet<T> kernels() {
    return {1, hit<T, Row>, gap<T, Row>, under<T, Row>, hits<T, Row>, gaps<T, Row>};
}

} // namespace

template <class T>
KernelSet<T> scalarFoldKernels() {
    return kernels<T, FoldRow<T>>();
}
template <class T>
KernelSet<T> scalarDirectKernels() {
    return kernels<T, DirectRow<T>>();
}
template KernelSet<float> scalarFoldKernels<float>();
template KernelSet<double> scalarFoldKernels<double>();
template KernelSet<float> scalarDirectKernels<float>();
template KernelSet<double> scalarDirectKernels<double>();

} // namespace tss
