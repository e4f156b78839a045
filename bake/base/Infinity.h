#pragma once
#include <limits>

namespace tss {

/// No bound, no distance found yet.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace tss
