#pragma once
#include <algorithm>
#include <vector>

namespace tss {

/// A value over time: linear between samples, held before the first and after the last, as USD does. Times
/// are time codes, strictly rising.
struct TimeSamples {
    std::vector<double> times;
    std::vector<double> values;

    bool empty() const { return times.empty(); }
    double at(double time) const {
        if (times.empty()) return 0;
        const auto next = std::upper_bound(times.begin(), times.end(), time);
        if (next == times.begin()) return values.front();
        if (next == times.end()) return values.back();
        const std::size_t i = next - times.begin();
        const double t = (time - times[i - 1]) / (times[i] - times[i - 1]);
        return values[i - 1] + t * (values[i] - values[i - 1]);
    }
};

} // namespace tss
