#include "bake/pipeline/BakePair.h"

#include "bake/base/Error.h"
#include "bake/base/Infinity.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/PartSet.h"
#include "bake/model/SourceHash.h"
#include "bake/motion/WholeTurn.h"
#include "bake/pipeline/SelectTests.h"
#include "bake/search/CertifiedSearch.h"
#include "bake/search/RestContact.h"
#include "bake/search/SurfacesApart.h"

#include <cmath>
#include <fmt/format.h>
#include <iterator>

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

void noteFit(const Body& body, const SphereFit& fit, Inside inside, std::vector<std::string>& notes) {
    if (!fit.note.empty()) notes.push_back(body.path + ": " + fit.note);
    if (!std::isfinite(fit.enclosed) && inside == Inside::Free)
        notes.push_back(body.path +
                        ": whether the other body ever stands inside without touching could not be decided "
                        "for all poses: how early contact may be reported is not known");
}

/// Notes where nearly all of a surface is exempt, so that the bounds are about next to nothing.
void noteExempt(const Body& body, const std::vector<SurfacePart>& parts, std::vector<std::string>& notes) {
    constexpr double most = 0.9;
    const double share = parts.empty() ? 0 : area(body.mesh, parts) / area(body.mesh);
    if (share > most)
        notes.push_back(fmt::format("{}: {:.0f} % of its surface is exempt, for it overlaps the other body "
                                    "at rest or hangs together with what does: the bounds are about the rest "
                                    "alone; a finer --tolerance or a rest pose with less overlap leaves more",
                                    body.path, 100 * share));
}

/// A pair's table from one set of spheres.
struct Attempt {
    PairSpheres spheres;
    PairTable made;    ///< neither table nor proof: the budget ended before anything was proven
    std::string ended; ///< what is said of that
    PairReport report;

    /// A bound of how far apart the surfaces may be where the table reports contact, scene units.
    double early() const {
        const double lag = made.proof ? 0 : made.table ? made.table->epsilon : infinity;
        return lag + spheres.protrusions;
    }
};

struct PairBaker {
    const SceneModel& scene;
    const Pair& pair;
    const BakeOptions& options;
    const Motion& motion;
    const Progress& progress;

    /// Search, select, bound.
    Attempt tabulated(PairSpheres spheres) const {
        Attempt attempt{std::move(spheres), {}, {}, {}};
        noteFit(scene.bodies[pair.bodyA], attempt.spheres.a, options.inside, attempt.report.notes);
        noteFit(scene.bodies[pair.bodyB], attempt.spheres.b, options.inside, attempt.report.notes);
        try {
            attempt.made = tabulatePair(attempt.spheres, motion, options, attempt.report, progress);
        } catch (const BudgetEnded& error) {
            attempt.ended = error.message;
        }
        return attempt;
    }

    PairSpheres measured(PairSpheres spheres) const {
        if (!report(progress, "spheres", 1)) throw InputError("stopped before the table was made");
        measureSpheres(scene, pair, spheres);
        return spheres;
    }

    /// The usual way: fills both bodies with spheres, then selects the few tests that answer for all.
    Attempt few() const {
        Attempt attempt = tabulated(measured(fillPair(scene, pair, motion, options, progress)));
        // Without tests nothing meets. Spheres of a wider zone may show how far apart the surfaces stay.
        const Table* table = attempt.made.table.get();
        const double clearance = attempt.spheres.clearanceAtRest;
        if (!attempt.spheres.zoneA || !table || !table->certified || table->testCount() > 0 ||
            !(clearance > 0))
            return attempt;
        for (const double share : {0.5, 0.1, 0.02}) {
            Attempt reached = tabulated(measured(
                fillWithin(scene, pair, motion, options,
                           share * std::min(clearance, options.tolerance.value_or(clearance)), progress)));
            if (reached.made.proof) return reached;
        }
        return attempt;
    }

    /// The proof that the surfaces never meet, where it is found without any spheres. nearest: becomes the
    /// least distance seen, scene units.
    std::optional<PairTable> surfacesNeverMeet(double& nearest) const {
        if (options.spheres != SphereMethod::Medial || options.search != SearchMethod::Certified)
            return std::nullopt;
        const TriangleMesh &a = scene.bodies[pair.bodyA].mesh, &b = scene.bodies[pair.bodyB].mesh;
        const auto apart =
            surfacesApart(cleaned(a), cleaned(b), motion, touchingDistance(a, b, motion), progress, &nearest);
        if (!apart) return std::nullopt;
        return PairTable{nullptr, std::make_shared<NeverCollides>(NeverCollides{
                                      apart->clearance, apart->cells, "surfaces/certified", {}, {}})};
    }

