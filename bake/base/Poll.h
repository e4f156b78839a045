#pragma once
#include "bake/base/Progress.h"

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

namespace tss {

/// Lets work inside of parallelFor() hear that it should stop: any thread may ask, often and at little cost;
/// the Progress behind it is asked by one thread at a time, every so many times.
class Poll {
public:
    Poll(const Progress& progress, std::string step) : progress_(progress), step_(std::move(step)) {}

    /// The work should stop.
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
