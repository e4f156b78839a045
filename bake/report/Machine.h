#pragma once
#include <string>

namespace tss::reporting {

/// Where and with what the figures were made: times mean nothing without it.
struct Machine {
    std::string processor; ///< as the system names it
    unsigned cores = 0;
    std::string compiler;
    std::string build;   ///< flags that matter for speed
    std::string vectors; ///< the instructions that the table's kernels use
    std::string libraries;
};

Machine thisMachine();

} // namespace tss::reporting
