#include "bake/verify/Verify.h"

#include "bake/verify/Implication.h"
#include "bake/verify/PoseBox.h"

namespace tss {

namespace {

using namespace verify;

VerifyResult refused(std::string reason) {
    VerifyResult result;
    result.reason = std::move(reason);
    return result;
}

double bandOf(const Models& models, const VerifyOptions& options) {
    return options.band >= 0 ? options.band : 1e-9 * models.extent + 1e-12 * models.size;
}

} // namespace

VerifyResult verifyTable(const SphereSet& a, const SphereSet& b, const Table& table, const Motion& motion,
                         const VerifyOptions& options, const Progress& progress) {
    checkMotion(motion);
    if (std::string mismatch = motionMismatch(table.motion, motion); !mismatch.empty())
        return refused(mismatch);
    if (!(table.epsilon >= 0) || !(table.gapDepth >= 0) || !(table.gapMargin >= 0))
        return refused("the table states no bound");
    const Models models(a, b, motion, options);
    const double band = bandOf(models, options);
    Claim claim;
    std::string reason;
    claim.tests = matchTests(models, table, band, reason);
    if (!reason.empty()) return refused(reason);
    claim.epsilon = table.epsilon + band;
    claim.depth = table.gapDepth;
    claim.margin = table.gapMargin;
    VerifyResult result = proveClaim(models, claim, options.cells, progress);
    result.band = band;
    return result;
}

} // namespace tss
