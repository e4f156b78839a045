// How the kernels of a table are asked: features of a pose, verdicts, contacts, and the tests within a
// margin. A table in clusters is asked for the pairs of spheres that bound them first, then for the tests of
// those that are near.
#include "bake/table/TableKernels.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace tss {

namespace {

/// Room for the numbers of all groups of the last level, or of one, to the end of the last vector.
constexpr std::size_t mostLanes = 64;
using NearList = std::array<std::uint32_t, TableClusters::mostAtTop + mostLanes>;

} // namespace

void TableKernels::features(const double* q, TableFeatures& out) const {
    if (!cells_.empty()) out.cell = cells_.rowAt(q);
    poseFeatures(q, out);
}

void TableKernels::features(const PoseRecipe::Matrix& pose, TableFeatures& out) const {
    PoseRecipe::Matrix moved = pose;
    for (int r = 0; r < 3; ++r)
        moved[4 * r + 3] += pose[4 * r] * originB_.x() + pose[4 * r + 1] * originB_.y() +
                            pose[4 * r + 2] * originB_.z() - originA_[r];
    storePose(moved, out);
}

bool TableKernels::hit(const double* q) const {
    std::uint32_t cell = 0;
    if (!cells_.empty()) {
        cell = cells_.rowAt(q);
        const bool all = cells_.allTouch(cell);
        if (static_cast<int>(all) | static_cast<int>(cells_.noneTouches(cell))) return all;
    }
    TableFeatures f;
    f.cell = cell;
    poseFeatures(q, f);
    return hit(f);
}

void TableKernels::poseFeatures(const double* q, TableFeatures& out) const {
    if (kernels_.pose) return kernels_.pose(plan_, q, out.doubles);
    if (fold_) {
        if (float_)
            fold_->evaluate(q, out.floats);
        else
            fold_->evaluate(q, out.doubles);
        return;
    }
    PoseRecipe::Matrix values;
    recipe_.evaluate(q, values.data());
    storePose(values, out);
}

void TableKernels::storePose(const PoseRecipe::Matrix& pose, TableFeatures& out) const {
    if (float_) {
        out.floats[0] = 0;
        for (std::size_t k = 0; k < pose.size(); ++k) out.floats[k + 1] = float(pose[k]);
    } else {
        out.doubles[0] = 0;
        for (std::size_t k = 0; k < pose.size(); ++k) out.doubles[k + 1] = pose[k];
    }
}

KernelData TableKernels::blocksOf(const KernelData& data, std::size_t rowsEach, std::uint32_t part) const {
    const std::size_t number = float_ ? sizeof(float) : sizeof(double);
    const std::size_t step = rowsEach * directColumns * number;
    const auto* begin = static_cast<const std::byte*>(data.blocks) + part * step;
    const auto* end = static_cast<const std::byte*>(data.end);
    return {begin, static_cast<std::size_t>(end - begin) > step ? begin + step : end, data.columns};
}

KernelData TableKernels::boundsIn(std::size_t level, std::uint32_t group) const {
    return blocksOf(bounds_[level - 1].blocks, clusters_.ofGroup(), group);
}

KernelData TableKernels::testsOf(std::uint32_t cluster) const {
    return blocksOf(data_, clusters_.testsEach(), cluster);
}

template <class Take>
bool TableKernels::eachNear(std::size_t level, const KernelData& bounds, const TableFeatures& f,
                            const double& margin, const Take& take) const {
    NearList near;
    const std::uint32_t count = kernels_.testsWithin(bounds, f.doubles, margin, near.data());
    for (std::uint32_t i = 0; i < count; ++i)
        if (level == 0 ? take(near[i]) : eachNear(level - 1, boundsIn(level, near[i]), f, margin, take))
            return true;
    return false;
}

template <class Take>
void TableKernels::eachNearCluster(const TableFeatures& f, const double& margin, const Take& take) const {
    eachNear(bounds_.size() - 1, bounds_.back().blocks, f, margin, take);
}

bool TableKernels::hitInClusters(const TableFeatures& f) const {
    return kernels_.hit(likelyData_, f.doubles) || hitBeyondLikely(f);
}

bool TableKernels::hitBeyondLikely(const TableFeatures& f) const {
    bool hit = false;
    eachNearCluster(f, 0,
                    [&](std::uint32_t cluster) { return hit = kernels_.hit(testsOf(cluster), f.doubles); });
    return hit;
}

