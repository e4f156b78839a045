#pragma once
#include "bake/base/Parallel.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

namespace tss {

/// One round of a parallel depth-first search: removes up to `width` jobs from the end of a list and runs
/// each by run(job, number of jobs of the round). The member `left` of each result, jobs that are still to be
/// done, is appended to the list. Returns the results, that of the last job first. The same for any
/// number of threads if each result depends on its job alone.
template <class Job, class Run>
auto runLast(std::vector<Job>& jobs, std::size_t width, const Run& run) {
    const std::size_t count = std::min(width, jobs.size());
    std::vector<std::invoke_result_t<Run, Job, std::size_t>> parts(count);
    parallelFor(count, [&](std::size_t k) { parts[k] = run(std::move(jobs[jobs.size() - 1 - k]), count); });
    jobs.resize(jobs.size() - count);
    for (std::size_t k = count; k-- > 0;)
        std::move(parts[k].left.begin(), parts[k].left.end(), std::back_inserter(jobs));
    return parts;
}

} // namespace tss
