#include "bake/verify/Verify.h"

#include "bake/verify/Implication.h"
#include "bake/verify/PoseBox.h"

#include <algorithm>

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

/// How much later than the spheres touch the table may say so. A bound on misses that is no more than what
/// the spheres lack of the surfaces says: by nothing.
double lateness(const Table& table) {
    if (table.boundMiss < 0) return table.epsilon;
    const double lacking =
        std::max(0.0, table.record.fitA.coverage) + std::max(0.0, table.record.fitB.coverage);
    const double late = table.boundMiss - lacking;
    // What is rounding of the sum claims to be none, and is held to that.
    return late > 1e-12 * table.boundMiss ? std::min(late * (1 + 1e-12), table.epsilon) : 0;
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
    const double late = lateness(table);
    if (table.boundMiss >= 0 && late > table.gapDepth)
        return refused("its bound on misses needs the gap to be right as deep as contact may be late");
    claim.epsilon = late + band;
    claim.depth = table.gapDepth;
    claim.margin = table.gapMargin;
    VerifyResult result = proveClaim(models, claim, options.cells, progress);
    result.band = band;
    return result;
}

VerifyResult verifyNeverCollides(const SphereSet& a, const SphereSet& b, double clearance,
                                 const Motion& motion, const VerifyOptions& options,
                                 const Progress& progress) {
    checkMotion(motion);
    const Models models(a, b, motion, options);
    const double band = bandOf(models, options);
    Claim claim;
    claim.margin = clearance - band;
    VerifyResult result = proveClaim(models, claim, options.cells, progress);
    result.band = band;
    if (!result.reason.empty() && !result.pose.empty())
        result.reason = "at a pose the models are nearer than the clearance";
    return result;
}

} // namespace tss
