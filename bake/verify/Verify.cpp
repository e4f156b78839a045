#include "bake/verify/Verify.h"

#include "bake/base/Batches.h"
#include "bake/verify/BoxProver.h"

#include <memory>
#include <tbb/enumerable_thread_specific.h>

namespace tss {

namespace {

using namespace verify;

VerifyResult refused(std::string reason) {
    VerifyResult result;
    result.reason = std::move(reason);
    return result;
}

struct PartOutcome {
    Outcome outcome = Outcome::Shown;
    VerifyResult broken;
    std::uint64_t cells = 0;
    std::vector<Job> left;
};

PartOutcome runPart(BoxProver& prover, Job job, std::uint64_t steps) {
    PartOutcome part;
    part.left.push_back(std::move(job));
    while (!part.left.empty() && part.cells < steps) {
        const Job next = std::move(part.left.back());
        part.left.pop_back();
        std::vector<Job> halves;
        const auto outcome = prover.judge(next, halves, part.broken);
        ++part.cells;
        if (outcome == Outcome::Broken || outcome == Outcome::Undecided) {
            part.outcome = outcome;
            break;
        }
        std::move(halves.begin(), halves.end(), std::back_inserter(part.left));
    }
    return part;
}

/// Shows the claim for every pose of the motion's limits, or finds a pose that breaks it. epsilon already
/// holds the rounding band.
VerifyResult proveClaim(const Models& models, const Claim& claim, const Progress& progress) {
    VerifyResult result;
    if (models.a.empty() || models.b.empty()) {
        result.proven = true;
        return result;
    }
    auto open = std::make_shared<Open>();
    open->balls.push_back({models.treeA.root(), models.treeB.root()});
    for (std::uint32_t k = 0; k < claim.tests.size(); ++k) open->tests.push_back(k);
    std::vector<Job> jobs{{limitsOf(models.motion), std::move(open)}};

    constexpr std::size_t width = 64;
    tbb::enumerable_thread_specific<BoxProver> provers([&] { return BoxProver(models, claim); });
    while (!jobs.empty()) {
        if (!report(progress, "verify", 0)) {
            result.reason = "stopped before everything was shown";
            return result;
        }
        auto parts = runLast(jobs, width, [&](Job job, std::size_t count) {
            return runPart(provers.local(), std::move(job), count < width ? 16 : 512);
        });
        for (const PartOutcome& part : parts) result.cells += part.cells;
        for (PartOutcome& part : parts) {
            if (part.outcome == Outcome::Shown) continue;
            const std::uint64_t cells = result.cells;
            result = std::move(part.broken);
            result.cells = cells;
            result.reason = part.outcome == Outcome::Broken
                                ? "at a pose the models touch and the table does not answer"
                                : "near a pose it cannot be told from rounding whether the table answers";
            return result;
        }
    }
    result.proven = true;
    return result;
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
    const double band = 1e-9 * models.extent + 1e-12 * models.size;
    Claim claim;
    std::string reason;
    claim.tests = matchTests(models, table, band, reason);
    if (!reason.empty()) return refused(reason);
    claim.epsilon = table.epsilon + band;
    claim.depth = table.gapDepth;
    claim.margin = table.gapMargin;
    VerifyResult result = proveClaim(models, claim, progress);
    result.band = band;
    return result;
}

} // namespace tss
