#pragma once
#include <string>
#include <vector>

namespace extreme {

/// One pair baked twice: as it is, and with something changed that must not matter.
struct Invariance {
    std::string change;
    bool sameTable =
        true; ///< the table must be the same; not where floats are too coarse to hold its spheres
    bool sameCount = false; ///< as many spheres in the table, and as many tests
    bool sameTests = false; ///< the same spheres are tested against each other
    double off = 0;         ///< farthest that a sphere is from its like, scene units of the first bake
    double band = 0;        ///< gaps at which the verdict may differ: rounding, likewise
    int poses = 0, hits = 0;
    int differ = 0; ///< verdicts that differ outside the band
};

/// Other units, places, orientations, A and B swapped, triangles shuffled, DOFs in other units.
std::vector<Invariance> invariances(int poses);

} // namespace extreme
