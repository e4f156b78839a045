#include "bake/search/SurfacesApart.h"

#include "bake/base/Infinity.h"
#include "bake/base/Order.h"
#include "bake/base/Parallel.h"
#include "bake/motion/CellTools.h"
#include "bake/search/SampledSearch.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tss {

namespace {

/// After what a search, or the judging of one cell, is given up. Looks are at pairs of nodes or triangles,
/// some tenths of a microsecond each.
struct Effort {
    std::uint64_t looks, looksPerCell, cells;
};
/// Cells judged by how far points move are tried for 7/8 of the least distance where at most `fewExpected` of
/// them are expected, and for half of it up to `mostExpected`. One that takes long is quicker decided in
/// halves.
constexpr double fewExpected = 1'000, mostExpected = 10'000;
constexpr Effort byMotion{20'000'000, 20'000, 40'000};
/// Else, up to so many DOFs, separating axes of triangles are tried.
constexpr std::size_t fewDofs = 2;
constexpr Effort byAxes{40'000'000, 1'000'000, UINT64_MAX};
constexpr std::size_t samples = 128;
/// Over more DOFs samples lie far from each other. From so many of them, the nearest ones, the distance is
/// lowered: each DOF's value in turn is changed by a share of its range, halved down to the last, wherever
/// that leaves at most `lower` of the distance.
constexpr std::size_t sparseDofs = 6, descents = 2;
constexpr double firstStep = 0.25, lastStep = 1.0 / 32, lower = 0.95;
constexpr std::size_t batch = 64; // of fixed size, so that the outcome does not depend on threads

struct CellResult {
    std::vector<Cell> halves;
    double distance = infinity; ///< at its centre, where less than wanted
    std::uint64_t looked = 0;
};

class Search {
public:
    Search(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion, double touching,
           const Progress& progress)
        : a_(a), b_(b), motion_(motion), rates_(motion), touching_(touching), progress_(progress),
          rounding_(coordinateRounding(motion, a_.extent(), b_.extent())),
          alongAxis_(0.875 * apartAlongAxis(a, b, motion)) {}

    std::optional<SurfacesApart> run() {
        if (a_.bvh().empty() || b_.bvh().empty() || !apartAtSamples()) return std::nullopt;
        for (const auto& [share, most] : {std::pair(0.875, fewExpected), std::pair(0.5, mostExpected)})
            if (expectedCells(share * least_) < most) return shownFor(share);
        effort_ = byAxes;
        bySeparatingAxes_ = true;
        if (motion_.dofCount() <= fewDofs && alongAxis_ < 0.5 * least_)
            if (const auto shown = shownFor(0.5)) return shown;
        if (alongAxis_ > touching_) return SurfacesApart{alongAxis_, std::max<std::uint64_t>(cells_, 1)};
        return std::nullopt;
    }

    double nearest() const { return least_; }

private:
    double distanceAt(std::span<const double> q, double within) const {
        return a_.distanceTo(b_, pose(motion_, q), within);
    }

    /// Looks at poses all over Q for the least distance.
    bool apartAtSamples() {
        std::vector<std::vector<double>> poses = exploredPoses(motion_, samples, 1);
        poses.insert(poses.begin(), restValues(motion_));
        distances_.resize(poses.size());
        for (std::size_t first = 0; first < poses.size(); first += batch) {
            const std::size_t end = std::min(first + batch, poses.size());
            parallelFor(end - first, [&](std::size_t k) {
                distances_[first + k] = a_.roughDistanceTo(b_, pose(motion_, poses[first + k]));
            });
            for (std::size_t k = first; k < end; ++k) least_ = std::min(least_, distances_[k]);
            if (least_ <= touching_ || !report(progress_, "surfaces apart", 0)) return false;
        }
        return motion_.dofCount() <= sparseDofs || apartBelow(std::move(poses));
    }

    /// Looks for poses that are nearer than the sampled ones.
    bool apartBelow(std::vector<std::vector<double>> poses) {
        std::vector<std::size_t> order = indicesOf<std::size_t>(poses.size());
        std::ranges::stable_sort(order, {}, [&](std::size_t k) { return distances_[k]; });
        order.resize(std::min(order.size(), descents));
        std::vector<double> lowest(order.size());
        parallelFor(order.size(), [&](std::size_t k) { lowest[k] = lowered(std::move(poses[order[k]])); });
        for (const double distance : lowest) least_ = std::min(least_, distance);
        return least_ > touching_ && report(progress_, "surfaces apart", 0);
    }

