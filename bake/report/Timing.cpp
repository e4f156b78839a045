#include "bake/report/Timing.h"

#include <algorithm>
#include <cmath>

namespace tss::reporting {

namespace {

/// How often and at which queries a method is timed.
struct Plan {
    std::span<const compare::PoseQuery> queries;
    std::size_t repeats = 1;
    int rounds = 1;
    std::vector<double> nanoseconds;
};

double secondsOf(const compare::CollisionMethod& method, std::span<const compare::PoseQuery> queries,
                 std::size_t repeats, std::size_t& hits) {
    const double start = threadSeconds();
    for (std::size_t k = 0; k < repeats; ++k) hits += method.countHits(queries);
    return threadSeconds() - start;
}

/// The quantile of sorted values, the nearest value.
double quantile(const std::vector<double>& sorted, double share) {
    return sorted[std::size_t(std::round(share * static_cast<double>(sorted.size() - 1)))];
}

} // namespace

std::vector<Times> timeMethods(const std::vector<const compare::CollisionMethod*>& methods,
                               std::span<const compare::PoseQuery> queries, const TimingOptions& options) {
    std::vector<Times> times(methods.size());
    if (queries.empty()) return times;
    std::vector<Plan> plans(methods.size());
    std::size_t hits = 0;
    int most = 0;
    for (std::size_t m = 0; m < methods.size(); ++m) {
        const auto few = queries.first(std::min<std::size_t>(queries.size(), 100));
        secondsOf(*methods[m], few, 1, hits); // caches, page faults, clock speed
        const double each =
            std::max(1e-9, secondsOf(*methods[m], few, 1, hits)) / static_cast<double>(few.size());
        const double fitting = std::clamp(options.secondsPass / each, static_cast<double>(few.size()),
                                          static_cast<double>(queries.size()));
        plans[m].queries = queries.first(static_cast<std::size_t>(fitting));
        const double once = each * static_cast<double>(plans[m].queries.size());
        plans[m].repeats = static_cast<std::size_t>(std::max(1.0, std::ceil(options.secondsRound / once)));
        const double round = once * static_cast<double>(plans[m].repeats);
        plans[m].rounds = static_cast<int>(std::clamp(
            options.secondsEach / round, std::min(3.0, double(options.rounds)), double(options.rounds)));
        most = std::max(most, plans[m].rounds);
    }
    for (int round = 0; round < most; ++round)
        for (std::size_t m = 0; m < methods.size(); ++m) {
            Plan& plan = plans[m];
            if (round >= plan.rounds) continue;
            const double seconds = secondsOf(*methods[m], plan.queries, plan.repeats, hits);
            plan.nanoseconds.push_back(1e9 * seconds /
                                       static_cast<double>(plan.repeats * plan.queries.size()));
        }
    [[maybe_unused]] volatile std::size_t sink = hits; // so that the compiler leaves out no loop
    for (std::size_t m = 0; m < methods.size(); ++m) {
        std::vector<double>& sorted = plans[m].nanoseconds;
        std::ranges::sort(sorted);
        times[m] = {quantile(sorted, 0.5), quantile(sorted, 0.1), quantile(sorted, 0.9), plans[m].rounds,
                    plans[m].queries.size()};
    }
    return times;
}

} // namespace tss::reporting
