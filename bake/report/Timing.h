#pragma once
#include "bake/base/Stopwatch.h"
#include "bake/compare/CollisionMethod.h"

namespace tss::reporting {

/// Processor time of one query: median over rounds and the tenth and ninetieth percentile, in nanoseconds.
struct Times {
    double median = 0, low = 0, high = 0;
    int rounds = 0;
    std::size_t queries = 0; ///< in a round
};

struct TimingOptions {
    int rounds = 11;
    double secondsEach = 1.0;   ///< a method that would take longer for all rounds gets fewer, at least 3
    double secondsRound = 2e-3; ///< a method that is quicker repeats the poses until a round takes this long
    double secondsPass = 0.05;  ///< a method that is slower takes the first of the poses, at least 100
};

/// Times the loop over the same poses for every method, in one process on one thread: a warm-up, then rounds
/// in which all methods take turns, so that disturbances of the machine affect all of them. queries: in
/// random order, so that the first part, which slow methods are asked, is representative.
std::vector<Times> timeMethods(const std::vector<const compare::CollisionMethod*>& methods,
                               std::span<const compare::PoseQuery> queries, const TimingOptions& options);

} // namespace tss::reporting
