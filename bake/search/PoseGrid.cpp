#include "bake/search/PoseGrid.h"

#include "bake/motion/MotionBound.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// How far DOF k moves points of B from limit to limit, the others at rest.
double travel(const Motion& motion, const MotionRates& rates, std::size_t k, const Vec3& centre,
              double radius) {
    Cell cell;
    for (std::size_t l = 0; l < motion.dofCount(); ++l) cell.lower[l] = cell.upper[l] = motion.dofs[l].rest;
    cell.lower[k] = motion.dofs[k].lower;
    cell.upper[k] = motion.dofs[k].upper;
    // Of a chord, at most twice the radius: a turn by more has more steps, by its angle.
    const double turns =
        motion.dofs[k].kind == DofKind::Rotation ? std::max(1.0, (cell.upper[k] - cell.lower[k]) / 2) : 1;
    const CellMotion moves(rates, cell);
    return 2 * turns * (moves.pointMotion(moves.centrePose() * centre).move + moves.relativeMove() * radius);
}

/// lower, ..., rest, ..., upper in about `steps` steps.
std::vector<double> spread(const Dof& dof, int steps) {
    std::vector<double> values;
    const double range = dof.upper - dof.lower, rest = std::clamp(dof.rest, dof.lower, dof.upper);
    const auto add = [&](double from, double to) {
        const int count = range > 0 ? static_cast<int>(std::ceil(steps * (to - from) / range)) : 0;
        for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / count);
    };
    add(dof.lower, rest);
    add(rest, dof.upper);
    values.push_back(dof.upper);
    return values;
}

} // namespace

PoseGrid::PoseGrid(const Motion& motion, const TriangleMesh& meshB, double step, int most)
    : motion_(&motion) {
    const MotionRates rates(motion);
    const Eigen::AlignedBox3d box = bounds(meshB);
    std::vector<double> steps;
    for (std::size_t k = 0; k < motion.dofCount(); ++k) {
        const double wished = travel(motion, rates, k, box.center(), box.diagonal().norm() / 2) / step;
        steps.push_back(std::clamp(std::ceil(wished), 1.0, double(most)));
    }
    const auto count = [&] {
        double product = 1;
        for (const double n : steps) product *= n + 1;
        return product;
    };
    while (count() > most) {
        double& largest = *std::max_element(steps.begin(), steps.end());
        if (largest <= 1) break;
        fine_ = false;
        largest = std::floor(largest * 0.9);
    }
    std::size_t size = 1;
    for (std::size_t k = 0; k < steps.size(); ++k) {
        values_.push_back(spread(motion.dofs[k], static_cast<int>(steps[k])));
        const auto rest =
            std::find(values_[k].begin(), values_[k].end(),
                      std::clamp(motion.dofs[k].rest, motion.dofs[k].lower, motion.dofs[k].upper));
        rest_ += size * static_cast<std::size_t>(rest - values_[k].begin());
        size *= values_[k].size();
    }
    free_.assign(size, 0);
}

std::vector<double> PoseGrid::pose(std::size_t at) const {
    std::vector<double> q;
    for (const std::vector<double>& values : values_) {
        q.push_back(values[at % values.size()]);
        at /= values.size();
    }
    return q;
}

std::vector<std::size_t> PoseGrid::neighbours(std::size_t at) const {
    std::vector<std::size_t> found;
    std::size_t stride = 1;
    for (const std::vector<double>& values : values_) {
        const std::size_t place = at / stride % values.size();
        if (place > 0) found.push_back(at - stride);
        if (place + 1 < values.size()) found.push_back(at + stride);
        stride *= values.size();
    }
    std::erase_if(found, [&](std::size_t near) { return !withinLimits(*motion_, pose(near), 0); });
    return found;
}

bool PoseGrid::freeAround(const std::vector<double>& q) const {
    std::size_t at = 0, stride = 1;
    for (std::size_t k = 0; k < values_.size(); ++k) {
        const auto above = std::lower_bound(values_[k].begin(), values_[k].end(), q[k]);
        auto nearest = above == values_[k].end() ? above - 1 : above;
        if (nearest != values_[k].begin() && q[k] - *(nearest - 1) < *nearest - q[k]) --nearest;
        at += stride * static_cast<std::size_t>(nearest - values_[k].begin());
        stride *= values_[k].size();
    }
    return free(at);
}

double PoseGrid::share() const {
    return free_.empty()
               ? 1
               : double(std::count(free_.begin(), free_.end(), 1)) / static_cast<double>(free_.size());
}

} // namespace tss