std::uint32_t TableKernels::hitsOf(const KernelData& rows, const PoseLanes& poses) const {
    std::uint8_t hit[poseLanes];
    kernels_.hits(rows, poses.doubles, poseLanes, poseLanes, hit);
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < poseLanes; ++i) bits |= std::uint32_t(hit[i]) << i;
    return bits;
}

std::uint32_t TableKernels::hits(const PoseLanes& poses, std::uint32_t asked) const {
    if (clusters_.empty()) return hitsOf(rows_, poses) & asked;
    std::uint32_t found = hitsOf(likelyRows_, poses) & asked;
    TableFeatures f;
    for (std::uint32_t left = asked & ~found; left != 0; left &= left - 1) {
        const int lane = std::countr_zero(left);
        for (std::size_t k = 0; k < std::size(poses.floats); ++k)
            if (float_)
                f.floats[k] = poses.floats[k][lane];
            else
                f.doubles[k] = poses.doubles[k][lane];
        found |= std::uint32_t(hitBeyondLikely(f)) << lane;
    }
    return found;
}

KernelGap TableKernels::nearestInClusters(const TableFeatures& f) const {
    std::int32_t nearest = kernels_.gap(bounds_.back().blocks, f.doubles).test;
    // Of a pose that is not a number none is the nearest.
    if (nearest < 0) return kernels_.gap(data_, f.doubles);
    for (std::size_t level = bounds_.size() - 1; level > 0; --level)
        nearest = kernels_.gap(boundsIn(level, static_cast<std::uint32_t>(nearest)), f.doubles).test;
    const auto first = static_cast<std::uint32_t>(nearest);
    KernelGap least = kernels_.gap(testsOf(first), f.doubles);
    double margin = clusterReachOf(std::max(0.0, least.gap));
    eachNearCluster(f, margin, [&](std::uint32_t cluster) {
        if (cluster == first) return false;
        const KernelGap other = kernels_.gap(testsOf(cluster), f.doubles);
        if (other.gap < least.gap) {
            least = other;
            margin = clusterReachOf(std::max(0.0, least.gap));
        }
        return false;
    });
    return least;
}

std::uint32_t TableKernels::testsInClusters(const TableFeatures& f, double margin, double wide,
                                            std::uint32_t* out) const {
    std::uint32_t count = 0;
    eachNearCluster(f, clusterReachOf(margin), [&](std::uint32_t cluster) {
        count += kernels_.testsWithin(testsOf(cluster), f.doubles, wide, out + count);
        return false;
    });
    return count;
}

double TableKernels::clusterReachOf(double margin) const {
    return reachOf(margin) + 2 * clusterBand_;
}

void TableKernels::frame(const double* q, MotionFrame& out) const {
    DofValues way;
    way.fill(1);
    evaluateFrame(motion_, q, way.data(), out);
}

void TableKernels::contact(const TableFeatures& f, const MotionFrame& frame, TableContact& out) const {
    out.test = nearest(f).test;
    if (out.test < 0) {
        out.gap = std::numeric_limits<double>::infinity();
        return;
    }
    const auto test = static_cast<std::size_t>(out.test);
    kernels_.contact(contactTests_.empty() ? contactTest(tests_[test]) : contactTests_[test], frame,
                     motion_.dofCount(), out);
}

double TableKernels::reachOf(double margin) const {
    // Rounding grows with the margin; twice the band at 0 and some roundoffs of the margin cover it.
    return margin + 2 * std::max(signBand_, gapBand_) + 2e-6 * margin;
}

std::uint32_t TableKernels::testsWithin(const TableFeatures& f, double margin, std::uint32_t* out) const {
    const double wide = reachOf(margin);
    if (!clusters_.empty()) return testsInClusters(f, margin, wide, out);
    if (!cells_.empty())
        if (const std::uint8_t limit = cells_.code(margin); limit < TableCells::nearCode)
            return kernels_.testsWithinNear(data_, f.doubles, cells_.nearBlocks(f.cell, limit), wide, out);
    return kernels_.testsWithin(data_, f.doubles, wide, out);
}

std::uint32_t TableKernels::testsWithin(const double* q, double margin, std::uint32_t* out) const {
    TableFeatures f;
    if (!cells_.empty()) {
        f.cell = cells_.rowAt(q);
        if (const std::uint8_t limit = cells_.code(margin);
            limit < TableCells::nearCode && cells_.nearestCode(f.cell) > limit)
            return 0;
    }
    poseFeatures(q, f);
    return testsWithin(f, margin, out);
}

} // namespace tss
