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
    const Stopwatch watch;
    const Bins all = makeBins(problem, oracle, bins, samples, seed);
    const double step = all.width / bins;
    std::vector<std::pair<double, double>> stretches;
    for (std::size_t k = 0; k < all.bins.size(); ++k) {
        if (all.bins[k] == Bin::Free) continue;
        const double low = all.lower + step * static_cast<double>(k);
        if (!stretches.empty() && k > 0 && all.bins[k - 1] != Bin::Free)
            stretches.back().second = low + step;
        else
            stretches.emplace_back(low, low + step);
    }
    const double seconds = watch.seconds();
    Description about{"angular-region",
                      "motion regions",
                      "contact wherever the leading DOF (" + problem.motion.dofs[all.dof].name +
                          ") is in a slice in which a sample collided: " + std::to_string(bins) +
                          " slices of " + std::to_string(samples) + " samples",
                      {},
                      stretches.size() * sizeof(stretches[0]),
                      seconds};
    // No sphere is tested, only angles are compared.
    return makeMethod(
        std::move(about),
        [stretches, dof = all.dof](const PoseQuery& query) {
            for (const auto& [low, high] : stretches)
                if (query.q[dof] >= low && query.q[dof] <= high) return true;
            return false;
        },
        [](const PoseQuery&) { return Work{}; });
}

std::unique_ptr<CollisionMethod> makeMixedRegion(const ComparedPair& problem, const Oracle& oracle, int bins,
                                                 int samples, std::uint64_t seed,
                                                 std::shared_ptr<const CollisionMethod> inside) {
    const Stopwatch watch;
    const Bins all = makeBins(problem, oracle, bins, samples, seed);
    const double seconds = watch.seconds();
    const auto share = [&](Bin bin) {
        return std::to_string(100 * std::ranges::count(all.bins, bin) / bins);
    };
    const std::string& name = inside->description.name;
    Description about{"mixed-region-" + name,
                      "motion regions",
                      "slices of the leading DOF (" + problem.motion.dofs[all.dof].name +
                          "): " + share(Bin::Free) + " % free, " + share(Bin::Contact) + " % contact, " +
                          share(Bin::Mixed) + " % mixed, where " + name + " is asked",
                      {},
                      all.bins.size() + inside->description.bytes,
                      seconds};
    const auto binOf = [all](const PoseQuery& query) { return all.bins[all.at(query.q[all.dof])]; };
    return makeMethod(
        std::move(about),
        [binOf, inside](const PoseQuery& query) {
            const Bin bin = binOf(query);
            return bin == Bin::Contact || (bin == Bin::Mixed && inside->hit(query));
        },
        [binOf, inside](const PoseQuery& query) {
            return binOf(query) == Bin::Mixed ? inside->work(query) : Work{};
        });
}

} // namespace tss::compare
