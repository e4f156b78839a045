#include "bake/pipeline/BakePair.h"

#include "bake/base/Error.h"
#include "bake/geometry/PartSet.h"
#include "bake/model/SourceHash.h"
#include "bake/pipeline/BoundTable.h"
#include "bake/pipeline/SelectTests.h"

#include <cmath>
#include <fmt/format.h>

namespace tss {

namespace {

FitRecord recorded(FitRecord figures, const SphereFit& fit) {
    figures.coverage = boundOrUnknown(fit.coverage);
    figures.protrusion = boundOrUnknown(fit.protrusion);
    return figures;
}

BakeRecord recordOf(const PairTask& task, const CandidatePairs& candidates) {
    BakeRecord record;
    record.spheresA = task.spheres.a.spheres.size();
    record.spheresB = task.spheres.b.spheres.size();
    record.candidatePairs = allListed(candidates, task.options) ? candidates.pairs.size() : 0;
    record.fitA = recorded(task.spheres.figuresA, task.spheres.a);
    record.fitB = recorded(task.spheres.figuresB, task.spheres.b);
    return record;
}

Table tableOf(const PairTask& task, const Selection& selection) {
    const BakeOptions& options = task.options;
    Table table = makeTable(task.spheres.a.spheres, task.spheres.b.spheres, selection.reduced.pairs,
                            selection.reduced.restGaps, task.motion, nullptr, nullptr,
                            options.keepSpheres ? Keep::All : Keep::Used);
    table.epsilon = selection.epsilon;
    table.gapDepth = options.reduce == ReduceMethod::Cover ? options.depth : 0;
    table.certified = selection.certified;
    table.restRegion = task.ruled.region;
    return table;
}

void noteFit(const Body& body, const SphereFit& fit, std::vector<std::string>& notes) {
    if (!fit.note.empty()) notes.push_back(body.path + ": " + fit.note);
    if (!std::isfinite(fit.enclosed))
        notes.push_back(body.path +
                        ": whether the other body ever stands inside without touching could not be "
                        "decided for all poses: how early contact may be reported is not known");
}

/// Bounds that are true of next to nothing are to be known as that.
void noteExempt(const Body& body, const std::vector<SurfacePart>& parts, std::vector<std::string>& notes) {
    constexpr double most = 0.9;
    const double share = parts.empty() ? 0 : area(body.mesh, parts) / area(body.mesh);
    if (share > most)
        notes.push_back(fmt::format("{}: {:.0f} % of its surface is exempt, for it overlaps the other body "
                                    "at rest or hangs together with what does: the bounds are about the rest "
                                    "alone; a finer --tolerance or a rest pose with less overlap leaves more",
                                    body.path, 100 * share));
}

} // namespace

PairTable tabulatePair(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options,
                       PairReport& report, const Progress& progress) {
    const PairTask task = pairTask(spheres, motion, options);
    // Search: which pairs of spheres can meet.
    const CandidatePairs candidates = searchPair(task, progress);
    noteRest(spheres, task.ruled, motion, options, report.notes);
    // Select: the few that answer for all, or the proof that there are none.
    Selection selection = selectTests(task, candidates, report.notes, progress);
    // Bound: what that says of the meshes.
    boundProof(selection, task);
    BakeRecord record = recordOf(task, candidates);
    if (selection.proof) {
        selection.proof->method = methodName(options);
        selection.proof->record = record;
        return {nullptr, std::make_shared<NeverCollides>(*selection.proof)};
    }
    auto table = std::make_shared<Table>(tableOf(task, selection));
    boundTable(*table, task);
    table->method = methodName(options);
    table->record = record;
    table->record.lowerBound = static_cast<std::uint64_t>(std::ceil(selection.reduced.lowerBound));
    report.epsilon = table->epsilon;
    return {table, nullptr};
}

void bakePair(SceneModel& scene, Pair& pair, const BakeOptions& options, PairReport& report,
              const Progress& progress) {
    const Body &a = scene.bodies[pair.bodyA], &b = scene.bodies[pair.bodyB];
    const Motion motion = pairMotion(scene, pair);
    checkMotion(motion);
    // Fill: both bodies with spheres, and how well these fit.
    PairSpheres spheres = fillPair(scene, pair, motion, options, progress);
    if (!tss::report(progress, "spheres", 1)) throw InputError("stopped before the table was made");
    measureSpheres(scene, pair, spheres);
    noteFit(a, spheres.a, report.notes);
    noteFit(b, spheres.b, report.notes);
    // Search, select, bound.
    PairTable made = tabulatePair(spheres, motion, options, report, progress);
    // Store: with the hash by which a stale table is told.
    pair.table = std::move(made.table);
    pair.proof = std::move(made.proof);
    if (pair.table) {
        noteExempt(a, pair.table->restRegion.a, report.notes);
        noteExempt(b, pair.table->restRegion.b, report.notes);
    }
    pair.sourceHash = sourceHash(scene, pair);
}

} // namespace tss
