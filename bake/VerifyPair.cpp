#include "bake/VerifyPair.h"

#include "bake/RestRule.h"
#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/Solid.h"
#include "bake/scene/SourceHash.h"
#include "bake/verify/Verify.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss {

namespace {

/// The spheres that the table answers for: those stored with --keep-spheres, or made again from the meshes.
PairSpheres wholeSpheres(const SceneModel& scene, const Pair& pair, const Motion& motion,
                         const BakeOptions& options, const Progress& progress) {
    const BakeRecord& record = pair.table ? pair.table->record : pair.proof->record;
    PairSpheres spheres;
    if (pair.table && pair.table->restRegion.empty() && pair.table->a.size() == record.spheresA &&
        pair.table->b.size() == record.spheresB) {
        spheres.a.spheres = pair.table->a;
        spheres.b.spheres = pair.table->b;
        return spheres;
    }
    spheres = fillPair(scene, pair, motion, options, progress);
    if (!report(progress, "spheres", 1))
        throw InputError(Where{"", "", pair.path}, "stopped before its spheres were made again");
    if (spheres.a.spheres.size() != record.spheresA || spheres.b.spheres.size() != record.spheresB)
        throw InputError(
            Where{"", "", pair.path},
            fmt::format("was made from {} + {} spheres, but its meshes and settings give {} + {}",
                        record.spheresA, record.spheresB, spheres.a.spheres.size(),
                        spheres.b.spheres.size()));
    return spheres;
}

/// The farthest that a sphere sticks out of its body.
double protrusion(const TriangleMesh& mesh, const SphereSet& spheres) {
    const Solid solid(cleaned(mesh));
    double worst = 0;
    for (const Sphere& sphere : spheres)
        worst = std::max(worst, solid.protrusion(sphere.centre, sphere.radius));
    return worst;
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
    const BakeOptions options = optionsFor(pair.settings, {}, scene.metersPerUnit);
    const Motion motion = pairMotion(scene, pair);
    const PairSpheres spheres = wholeSpheres(scene, pair, motion, options, progress);
    const SphereSet &a = spheres.a.spheres, &b = spheres.b.spheres;
    const RuleAtRest ruled = ruleAtRest(spheres, motion, options);
    VerifyOptions how;
    how.regionA = ruled.rule.regionA();
    how.regionB = ruled.rule.regionB();
    how.depth = options.atRest == AtRest::Offset ? -ruled.rule.threshold() : -1;
    const VerifyResult result =
        pair.proof ? verifyNeverCollides(a, b, pair.proof->clearance * (1 - 1e-9), motion, how, progress)
                   : verifyTable(a, b, *pair.table, motion, how, progress);
    verdict.spheresA = a.size();
    verdict.spheresB = b.size();
    verdict.cells = result.cells;
    verdict.band = result.band;
    verdict.pose = result.pose;
    if (!result.proven) return fails(result.reason);
    if (!pair.table || pair.table->boundEarly < 0) return verdict;
    verdict.early = protrusion(scene.bodies[pair.bodyA].mesh, pair.table->a) +
                    protrusion(scene.bodies[pair.bodyB].mesh, pair.table->b) + pair.table->epsilon;
    if (verdict.early <= pair.table->boundEarly * (1 + 1e-6)) return verdict;
    return fails(fmt::format("its spheres stick out by {:.6g} together, more than the stored bound of {:.6g}",
                             verdict.early, pair.table->boundEarly));
}

} // namespace tss
