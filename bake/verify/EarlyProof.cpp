#include "bake/verify/EarlyProof.h"

#include "bake/verify/Nesting.h"

namespace tss::verify {

EarlyResult proveEarly(const VerifiedBody& a, const VerifiedBody& b, const Motion& motion, double size,
                       const StickingOut& outA, const StickingOut& outB, const std::vector<MeshTest>& tests,
                       double claimed, const Progress& progress) {
    EarlyResult result;
    result.bound = mostTogether(tests, outA.surface, outB.surface);
    const double granted = claimed * (1 + 1e-6);
    result.surfaces = result.bound <= granted;
    if (result.surfaces) {
        result.proven = true;
        return result;
    }
    result.bound = mostTogether(tests, outA.body, outB.body);
    if (!(result.bound <= granted)) {
        result.reason = "its spheres stick out by more than the stored bound on early reports";
        return result;
    }
    NestingResult nesting = proveNoNesting(a, b, motion, size, tests, granted, progress);
    result.proven = nesting.reason.empty();
    result.reason = std::move(nesting.reason);
    result.pose = std::move(nesting.pose);
    result.cells = nesting.cells;
    return result;
}

} // namespace tss::verify
