#include "bake/verify/Implication.h"

#include "bake/base/Batches.h"
#include "bake/verify/BoxProver.h"

#include <memory>
#include <tbb/enumerable_thread_specific.h>

namespace tss::verify {

namespace {

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

} // namespace

VerifyResult proveClaim(const Models& models, const Claim& claim, std::uint64_t mostCells,
                        const Progress& progress) {
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
        if ((mostCells > 0 && result.cells >= mostCells) || !report(progress, "verify", 0)) {
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

} // namespace tss::verify
