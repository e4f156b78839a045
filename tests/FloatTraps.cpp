#include <cfenv>

namespace {

/// Before main, and so before any thread: each inherits the mask of the one that starts it.
[[maybe_unused]] const int trapped = feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);

} // namespace
