#pragma once
#include "bake/verify/Models.h"

namespace tss::verify {

/// What is to be shown: wherever the models' gap is <= margin, some test's is <= max(gap, -depth) + epsilon.
/// No tests: the models' gap is never <= margin.
struct Claim {
    std::vector<Test> tests;
    double epsilon = 0, depth = 0, margin = 0;
};

/// Shows the claim for every pose of the motion's limits, or finds a pose that breaks it. epsilon already
/// holds the rounding band.
VerifyResult proveClaim(const Models& models, const Claim& claim, std::uint64_t mostCells,
                        const Progress& progress);

} // namespace tss::verify
