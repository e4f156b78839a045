#include "bake/base/Stopwatch.h"
#include "bake/compare/Methods.h"

#include "bake/base/Parallel.h"

#include <algorithm>
#include <random>

namespace tss::compare {

namespace {

enum class Bin : std::uint8_t { Free, Mixed, Contact };

struct Bins {
    std::size_t dof = 0;
    double lower = 0, width = 0; ///< of all bins together
    std::vector<Bin> bins;

    std::size_t at(double q) const {
        const double x = width > 0 ? (q - lower) / width * static_cast<double>(bins.size()) : 0;
        return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(bins.size() - 1)));
    }
};

/// Whether all, some or none of the samples in a slice of the leading DOF collide. Its two ends are among the
/// samples.
Bin classify(const ComparedPair& problem, const Oracle& oracle, std::size_t dof, double low, double high,
             int samples, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    int hits = 0;
    for (int s = 0; s < samples; ++s) {
        PoseQuery query;
        for (const Dof& d : problem.motion.dofs)
            query.q.push_back(std::uniform_real_distribution<double>(d.lower, d.upper)(random));
        const double share = samples > 1 ? static_cast<double>(s) / (samples - 1) : 0.5;
        query.q[dof] = low + share * (high - low);
        query.pose = pose(problem.motion, query.q);
        hits += oracle(query) ? 1 : 0;
    }
    return hits == 0 ? Bin::Free : hits == samples ? Bin::Contact : Bin::Mixed;
}

Bins makeBins(const ComparedPair& problem, const Oracle& oracle, int bins, int samples, std::uint64_t seed) {
    Bins result;
    result.dof = leadingDof(problem);
    const Dof& dof = problem.motion.dofs[result.dof];
    result.lower = dof.lower;
    result.width = dof.upper - dof.lower;
    result.bins.resize(static_cast<std::size_t>(bins));
    parallelFor(result.bins.size(), [&](std::size_t k) {
        const double step = result.width / bins;
        const double low = result.lower + step * static_cast<double>(k);
        result.bins[k] = classify(problem, oracle, result.dof, low, low + step, samples, seed + 7919 * k);
    });
    return result;
}

class AngularRegion final : public CollisionMethodLoop<AngularRegion> {
public:
    AngularRegion(const ComparedPair& problem, const Oracle& oracle, int bins, int samples,
                  std::uint64_t seed) {
        const Stopwatch watch;
        const Bins all = makeBins(problem, oracle, bins, samples, seed);
        dof_ = all.dof;
        const double step = all.width / bins;
        for (std::size_t k = 0; k < all.bins.size(); ++k) {
            if (all.bins[k] == Bin::Free) continue;
            const double low = all.lower + step * static_cast<double>(k);
            if (!stretches_.empty() && k > 0 && all.bins[k - 1] != Bin::Free)
                stretches_.back().second = low + step;
            else
                stretches_.emplace_back(low, low + step);
        }
        const double seconds = watch.seconds();
        description() = {"angular-region",
                         "motion regions",
                         "contact wherever the leading DOF (" + problem.motion.dofs[dof_].name +
                             ") is in a slice in which a sample collided: " + std::to_string(bins) +
                             " slices of " + std::to_string(samples) + " samples",
                         {},
                         stretches_.size() * sizeof(stretches_[0]),
                         seconds};
    }
    bool hit(const PoseQuery& query) const override {
        for (const auto& [low, high] : stretches_)
            if (query.q[dof_] >= low && query.q[dof_] <= high) return true;
        return false;
    }
    /// No sphere is tested, only angles are compared.
    std::optional<Work> work(const PoseQuery&) const override { return Work{}; }

private:
    std::size_t dof_ = 0;
    std::vector<std::pair<double, double>> stretches_;
};

class MixedRegion final : public CollisionMethodLoop<MixedRegion> {
public:
    MixedRegion(const ComparedPair& problem, const Oracle& oracle, int bins, int samples, std::uint64_t seed,
                std::shared_ptr<const CollisionMethod> inside)
        : inside_(std::move(inside)) {
        const Stopwatch watch;
        bins_ = makeBins(problem, oracle, bins, samples, seed);
        const double seconds = watch.seconds();
        const auto share = [&](Bin bin) {
            return std::to_string(100 * std::ranges::count(bins_.bins, bin) / bins);
        };
        description() = {"mixed-region-" + inside_->description().name,
                         "motion regions",
                         "slices of the leading DOF (" + problem.motion.dofs[bins_.dof].name +
                             "): " + share(Bin::Free) + " % free, " + share(Bin::Contact) + " % contact, " +
                             share(Bin::Mixed) + " % mixed, where " + inside_->description().name +
                             " is asked",
                         {},
                         bins_.bins.size() + inside_->description().bytes,
                         seconds};
    }
    bool hit(const PoseQuery& query) const override {
        const Bin bin = bins_.bins[bins_.at(query.q[bins_.dof])];
        return bin == Bin::Contact || (bin == Bin::Mixed && inside_->hit(query));
    }
    std::optional<Work> work(const PoseQuery& query) const override {
        return bins_.bins[bins_.at(query.q[bins_.dof])] == Bin::Mixed ? inside_->work(query) : Work{};
    }

private:
    Bins bins_;
    std::shared_ptr<const CollisionMethod> inside_;
};

} // namespace

double farthestMove(const ComparedPair& problem, const std::vector<double>& p, const std::vector<double>& q) {
    const Pose from = pose(problem.motion, p), to = pose(problem.motion, q);
    const Eigen::AlignedBox3d box = bounds(problem.meshB);
    double most = 0;
    for (int c = 0; c < 8; ++c) {
        const Vec3 corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c));
        most = std::max(most, (from * corner - to * corner).norm());
    }
    return most;
}

std::size_t leadingDof(const ComparedPair& problem) {
    std::vector<double> q;
    for (const Dof& dof : problem.motion.dofs) q.push_back(0.5 * (dof.lower + dof.upper));
    std::size_t leading = 0;
    double most = -1;
    for (std::size_t k = 0; k < q.size(); ++k) {
        std::vector<double> low = q, high = q;
        low[k] = problem.motion.dofs[k].lower;
        high[k] = problem.motion.dofs[k].upper;
        if (const double moved = farthestMove(problem, low, high); moved > most) {
            most = moved;
            leading = k;
        }
    }
    return leading;
}

std::unique_ptr<CollisionMethod> makeAngularRegion(const ComparedPair& problem, const Oracle& oracle,
                                                   int bins, int samples, std::uint64_t seed) {
    return std::make_unique<AngularRegion>(problem, oracle, bins, samples, seed);
}

std::unique_ptr<CollisionMethod> makeMixedRegion(const ComparedPair& problem, const Oracle& oracle, int bins,
                                                 int samples, std::uint64_t seed,
                                                 std::shared_ptr<const CollisionMethod> inside) {
    return std::make_unique<MixedRegion>(problem, oracle, bins, samples, seed, std::move(inside));
}

} // namespace tss::compare
