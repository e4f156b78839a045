#pragma once
#include <functional>
#include <string_view>

namespace tss {

/// Called now and then, from one thread at a time, with the step's name and the share done in [0,1]. Where it
/// returns false the work stops early and returns what it has by then.
using Progress = std::function<bool(std::string_view step, double done)>;

inline bool report(const Progress& progress, std::string_view step, double done) {
    return !progress || progress(step, done);
}

} // namespace tss
