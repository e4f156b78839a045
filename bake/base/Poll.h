#pragma once
#include "bake/base/Progress.h"

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

namespace tss {

/// Cancellation of work inside of parallelFor(): any thread may call stopped() often and at little cost;
/// every so many calls one thread calls the Progress, which is not thread-safe.
class Poll {
public:
    Poll(const Progress& progress, std::string step) : progress_(progress), step_(std::move(step)) {}

    /// Whether the work should stop.
    bool stopped() {
        if (progress_ && ++asked_ % 1024 == 0 && mutex_.try_lock()) {
            const std::lock_guard lock(mutex_, std::adopt_lock);
            if (!stop_ && !progress_(step_, 0)) stop_ = true;
        }
        return stop_.load(std::memory_order_relaxed);
    }

private:
    const Progress& progress_;
    const std::string step_;
    std::mutex mutex_;
    std::atomic<std::uint64_t> asked_{0};
    std::atomic<bool> stop_{false};
};

} // namespace tss
