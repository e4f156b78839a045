#include "bake/tool/Exempt.h"

#include <cmath>
#include <fmt/format.h>

namespace tss::tool {

namespace {

double bounded(double exempt) {
    constexpr double rounding = 1e-12; // of sums of areas
    const double share = 1 - exempt;
    return share > rounding ? share : 0;
}

std::string percent(double share) {
    const double tenths = std::floor(1000 * share); // of a percent
    return share <= 0      ? "nothing"
           : tenths < 1    ? "less than 0.1 %"
           : tenths >= 999 ? "over 99.9 %"
                           : fmt::format("{:.1f} %", tenths / 10);
}

} // namespace

BoundedShares boundedShares(double exemptA, double exemptB) {
    return {bounded(exemptA), bounded(exemptB)};
}

std::string boundedText(const BoundedShares& bounded) {
    return fmt::format("{} of A and {} of B", percent(bounded.a), percent(bounded.b));
}

} // namespace tss::tool
