#pragma once
#include <string>

namespace tss::compare {

/// Where and with what figures are made: times mean nothing without it.
struct Machine {
    std::string processor; ///< as the system names it
    unsigned cores = 0;
    std::string compiler;
    std::string build;     ///< flags that matter for speed
    std::string vectors;   ///< the instructions that the table's kernels use, e.g. "AVX2"
    std::string libraries; ///< "FCL 0.7.0, Bullet 3.24, CGAL 5.5.1": those of the other methods
};

Machine thisMachine();

} // namespace tss::compare
