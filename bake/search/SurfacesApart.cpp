#include "bake/search/SurfacesApart.h"

#include "bake/base/Parallel.h"
#include "bake/motion/CellTools.h"
#include "bake/search/ExploredPoses.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace tss {

namespace {

/// Cells that are expected at most, a distance of two meshes each: for a clearance near the least distance,
/// and for half of it; and how many times more are looked at.
constexpr double fewExpected = 1'000, mostExpected = 10'000, slack = 4;
constexpr std::size_t samples = 128;
constexpr std::size_t batch = 64; // of fixed size, so that the outcome does not depend on threads

struct CellResult {
    std::vector<Cell> halves;
    double distance = std::numeric_limits<double>::infinity(); ///< at its centre, where less than wanted
};

class Search {
public:
    Search(const MeshQuery& a, const MeshQuery& b, const Motion& motion, double touching,
           const Progress& progress)
        : a_(a), b_(b), motion_(motion), rates_(motion), touching_(touching), progress_(progress),
          rounding_(coordinateRounding(motion, a.extent(), b.extent())) {}

    std::optional<SurfacesApart> run() {
        if (a_.bvh().empty() || b_.bvh().empty() || !promising()) return std::nullopt;
        std::vector<Cell> cells{wholeBox(motion_)};
        while (!cells.empty()) {
            const double done = double(looked_) / (slack * mostExpected);
            if (done > 1 || !report(progress_, "surfaces apart", done)) return std::nullopt;
            std::vector<Cell> now(cells.end() - std::ptrdiff_t(std::min(batch, cells.size())), cells.end());
            cells.resize(cells.size() - now.size());
            std::vector<CellResult> results(now.size());
            parallelFor(now.size(), [&](std::size_t k) { results[k] = examine(now[k]); });
            looked_ += now.size();
            for (CellResult& result : results) {
                if (result.distance <= touching_) return std::nullopt;
                clearance_ = std::min(clearance_, share_ * result.distance);
                std::move(result.halves.begin(), result.halves.end(), std::back_inserter(cells));
            }
        }
        if (clearance_ <= touching_) return std::nullopt;
        return SurfacesApart{clearance_, looked_};
    }

private:
    double distanceAt(std::span<const double> q, double within) const {
        return a_.distanceTo(b_, pose(motion_, q), within);
    }

    /// Looks at poses all over Q: whether the surfaces are apart at all of them, and how near to the least
    /// distance the clearance may be for the number of cells that this would take.
    bool promising() {
        std::vector<std::vector<double>> poses = exploredPoses(motion_, samples, 1);
        poses.insert(poses.begin(), restValues(motion_));
        std::vector<double> distances(poses.size());
        for (std::size_t first = 0; first < poses.size(); first += batch) {
            const std::size_t count = std::min(batch, poses.size() - first);
            parallelFor(count, [&](std::size_t k) {
                distances[first + k] = distanceAt(poses[first + k], std::numeric_limits<double>::infinity());
            });
            const auto now = distances.begin() + std::ptrdiff_t(first);
            if (*std::min_element(now, now + std::ptrdiff_t(count)) <= touching_ ||
                !report(progress_, "surfaces apart", 0))
                return false;
        }
        const double least = *std::min_element(distances.begin(), distances.end());
        for (const auto& [share, most] : {std::pair(0.875, fewExpected), std::pair(0.5, mostExpected)}) {
            share_ = share;
            clearance_ = share * least;
            if (expectedCells(distances) < most) return true;
        }
        return false;
    }

    /// Were all of Q like these poses.
    double expectedCells(const std::vector<double>& distances) const {
        const CellMotion whole(rates_, wholeBox(motion_));
        const auto shares = whole.shares(whole.centrePose() * b_.centre());
        double expected = 0;
        for (const double distance : distances) {
            double cells = 1;
            for (std::size_t k = 0; k < whole.dofs(); ++k) {
                const double move = shares[k] + whole.relativeShare(k) * b_.radius();
                cells *= std::max(1.0, double(whole.dofs()) * move / (distance - clearance_));
            }
            expected += cells / double(distances.size());
        }
        return expected;
    }

    CellResult examine(Cell cell) const {
        CellResult result;
        if (!shrinkToPlanes(motion_, cell)) return result;
        const CellMotion motion(rates_, cell);
        const double move = motion.pointMotion(motion.centrePose() * b_.centre()).move +
                            motion.relativeMove() * b_.radius() + rounding_;
        if (a_.apart(b_, motion.centrePose(), clearance_ + move)) return result;
        if (withinLimits(motion_, motion.centre()))
            result.distance = distanceAt(motion.centre(), clearance_ + rounding_);
        if (motion.dofs() == 0) {
            result.halves = {cell}; // the one pose there is, to be asked again with less clearance
            return result;
        }
        const auto [lower, upper] = splitCell(rates_, cell, widestDof(motion, b_.centre(), b_.radius()));
        result.halves = {upper, lower};
        return result;
    }

    const MeshQuery &a_, &b_;
    const Motion& motion_;
    const MotionRates rates_;
    const double touching_;
    const Progress& progress_;
    const double rounding_;
    double share_ = 0; ///< of the least distance, for the clearance
    double clearance_ = 0;
    std::uint64_t looked_ = 0;
};

} // namespace

std::optional<SurfacesApart> surfacesApart(const MeshQuery& a, const MeshQuery& b, const Motion& motion,
                                           double touching, const Progress& progress) {
    return Search(a, b, motion, touching, progress).run();
}

} // namespace tss
