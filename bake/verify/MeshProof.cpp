#include "bake/verify/MeshProof.h"

#include "bake/base/Batches.h"
#include "bake/verify/MeshBox.h"

#include <memory>
#include <tbb/enumerable_thread_specific.h>

namespace tss::verify {

namespace {

struct MeshJob {
    Box box;
    std::shared_ptr<const std::vector<PiecePair>> open; ///< pairs still to be shown
    double share = 1;                                   ///< of Q
};

struct MeshPart {
    Outcome outcome = Outcome::Shown;
    MeshProofResult broken;
    std::uint64_t cells = 0, work = 0;
    double shown = 0; ///< share of Q
    std::vector<MeshJob> left;
};

MeshPart runMeshPart(MeshBox& prover, MeshJob job, std::uint64_t work) {
    MeshPart part;
    part.left.push_back(std::move(job));
    const std::uint64_t from = prover.work();
    while (!part.left.empty() && prover.work() - from < work) {
        const MeshJob next = std::move(part.left.back());
        part.left.pop_back();
        auto left = std::make_shared<std::vector<PiecePair>>();
        std::size_t cut = 0;
        double at = 0;
        const Outcome outcome = prover.judge(next.box, *next.open, *left, cut, at, part.broken);
        ++part.cells;
        if (outcome == Outcome::Shown) {
            part.shown += next.share;
        } else if (outcome == Outcome::Split) {
            left->shrink_to_fit();
            for (Box& half : next.box.halves(cut, at))
                part.left.push_back({std::move(half), left, next.share / 2});
        } else {
            part.outcome = outcome;
            break;
        }
    }
    part.work = prover.work() - from;
    return part;
}

/// Looks for what is plainly wrong before anything is proven: at rest, and at poses spread over Q.
bool brokenAtOnce(MeshBox& box, const Motion& motion, const std::vector<PiecePair>& open,
                  const Progress& progress, MeshProofResult& result) {
    std::vector<std::vector<double>> poses = spreadOverLimits(motion, 400, 0.05);
    poses.insert(poses.begin(), clampToLimits(motion, restValues(motion)));
    bool broken = false;
    for (const std::vector<double>& q : poses) {
        if (!report(progress, "verify", 0)) break;
        if ((broken = box.breaksAt(q, open, result))) break;
    }
    if (!broken) result.work = box.work();
    return broken;
}

} // namespace

std::vector<MeshTest> meshTests(const Table& table) {
    std::vector<MeshTest> all;
    for (std::uint32_t i = 0; i + 1 < table.rowOffsets.size(); ++i)
        for (std::uint32_t k = table.rowOffsets[i]; k < table.rowOffsets[i + 1]; ++k) {
            const std::uint32_t j = table.columns[k];
            const Sphere &a = table.a[i], &b = table.b[j];
            const double threshold = table.restGaps.empty() ? 0 : table.restGaps[k];
            all.push_back(
                {a.centre, b.centre, a.radius + b.radius + threshold, threshold, i, j, a.radius, b.radius});
        }
    return all;
}

MeshProofResult proveMeshClaim(const SurfaceTree& a, const SurfaceTree& b, const Motion& motion, double size,
                               const MeshClaim& claim, const Progress& progress) {
    MeshProofResult result;
    if (a.nodes.empty() || b.nodes.empty()) {
        result.proven = true;
        return result;
    }
    const TestTree tests(claim.tests);
    tbb::enumerable_thread_specific<MeshBox> provers(
        [&] { return MeshBox(a, b, motion, size, claim, tests); });
    const std::vector<PiecePair> all{{{a.root(), 1}, {b.root(), 1}}};
    const std::string broken = claim.near > 0 ? "at a pose the meshes are nearer than the clearance"
                                              : "at a pose the meshes meet and the table does not answer";
    if (brokenAtOnce(provers.local(), motion, all, progress, result)) {
        result.reason = broken;
        return result;
    }
    const auto open = std::make_shared<const std::vector<PiecePair>>(pairsNotHeld(a, b, claim).value_or(all));
    std::vector<MeshJob> jobs;
    if (!open->empty()) jobs.push_back({limitsOf(motion), open});
    double shown = 0;
    constexpr std::size_t width = 64;
    while (!jobs.empty()) {
        if ((claim.work > 0 && result.work >= claim.work) || !report(progress, "verify", shown)) {
            result.reason = claim.work > 0 && result.work >= claim.work
                                ? "not proven within the effort granted"
                                : "stopped before everything was shown";
            return result;
        }
        const auto parts = runLast(jobs, width, [&](MeshJob job, std::size_t count) {
            return runMeshPart(provers.local(), std::move(job), count < width ? 20'000 : 50'000);
        });
        for (const MeshPart& part : parts) {
            result.cells += part.cells;
            result.work += part.work;
            shown += part.shown;
        }
        for (const MeshPart& part : parts) {
            if (part.outcome == Outcome::Shown) continue;
            result.pose = part.broken.pose;
            result.reason = part.outcome == Outcome::Broken
                                ? broken
                                : "near a pose it cannot be told from rounding whether the claim holds";
            return result;
        }
    }
    result.proven = true;
    return result;
}

} // namespace tss::verify
