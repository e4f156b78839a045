#pragma once
#include <string>

namespace tss::compare {

/// "FCL 0.7.0, Bullet 3.24, CGAL 5.5.1": what the other methods are built with.
std::string libraryVersions();

/// The vector instructions that are used here, e.g. "AVX2".
std::string vectorInstructions();

} // namespace tss::compare
