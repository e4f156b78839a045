#pragma once
#include "tests/extreme/tool/Serve.h"

#include <cstdint>
#include <string>
#include <vector>

namespace extreme {

/// Anywhere: they mostly never meet, and a proof says so. Meet: somewhere within the limits they touch.
enum class Bodies { Anywhere, Meet };

/// The text of a random scene with extreme parameters: a pair on 0 to 3 random DOFs, or a skin over a muscle;
/// units from 1e-6 to 1e6, up to 1e7 sizes from the origin, damaged meshes, any bake settings. The same seed
/// gives the same text on every machine.
std::string randomScene(std::uint64_t seed, Bodies bodies = Bodies::Anywhere);

struct RandomRun {
    std::uint64_t seed = 0;
    std::string refusal;               ///< empty: served
    std::vector<std::string> troubles; ///< must be none
    double seconds = 0;                ///< of processor time
    bool table = false;                ///< a table came of it: neither a proof nor a skin
    bool stopped = false;              ///< the budget ended before everything was done
};

/// One random scene through bake, verify and play. budget: seconds of processor time after which it is asked
/// to stop; what was not finished then is not judged. A refusal without a place counts as trouble.
RandomRun runRandom(std::uint64_t seed, double budget, Bodies bodies = Bodies::Anywhere);

} // namespace extreme
