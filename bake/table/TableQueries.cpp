// How a table in clusters is asked: first the pairs of spheres that bound them, then the tests of those that
// are near.
#include "bake/table/PreparedTable.h"

#include <algorithm>
#include <limits>

namespace tss {

namespace {

/// Room for the numbers of all clusters, to the end of the last vector.
using ClusterList = std::array<std::uint32_t, TableClusters::most + 64>;

} // namespace

KernelData PreparedTable::blocksOf(std::uint32_t cluster) const {
    const std::size_t number = float_ ? sizeof(float) : sizeof(double);
    const std::size_t step = clusters_.testsEach() * directColumns * number;
    const auto* begin = static_cast<const std::byte*>(data_.blocks) + cluster * step;
    const auto* end = static_cast<const std::byte*>(data_.end);
    return {begin, static_cast<std::size_t>(end - begin) > step ? begin + step : end, data_.columns};
}

bool PreparedTable::hitInClusters(const TableFeatures& f) const {
    ClusterList near;
    const std::uint32_t count = kernels_.under(clusterData_, f.doubles, 0, near.data());
    for (std::uint32_t i = 0; i < count; ++i)
        if (kernels_.hit(blocksOf(near[i]), f.doubles)) return true;
    return false;
}

KernelGap PreparedTable::nearestInClusters(const TableFeatures& f) const {
    const KernelGap first = kernels_.gap(clusterData_, f.doubles);
    // Of a pose that is not a number no cluster is the nearest.
    if (first.test < 0) return kernels_.gap(data_, f.doubles);
    KernelGap least = kernels_.gap(blocksOf(static_cast<std::uint32_t>(first.test)), f.doubles);
    ClusterList near;
    const std::uint32_t count =
        kernels_.under(clusterData_, f.doubles, clusterReachOf(std::max(0.0, least.gap)), near.data());
    for (std::uint32_t i = 0; i < count; ++i) {
        if (near[i] == static_cast<std::uint32_t>(first.test)) continue;
        const KernelGap other = kernels_.gap(blocksOf(near[i]), f.doubles);
        if (other.gap < least.gap) least = other;
    }
    return least;
}

std::uint32_t PreparedTable::underInClusters(const TableFeatures& f, double margin, double wide,
                                             std::uint32_t* out) const {
    ClusterList near;
    const std::uint32_t clusters =
        kernels_.under(clusterData_, f.doubles, clusterReachOf(margin), near.data());
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < clusters; ++i)
        count += kernels_.under(blocksOf(near[i]), f.doubles, wide, out + count);
    return count;
}

double PreparedTable::clusterReachOf(double margin) const {
    return reachOf(margin) + 2 * clusterBand_;
}

void PreparedTable::frame(const double* q, MotionFrame& out) const {
    DofValues way;
    way.fill(1);
    evaluateFrame(motion_, q, way.data(), out);
}

void PreparedTable::contact(const TableFeatures& f, const MotionFrame& frame, TableContact& out) const {
    out.test = nearest(f).test;
    if (out.test < 0) {
        out.gap = std::numeric_limits<double>::infinity();
        return;
    }
    kernels_.contact(contactTests_[std::size_t(out.test)], frame, motion_.dofCount(), out);
}

double PreparedTable::reachOf(double margin) const {
    // Rounding grows with the margin; twice the band at 0 and some roundoffs of the margin cover it.
    return margin + 2 * std::max(signBand_, gapBand_) + 2e-6 * margin;
}

std::uint32_t PreparedTable::under(const TableFeatures& f, double margin, std::uint32_t* out) const {
    const double wide = reachOf(margin);
    if (!clusters_.empty()) return underInClusters(f, margin, wide, out);
    if (!cells_.empty())
        if (const std::uint8_t limit = cells_.code(margin); limit < TableCells::nearCode)
            return kernels_.underNear(data_, f.doubles, cells_.under(f.cell, limit), wide, out);
    return kernels_.under(data_, f.doubles, wide, out);
}

std::uint32_t PreparedTable::under(const double* q, double margin, std::uint32_t* out) const {
    if (verdicts_.clearance(q) > reachOf(margin)) return 0;
    TableFeatures f;
    if (!cells_.empty()) {
        f.cell = cells_.rowAt(q);
        if (const std::uint8_t limit = cells_.code(margin);
            limit < TableCells::nearCode && cells_.nearestCode(f.cell) > limit)
            return 0;
    }
    poseFeatures(q, f);
    return under(f, margin, out);
}

} // namespace tss
