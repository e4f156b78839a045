#include "bake/verify/Implication.h"

#include "bake/base/Parallel.h"
#include "bake/verify/BoxProver.h"

#include <memory>

namespace tss::verify {

namespace {

struct PartOutcome {
    BoxProver::Outcome outcome = BoxProver::Outcome::Shown;
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
        if (outcome == BoxProver::Outcome::Broken || outcome == BoxProver::Outcome::Undecided) {
            part.outcome = outcome;
            break;
        }
        for (Job& half : halves) part.left.push_back(std::move(half));
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
    std::vector<std::unique_ptr<BoxProver>> provers(width);
    while (!jobs.empty()) {
        if ((mostCells > 0 && result.cells >= mostCells) || !report(progress, "verify", 0)) {
            result.reason = "stopped before everything was shown";
            return result;
        }
        const std::size_t count = std::min(width, jobs.size());
        std::vector<PartOutcome> parts(count);
        parallelFor(count, [&](std::size_t k) {
            if (!provers[k]) provers[k] = std::make_unique<BoxProver>(models, claim);
            parts[k] = runPart(*provers[k], std::move(jobs[jobs.size() - 1 - k]), count < width ? 16 : 512);
        });
        jobs.resize(jobs.size() - count);
        for (std::size_t k = count; k-- > 0;) {
            result.cells += parts[k].cells;
            for (Job& job : parts[k].left) jobs.push_back(std::move(job));
        }
        for (PartOutcome& part : parts) {
            if (part.outcome == BoxProver::Outcome::Shown) continue;
            const std::uint64_t cells = result.cells;
            result = std::move(part.broken);
            result.cells = cells;
            result.reason = part.outcome == BoxProver::Outcome::Broken
                                ? "at a pose the models touch and the table does not answer"
                                : "near a pose it cannot be told from rounding whether the table answers";
            return result;
        }
    }
    result.proven = true;
    return result;
}

} // namespace tss::verify
