#pragma once
#include <cstddef>
#include <functional>

namespace tss {

/// Calls body(i) for every i in [0, count), spread over the threads allowed by ThreadLimit. Which thread
/// takes which i is not fixed: body(i) writes to slot i only, so that the result is the same bits for any
/// number of threads.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body);

/// How many threads that is.
std::size_t threadCount();

/// Limits the worker threads of this process while it lives. 0: as many as the machine has.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    void* control_ = nullptr;
};

} // namespace tss