    /// Where a table would have to test all pairs of spheres: the proof that spheres no finer than asked for
    /// never meet, where it is found quickly. nearest: the least distance of the surfaces seen, scene units:
    /// spheres about them come as near.
    std::optional<Attempt> apart(double nearest) const {
        constexpr double most = 1e6; // pairs of spheres
        if (!manyDofs(motion, options) || options.depth > 0 || !(nearest > 0)) return std::nullopt;
        for (const double tolerance : coarserTolerances(scene, pair, options, nearest)) {
            if (tolerance > nearest) break; // spheres that are as fine as asked for meet
            BakeOptions coarse = options;
            coarse.tolerance = tolerance;
            PairSpheres spheres = fillSolid(scene, pair, motion, coarse, tolerance, progress);
            if (double(spheres.a.spheres.size()) * double(spheres.b.spheres.size()) > most) break;
            const PairTask task = pairTask(spheres, motion, coarse);
            if (!neverCollide(spheres.a.spheres, spheres.b.spheres, motion, task.ruled.rule, task.margin,
                              progress))
                continue;
            Attempt attempt = tabulated(measured(std::move(spheres)));
            if (attempt.made.proof) return attempt;
        }
        return std::nullopt;
    }

    /// Where the budget ended far from the epsilon asked for: a table that tests every pair of spheres that
    /// may meet, in place of a cover. Of the same spheres, or of coarser ones where these have too many
    /// pairs. Nothing where that table would report contact as early as the cover does.
    std::optional<Attempt> allInstead(const Attempt& few) const {
        const bool far =
            few.early() > std::max(options.epsilon, few.spheres.protrusions) + few.spheres.protrusions;
        if (!far || few.spheres.testAll) {
            if (!few.ended.empty()) throw InputError(few.ended);
            return std::nullopt;
        }
        PairSpheres spheres = few.spheres;
        spheres.testAll = canTestAll(spheres, options);
        if (!spheres.testAll && mayCoarsenToTestAll(options))
            spheres = measured(fillToTestAll(scene, pair, motion, options, progress));
        if (spheres.testAll && spheres.protrusions < few.early()) return tabulated(std::move(spheres));
        if (few.ended.empty()) return std::nullopt;
        if (options.budget) throw InputError(few.ended);
        // The search ended by its limit of looks, and all pairs are too many to test: search without a limit.
        BakeOptions unlimited = options;
        unlimited.budget = 0;
        return PairBaker{scene, pair, unlimited, motion, progress}.tabulated(few.spheres);
    }
};

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
    const Motion motion = pairMotion(scene, pair);
    checkMotion(motion);
    const Motion once = onceRound(motion);
    const PairBaker baker{scene, pair, options, once, progress};
    PairTable made;
    double nearest = infinity; // of the surfaces, as far as was seen
    if (std::optional<PairTable> never = baker.surfacesNeverMeet(nearest)) {
        made = std::move(*never);
    } else {
        std::optional<Attempt> apart = baker.apart(nearest);
        Attempt attempt = apart ? std::move(*apart) : baker.few();
        if (std::optional<Attempt> all = baker.allInstead(attempt)) attempt = std::move(*all);
        made = std::move(attempt.made);
        if (!made.table && !made.proof) throw BudgetEnded(attempt.ended);
        report.epsilon = attempt.report.epsilon;
        std::move(attempt.report.notes.begin(), attempt.report.notes.end(), std::back_inserter(report.notes));
    }
    // Store: with the limits of the joints, and the hash by which a stale table is told.
    std::shared_ptr<Table> table;
    if (made.table) {
        table = std::make_shared<Table>(*made.table);
        table->motion = motion;
    }
    pair.table = std::move(table);
    pair.proof = std::move(made.proof);
    if (pair.table) {
        noteExempt(scene.bodies[pair.bodyA], pair.table->restRegion.a, report.notes);
        noteExempt(scene.bodies[pair.bodyB], pair.table->restRegion.b, report.notes);
    }
    pair.sourceHash = sourceHash(scene, pair);
}

} // namespace tss
