#include "bake/table/Kernels.h"

#include "bake/table/ContactTest.h"
#include "bake/table/KernelsVector.h"

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
    static T contactDistance(const T* row, std::uint32_t columns) { return row[columns + 2]; }
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
    static T contactDistance(const T* row, std::uint32_t) { return row[7]; }
    static std::uint32_t width(std::uint32_t) { return directColumns; }
};

/// Calls take(row) for every row.
template <class T, class Row>
struct AllRows {
    const KernelData& data;
    template <class Take>
    void each(Take take) const {
        const T* end = static_cast<const T*>(data.end);
        for (const T* row = static_cast<const T*>(data.blocks); row < end; row += Row::width(data.columns))
            take(row);
    }
};

/// The same for those that are near.
template <class T, class Row>
struct NearRows {
    const KernelData& data;
    const NearBlocks& near;
    template <class Take>
    void each(Take take) const {
        const T* rows = static_cast<const T*>(data.blocks);
        const std::size_t width = Row::width(data.columns);
        const std::size_t count = static_cast<std::size_t>(static_cast<const T*>(data.end) - rows) / width;
        for (std::size_t i = 0; i < count; ++i)
            if (near.codes[i + NearBlocks::headerCodes] <= near.limit) take(rows + i * width);
    }
};

/// Not a count: the one row of an empty table is no test.
template <class T, class Row>
std::int32_t testOf(const T* row, const KernelData& data) {
    using Number = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
    return static_cast<std::int32_t>(std::bit_cast<Number>(row[Row::width(data.columns) - 1]));
}

template <class T, class Row, class Rows>
T leastOffset(const Rows& rows, const T* pose, std::uint32_t stride) {
    T least = std::numeric_limits<T>::max();
    rows.each([&](const T* row) {
        least = std::min(least, Row::offset(row, pose + stride, stride, rows.data.columns));
    });
    return least;
}

template <class T, class Row, class Rows>
KernelGap leastGap(const Rows& rows, const T* pose, std::uint32_t stride) {
    T best = std::numeric_limits<T>::max();
    std::int32_t test = -1;
    rows.each([&](const T* row) {
        const T square = Row::square(row, pose + stride, stride, rows.data.columns) - pose[0];
        const T gap = std::sqrt(std::max(square, T(0))) - Row::contactDistance(row, rows.data.columns);
        if (gap < best) {
            best = gap;
            test = testOf<T, Row>(row, rows.data);
        }
    });
    return {static_cast<double>(best), test};
}

template <class T, class Row, class Rows>
std::uint32_t allTestsWithin(const Rows& rows, const T* pose, double marginWide, std::uint32_t* out) {
    const T margin = static_cast<T>(marginWide);
    std::uint32_t count = 0;
    rows.each([&](const T* row) {
        const T allowed = margin * (2 * Row::contactDistance(row, rows.data.columns) + margin) + pose[0];
        if (Row::offset(row, pose + 1, 1, rows.data.columns) <= allowed)
            out[count++] = static_cast<std::uint32_t>(testOf<T, Row>(row, rows.data));
    });
    return count;
}

template <class T, class Row>
bool hit(const KernelData& data, const void* pose) {
    const T* values = static_cast<const T*>(pose);
    return leastOffset<T, Row>(AllRows<T, Row>{data}, values, 1) <= values[0];
}
template <class T, class Row>
bool hitNear(const KernelData& data, const void* pose, const NearBlocks& near) {
    const T* values = static_cast<const T*>(pose);
    return leastOffset<T, Row>(NearRows<T, Row>{data, near}, values, 1) <= values[0];
}

template <class T, class Row>
KernelGap gap(const KernelData& data, const void* pose) {
    return leastGap<T, Row>(AllRows<T, Row>{data}, static_cast<const T*>(pose), 1);
}
template <class T, class Row>
KernelGap gapNear(const KernelData& data, const void* pose, const NearBlocks& near) {
    return leastGap<T, Row>(NearRows<T, Row>{data, near}, static_cast<const T*>(pose), 1);
}

template <class T, class Row>
std::uint32_t testsWithin(const KernelData& data, const void* pose, double margin, std::uint32_t* out) {
    return allTestsWithin<T, Row>(AllRows<T, Row>{data}, static_cast<const T*>(pose), margin, out);
}
template <class T, class Row>
std::uint32_t testsWithinNear(const KernelData& data, const void* pose, const NearBlocks& near, double margin,
                              std::uint32_t* out) {
    return allTestsWithin<T, Row>(NearRows<T, Row>{data, near}, static_cast<const T*>(pose), margin, out);
}

template <class T, class Row>
void hits(const KernelData& rows, const void* poses, std::uint32_t stride, std::uint32_t count,
          std::uint8_t* hit) {
    const T* values = static_cast<const T*>(poses);
    for (std::uint32_t i = 0; i < count; ++i)
        hit[i] = leastOffset<T, Row>(AllRows<T, Row>{rows}, values + i, stride) <= values[i];
}

template <class T, class Row>
void gaps(const KernelData& rows, const void* poses, std::uint32_t stride, std::uint32_t count, float* gap,
          std::int32_t* test) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const KernelGap best =
            leastGap<T, Row>(AllRows<T, Row>{rows}, static_cast<const T*>(poses) + i, stride);
        gap[i] = static_cast<float>(best.gap);
        test[i] = best.test;
    }
}

/// The kernels in plain C++, a pair at a time: what every processor has, and what the others are held to.
template <class T, class Row>
KernelSet scalarKernels() {
    KernelSet set;
    set.hit = hit<T, Row>;
    set.gap = gap<T, Row>;
    set.testsWithin = testsWithin<T, Row>;
    set.hitNear = hitNear<T, Row>;
    set.gapNear = gapNear<T, Row>;
    set.testsWithinNear = testsWithinNear<T, Row>;
    set.hits = hits<T, Row>;
    set.gaps = gaps<T, Row>;
    set.contact = plainContact;
    return set;
}

} // namespace

template <class T>
KernelSet makeKernels(KernelTarget target, const KernelShape& shape) {
    if (target == KernelTarget::Best) target = bestTarget();
    if (target == KernelTarget::Scalar)
        return shape.folds ? scalarKernels<T, FoldRow<T>>() : scalarKernels<T, DirectRow<T>>();
    KernelSet set;
    addQueries<T>(target, shape, set);
    addCrowd<T>(target, shape, set);
    addPoses<T>(target, shape, set);
    addContact(target, set);
    return set;
}
template KernelSet makeKernels<float>(KernelTarget, const KernelShape&);
template KernelSet makeKernels<double>(KernelTarget, const KernelShape&);

} // namespace tss
