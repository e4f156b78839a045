#include "bake/check/VerifyPair.h"

#include "bake/base/Error.h"
#include "bake/model/SourceHash.h"
#include "bake/motion/WholeTurn.h"
#include "bake/pipeline/RestRule.h"
#include "bake/verify/Verify.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss {

namespace {

/// The gap that the table states, against all spheres.
void verifyGap(PairVerdict& verdict, const SceneModel& scene, const Pair& pair, const Motion& motion,
               const Progress& progress) {
    const BakeOptions options = optionsFor(scene, pair);
    PairSpheres spheres;
    bool stopped = false;
    try {
        spheres = fillPair(scene, pair, motion, options, progress);
        stopped = !report(progress, "spheres", 1);
    } catch (const InputError&) { // also thrown where the filling was stopped
        stopped = !report(progress, "spheres", 0);
        if (!stopped) throw;
    }
    if (stopped) {
        verdict.reason = "stopped before its spheres were made again";
        return;
    }
    const RuleAtRest ruled = ruleAtRest(spheres, motion, options);
    VerifyOptions how;
    how.regionA = ruled.rule.regionA();
    how.regionB = ruled.rule.regionB();
    how.depth = options.atRest == AtRest::Offset ? -ruled.rule.threshold() : -1;
    const VerifyResult result =
        verifyTable(spheres.a.spheres, spheres.b.spheres, *pair.table, motion, how, progress);
    verdict.cells += result.cells;
    verdict.band = std::max(verdict.band, result.band);
    verdict.reason = result.reason;
    verdict.pose = result.pose;
    verdict.notes.push_back(
        "the gap it states is proven against spheres that the baker's own code makes again");
}

/// What a person should know about what was proven of the meshes.
void addNotes(PairVerdict& verdict, const Pair& pair, double metersPerUnit) {
    const MeshVerdict& meshes = verdict.meshes;
    if (pair.table && !pair.table->boundMiss)
        verdict.notes.push_back("how late it reports contact is not stated, and nothing is proven of it");
    if (pair.table && !pair.table->boundEarly)
        verdict.notes.push_back("how early it reports contact is not stated, and nothing is proven of it");
    if (meshes.fillings)
        verdict.notes.push_back(
            "what is behind openings of a mesh counts as body in the bound on early reports");
    if (!(pair.table ? pair.table->restRegion : pair.proof->restRegion).empty()) {
        verdict.notes.push_back(fmt::format("nothing is proven of contact between the parts of the surfaces "
                                            "that overlap at rest: {:.3g} % of A with {:.3g} % of B",
                                            100 * meshes.exempt.shareA, 100 * meshes.exempt.shareB));
        if (meshes.farthestExempt > 0)
            verdict.notes.push_back(
                fmt::format("pieces of these parts are up to {} from the other body at rest",
                            lengthText(meshes.farthestExempt, metersPerUnit)));
    }
}

} // namespace

PairVerdict verifyPair(const SceneModel& scene, const Pair& pair, const Progress& progress) {
    PairVerdict verdict;
    const auto fails = [&](std::string reason) {
        verdict.reason = std::move(reason);
        return verdict;
    };
    if (!pair.table && !pair.proof) return fails("has not been baked");
    if (pair.table && !pair.table->certified)
        return fails("is not certified: it was made from samples, and states no bound");
    if (std::string stale = staleness(scene, pair); !stale.empty()) return fails(stale);
    const Motion motion = onceRound(pairMotion(scene, pair));
    const TriangleMesh &a = scene.bodies[pair.bodyA].mesh, &b = scene.bodies[pair.bodyB].mesh;
    for (const int body : {pair.bodyA, pair.bodyB})
        if (scene.bodies[body].mesh.empty())
            throw InputError(Where{"", "", scene.bodies[body].path}, "expected a mesh, the body has none");
    verdict.meshes = pair.table ? verifyOnMeshes(a, b, *pair.table, motion, 0, progress)
                                : verifyOnMeshes(a, b, *pair.proof, motion, 0, progress);
    const BakeRecord& record = pair.table ? pair.table->record : pair.proof->record;
    verdict.spheresA = record.spheresA;
    verdict.spheresB = record.spheresB;
    verdict.cells = verdict.meshes.cells;
    verdict.band = verdict.meshes.band;
    verdict.pose = verdict.meshes.pose;
    verdict.reason = verdict.meshes.reason;
    addNotes(verdict, pair, scene.metersPerUnit);
    if (verdict.holds() && pair.table && (pair.table->gapDepth > 0 || pair.table->gapMargin > 0))
        verifyGap(verdict, scene, pair, motion, progress);
    return verdict;
}

} // namespace tss
