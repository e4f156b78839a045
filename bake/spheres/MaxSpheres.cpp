#include "bake/spheres/MaxSpheres.h"

#include <algorithm>
#include <cmath>

namespace tss {

double toleranceFor(std::size_t limit, double finest, double coarsest,
                    const std::function<std::size_t(double)>& count, const Progress& progress) {
    constexpr int looks = 12;
    const double n = static_cast<double>(limit);
    double good = coarsest, goodCount = 1; // takes few enough
    double bad = 0, badCount = 0;          // takes too many; 0: none seen
    double next = std::max(finest, coarsest / 64);
    for (int look = 0; look < looks; ++look) {
        const double taken = static_cast<double>(count(next));
        if (taken <= n) {
            good = next;
            goodCount = taken;
        } else {
            bad = next;
            badCount = taken;
        }
        if (!report(progress, "max-spheres", (look + 1.0) / looks)) break;
        if (good <= finest || (taken <= n && taken >= 0.97 * n) || (bad > 0 && good < 1.02 * bad)) break;
        // The count goes about as a power of the tolerance; aimed a little low.
        if (bad > 0) {
            const double slope = std::log(badCount / goodCount) / std::log(good / bad);
            const double guess = good * std::pow(goodCount / (0.985 * n), 1 / std::max(slope, 0.1));
            const double width = good / bad;
            next = std::clamp(guess, bad * std::pow(width, 0.1), good * std::pow(width, -0.1));
        } else {
            next = good * std::clamp(std::pow(goodCount / (0.985 * n), 1 / 1.3), 0.2, 0.9);
        }
        next = std::max(next, finest);
    }
    return good;
}

} // namespace tss
