#pragma once
#include "bake/base/Infinity.h"

#include <chrono>
#include <ctime>

namespace tss {

/// Seconds since it was made or started again, by the wall clock.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    void restart() { start_ = Clock::now(); }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

/// A point in time by the wall clock; one made without seconds never comes.
class Deadline {
public:
    Deadline() = default;
    /// In so many seconds.
    explicit Deadline(double seconds) : seconds_(seconds) {}

    bool comes() const { return seconds_ < infinity; }
    double left() const { return seconds_ - watch_.seconds(); } ///< seconds; infinity: it never comes
    bool over() const { return left() <= 0; }

private:
    double seconds_ = infinity;
    Stopwatch watch_;
};

/// Seconds that this thread has run: another program that takes its turn in between does not count.
inline double threadSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

} // namespace tss