    /// The distance at the pose that steps from q lead down to.
    double lowered(std::vector<double> q) const {
        double least = distanceAt(q, infinity);
        for (double step = firstStep; step >= lastStep && least > touching_; step /= 2)
            for (bool better = true; better && least > touching_;) {
                better = false;
                for (std::size_t k = 0; k < q.size(); ++k)
                    for (const double by : {step, -step}) better = takeStep(q, k, by, least) || better;
            }
        return least;
    }

    /// Changes a DOF's value by a share of its range if that lowers the distance enough.
    bool takeStep(std::vector<double>& q, std::size_t k, double by, double& least) const {
        const Dof& dof = motion_.dofs[k];
        const double before =
            std::exchange(q[k], std::clamp(q[k] + by * (dof.upper - dof.lower), dof.lower, dof.upper));
        const double distance =
            q[k] != before && withinLimits(motion_, q) ? distanceAt(q, lower * least) : infinity;
        if (distance >= lower * least) {
            q[k] = before;
            return false;
        }
        least = distance;
        return true;
    }

    /// How many cells a proof by the motion of points would take if all of Q were like the sampled poses.
    double expectedCells(double clearance) const {
        const CellMotion whole(rates_, wholeBox(motion_));
        const auto shares = whole.shares(whole.centrePose() * b_.centre());
        double expected = 0;
        for (const double distance : distances_) {
            double cells = 1;
            for (std::size_t k = 0; k < whole.dofs(); ++k) {
                const double move = shares[k] + whole.relativeShare(k) * b_.radius();
                cells *= std::max(1.0, double(whole.dofs()) * move / (distance - clearance));
            }
            expected += cells / double(distances_.size());
        }
        return expected;
    }

    /// The share of the granted work that is done; from 1 on the search gives up.
    double spent() const {
        return std::max(double(looked_) / double(effort_.looks), double(cells_) / double(effort_.cells));
    }

    /// The proof of a clearance of this share of the least distance found.
    std::optional<SurfacesApart> shownFor(double share) {
        clearance_ = share * least_;
        looked_ = 0;
        std::vector<Cell> cells{wholeBox(motion_)};
        while (!cells.empty()) {
            if (spent() >= 1 || !report(progress_, "surfaces apart", spent())) return std::nullopt;
            std::vector<Cell> now(cells.end() - std::ptrdiff_t(std::min(batch, cells.size())), cells.end());
            cells.resize(cells.size() - now.size());
            std::vector<CellResult> results(now.size());
            parallelFor(now.size(), [&](std::size_t k) { results[k] = examine(now[k]); });
            cells_ += now.size();
            for (CellResult& result : results) {
                if (result.distance <= touching_) return std::nullopt;
                least_ = std::min(least_, result.distance);
                looked_ += result.looked;
                std::move(result.halves.begin(), result.halves.end(), std::back_inserter(cells));
            }
            clearance_ = share * least_;
        }
        if (clearance_ <= touching_) return std::nullopt;
        return SurfacesApart{clearance_, cells_};
    }

    bool isApart(const CellMotion& motion, std::uint64_t& looked) const {
        const double move = motion.pointMotion(motion.centrePose() * b_.centre()).move +
                            motion.relativeMove() * b_.radius() + rounding_;
        // Where points move little, halves would take as long.
        const std::uint64_t most = 4 * move > clearance_ ? effort_.looksPerCell : effort_.looks;
        return a_.apart(b_, motion.centrePose(), clearance_ + move, &looked, most) ||
               (bySeparatingAxes_ &&
                trianglesApart(a_, b_, motion, clearance_, rounding_, effort_.looksPerCell, looked));
    }

    CellResult examine(Cell cell) const {
        CellResult result;
        if (!shrinkToPlanes(motion_, cell)) return result;
        const CellMotion motion(rates_, cell);
        if (isApart(motion, result.looked)) return result;
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

    const MeshQuery a_, b_;
    const Motion& motion_;
    const MotionRates rates_;
    const double touching_;
    const Progress& progress_;
    const double rounding_;
    const double alongAxis_;        ///< clearance that holds along one axis
    std::vector<double> distances_; ///< at the sampled poses
    double least_ = infinity;       ///< distance that was found
    double clearance_ = 0;          ///< to be shown
    Effort effort_ = byMotion;
    bool bySeparatingAxes_ = false;
    std::uint64_t cells_ = 0, looked_ = 0;
};

} // namespace

std::optional<SurfacesApart> surfacesApart(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                                           double touching, const Progress& progress, double* nearest) {
    Search search(a, b, motion, touching, progress);
    const std::optional<SurfacesApart> apart = search.run();
    if (nearest) *nearest = search.nearest();
    return apart;
}

} // namespace tss
