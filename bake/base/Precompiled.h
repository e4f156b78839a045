// Others' headers that most sources of the core include: compiled once for all of its libraries (OSGTSS_PRECOMPILE).
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>
