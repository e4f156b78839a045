#include "bake/report/Timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tss::reporting {

namespace {

using Clock = std::chrono::steady_clock;

struct Plan {
    std::size_t repeats = 1;
    int rounds = 1;
    std::vector<double> nanoseconds;
};

double secondsOf(const compare::Rival& rival, const std::vector<compare::PoseQuery>& queries,
                 std::size_t repeats, std::size_t& hits) {
    const auto start = Clock::now();
    for (std::size_t k = 0; k < repeats; ++k) hits += rival.countHits(queries);
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double at(const std::vector<double>& sorted, double share) {
    return sorted[static_cast<std::size_t>(std::round(share * static_cast<double>(sorted.size() - 1)))];
}

} // namespace

std::vector<Times> timeMethods(const std::vector<const compare::Rival*>& rivals,
                               const std::vector<compare::PoseQuery>& queries, const TimingOptions& options) {
    std::vector<Times> times(rivals.size());
    if (queries.empty()) return times;
    std::vector<Plan> plans(rivals.size());
    std::size_t hits = 0;
    int most = 0;
    for (std::size_t m = 0; m < rivals.size(); ++m) {
        secondsOf(*rivals[m], queries, 1, hits); // caches, page faults, clock speed
        const double once = std::max(1e-9, secondsOf(*rivals[m], queries, 1, hits));
        plans[m].repeats = static_cast<std::size_t>(std::max(1.0, std::ceil(options.secondsRound / once)));
        const double round = once * static_cast<double>(plans[m].repeats);
        plans[m].rounds = std::clamp(static_cast<int>(options.secondsEach / round),
                                     std::min(3, options.rounds), options.rounds);
        most = std::max(most, plans[m].rounds);
    }
    for (int round = 0; round < most; ++round)
        for (std::size_t m = 0; m < rivals.size(); ++m) {
            Plan& plan = plans[m];
            if (round >= plan.rounds) continue;
            const double seconds = secondsOf(*rivals[m], queries, plan.repeats, hits);
            plan.nanoseconds.push_back(1e9 * seconds / static_cast<double>(plan.repeats * queries.size()));
        }
    [[maybe_unused]] volatile std::size_t sink = hits; // so that no loop is left out
    for (std::size_t m = 0; m < rivals.size(); ++m) {
        std::vector<double>& sorted = plans[m].nanoseconds;
        std::sort(sorted.begin(), sorted.end());
        times[m] = {at(sorted, 0.5), at(sorted, 0.1), at(sorted, 0.9), plans[m].rounds, queries.size()};
    }
    return times;
}

} // namespace tss::reporting
