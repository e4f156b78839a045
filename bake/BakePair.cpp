#include "bake/BakePair.h"

#include "bake/ContactZoneFit.h"
#include "bake/HollowBodies.h"
#include "bake/NestedBodies.h"
#include "bake/RestRule.h"
#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/PartSet.h"
#include "bake/geometry/Solid.h"
#include "bake/model/SourceHash.h"
#include "bake/reduce/CertifiedCover.h"
#include "bake/reduce/Cooccurrence.h"
#include "bake/reduce/Minimal.h"
#include "bake/search/CertifiedSearch.h"
#include "bake/search/SampledSearch.h"
#include "bake/spheres/FitMetrics.h"
#include "bake/spheres/GenerateSpheres.h"
#include "bake/spheres/RoundToFloat.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tss {

namespace {

/// Over more DOFs than these neither what is within reach nor a cover is found in any time that people have,
/// or within a budget of seconds.
bool manyDofs(const Motion& motion, const BakeOptions& options) {
    return motion.dofCount() > (options.budget > 0 ? 3u : 6u);
}

const char* name(SphereMethod method) {
    switch (method) {
    case SphereMethod::Medial:
        return "medial";
    case SphereMethod::Shrinking:
        return "shrinking";
    case SphereMethod::Surface:
        return "surface";
    case SphereMethod::Growth:
        return "growth";
    }
    return "?";
}

const char* name(ReduceMethod method) {
    switch (method) {
    case ReduceMethod::Cover:
        return "cover";
    case ReduceMethod::Cooccurrence:
        return "cooccurrence";
    case ReduceMethod::Minimal:
        return "minimal";
    case ReduceMethod::None:
        return "none";
    }
    return "?";
}

const TriangleMesh& meshOf(const Body& body) {
    if (body.mesh.empty()) throw InputError(Where{"", "", body.path}, "expected a mesh, the body has none");
    return body.mesh;
}

SphereFit wholeBody(const Body& body, const BakeOptions& options, double tolerance, bool hollow,
                    const Progress& progress) {
    SphereOptions how = sphereOptions(options, tolerance);
    how.hollow = hollow;
    return fitSpheres(cleaned(meshOf(body)), how, progress);
}

/// The spheres that touch without reason show it (see findHollow()).
HollowBodies hollowBodies(const Body& a, const Body& b, const PairSpheres& spheres, const HollowBodies& known,
                          const Motion& motion, double tolerance, const Progress& progress) {
    const auto solid = [](const Body& body, bool hollow) {
        return Solid(cleaned(meshOf(body)), hollow ? Interior::Hollow : Interior::Filled);
    };
    const Solid solidA = solid(a, known.a), solidB = solid(b, known.b);
    if (!solidA.open() && !solidB.open()) return known;
    const HollowBodies more =
        findHollow({solidA, MeshQuery(solidA.mesh()), spheres.a.spheres, spheres.a.protrusion},
                   {solidB, MeshQuery(solidB.mesh()), spheres.b.spheres, spheres.b.protrusion}, motion,
                   2 * tolerance, progress);
    return {known.a || more.a, known.b || more.b};
}

/// Spheres of two bodies whose surfaces are known never to come near each other, as coarse as shows it: what
/// can be proven again from the file alone.
PairSpheres spheresApart(const Body& a, const Body& b, const Motion& motion, double tolerance,
                         HollowBodies hollow, const ContactZoneFit& fit, const Progress& progress) {
    SphereOptions how;
    CertifiedSearchOptions apart;
    apart.measureClearance = false;
    apart.effort = 5'000'000;
    const double smaller = std::min(bounds(a.mesh).diagonal().norm(), bounds(b.mesh).diagonal().norm());
    for (how.tolerance = std::max(tolerance, smaller / 30);;) {
        SphereOptions howA = how, howB = how;
        howA.hollow = hollow.a;
        howB.hollow = hollow.b;
        howA.medial.neighbour = fit.a.neighbour;
        howB.medial.neighbour = fit.b.neighbour;
        PairSpheres spheres{fitSpheres(cleaned(meshOf(a)), howA, progress),
                            fitSpheres(cleaned(meshOf(b)), howB, progress),
                            {},
                            {},
                            {},
                            {},
                            fit.rest.clearance,
                            {}};
        const CandidatePairs meeting =
            searchCertified(spheres.a.spheres, spheres.b.spheres, motion, apart, progress);
        if (meeting.certified && meeting.pairs.empty()) return spheres;
        const HollowBodies now = hollowBodies(a, b, spheres, hollow, motion, how.tolerance, progress);
        const bool news = now.a != hollow.a || now.b != hollow.b;
        hollow = now;
        if (news) continue;
        if (how.tolerance <= tolerance) return spheres;
        how.tolerance = std::max(tolerance, how.tolerance / 2);
    }
}

/// Rounds the spheres as the file stores them and adds to the protrusion what that makes them stick out more.
void roundToFloat(SphereFit& fit) {
    double grown = 0;
    for (Sphere& sphere : fit.spheres) {
        const Sphere rounded = tss::roundToFloat(sphere);
        grown = std::max(grown, (rounded.centre - sphere.centre).norm() + rounded.radius - sphere.radius);
        sphere = rounded;
    }
    fit.protrusion += grown;
}

double known(double bound) {
    return std::isfinite(bound) ? bound : -1;
}

/// The figures of a fit; its bounds become those measured where these are better.
FitRecord measured(const Body& body, SphereFit& fit, const std::optional<std::vector<Patch>>& zone) {
    const Solid solid(cleaned(meshOf(body)), fit.hollow ? Interior::Hollow : Interior::Filled);
    FitMetrics metrics = measureFit(solid, fit.spheres, zone ? *zone : patchesOf(solid.mesh()));
    if (!fit.hollow) measureVolumes(metrics, solid, fit.spheres);
    fit.coverage = std::min(fit.coverage, metrics.coverage);
    fit.protrusion = std::min(fit.protrusion, metrics.protrusion);
    FitRecord figures;
    figures.coverageMean = known(metrics.coverageMean);
    figures.coverageP95 = known(metrics.coverageP95);
    figures.protrusionMean = known(metrics.protrusionMean);
    figures.protrusionP95 = known(metrics.protrusionP95);
    figures.volumeRatio = fit.hollow ? -1 : known(metrics.volumeRatio);
    return figures;
}

FitRecord recorded(FitRecord figures, const SphereFit& fit) {
    figures.coverage = known(fit.coverage);
    figures.protrusion = known(fit.protrusion);
    return figures;
}

SampledSearchOptions sampled(const BakeOptions& options, const ContactRule& rule) {
    SampledSearchOptions search;
    search.samples = static_cast<std::size_t>(options.samples);
    search.rule = rule;
    return search;
}

double defaultTolerance(const Body& a, const Body& b) {
    return std::min(bounds(a.mesh).diagonal().norm(), bounds(b.mesh).diagonal().norm()) / 500;
}

/// How near spheres must come to be asked for, so that a table's own gap is no larger wherever the meshes
/// meet: what the spheres lack of the surfaces (METHOD 3.5). 0 where that is nothing, or not known of all of
/// them.
double askedWithin(const SphereFit& a, const SphereFit& b, const BakeOptions& options) {
    const double lacking = a.coverage + b.coverage;
    const bool fitted = options.spheres == SphereMethod::Medial && options.search == SearchMethod::Certified;
    return fitted && std::isfinite(lacking) ? lacking : 0;
}

/// Pairs of spheres that answer for themselves are no more than a query can ask.
constexpr std::size_t mostPairsToAsk = 200'000;

bool asksAll(const SphereSet& a, const SphereSet& b, const Motion& motion, const BakeOptions& options) {
    return manyDofs(motion, options) && options.reduce == ReduceMethod::Cover &&
           options.search == SearchMethod::Certified && a.size() * b.size() <= mostPairsToAsk;
}

CandidatePairs search(const SphereSet& a, const SphereSet& b, const Motion& motion,
                      const BakeOptions& options, double margin, const ContactRule& rule,
                      const Progress& progress) {
    if (options.search == SearchMethod::Sampled)
        return searchSampled(a, b, motion, sampled(options, rule), progress);
    CertifiedSearchOptions certified;
    certified.rule = rule;
    certified.margin = margin;
    // The cover does without the list, which wide limits can make longer than anybody needs; only the others
    // wait.
    if (options.reduce == ReduceMethod::Cover)
        certified.effort = asksAll(a, b, motion, options) ? 5'000'000 : 50'000'000;
    return searchCertified(a, b, motion, certified, progress);
}

std::string methodName(const BakeOptions& options) {
    return std::string(name(options.spheres)) +
           (options.search == SearchMethod::Sampled ? "/sampled/" : "/certified/") + name(options.reduce);
}

/// The table's tests by the method asked for. Only the cover proves something about every pose.
struct Selection {
    Reduced reduced;
    double epsilon = 0;
    bool certified = false;
    std::optional<NeverCollides> proof; ///< there is nothing to select from
};

/// Every pair that the search has not ruled out; all, where it did not come to an end.
Selection selectAll(const SphereSet& a, const SphereSet& b, const CandidatePairs& candidates,
                    const Motion& motion, const ContactRule& rule, PairReport& report) {
    Selection selection;
    std::vector<SpherePair>& pairs = selection.reduced.pairs;
    if (candidates.certified) {
        pairs = candidates.pairs;
    } else {
        for (std::uint32_t i = 0; i < a.size(); ++i)
            for (std::uint32_t j = 0; j < b.size(); ++j)
                if (std::isfinite(rule.threshold({i, j}))) pairs.push_back({i, j});
    }
    selection.reduced.restGaps = rule.thresholds(pairs);
    selection.certified = true;
    report.notes.push_back(
        fmt::format("{} degrees of freedom are too many to find out which pairs of spheres "
                    "imply others: all {} that may meet are asked",
                    motion.dofCount(), pairs.size()));
    return selection;
}

Selection select(const SphereSet& a, const SphereSet& b, const CandidatePairs& candidates,
                 const Motion& motion, const BakeOptions& options, double margin, const ContactRule& rule,
                 PairReport& report, const Progress& progress) {
    Selection selection;
    switch (options.reduce) {
    case ReduceMethod::Cooccurrence:
        selection.reduced = reduceCooccurrence(candidates);
        break;
    case ReduceMethod::Minimal:
        selection.reduced = reduceMinimal(a, b, motion, sampled(options, rule), progress);
        break;
    case ReduceMethod::None:
        selection.reduced.pairs = candidates.pairs;
        selection.reduced.restGaps = candidates.restGaps;
        selection.certified = candidates.certified;
        break;
    case ReduceMethod::Cover: {
        CoverOptions cover;
        cover.epsilon = options.epsilon;
        cover.gapDepth = options.depth;
        cover.gapMargin = margin;
        cover.rule = rule;
        cover.seconds = options.budget;
        const bool sampled = options.search == SearchMethod::Sampled;
        const bool listed = sampled || candidates.certified;
        const CoverResult result =
            certifiedCover(a, b, listed ? &candidates : nullptr, motion, cover, progress);
        if (!std::isfinite(result.epsilon))
            throw InputError("the budget ended before any bound was proven: expected a longer --budget, or a "
                             "coarser --tolerance or --epsilon");
        selection.reduced = result;
        selection.epsilon = result.epsilon;
        selection.certified = !sampled;
        if (selection.certified && result.complete && result.pairs.empty())
            selection.proof = NeverCollides{result.clearance, result.cells, {}, {}, {}};
        if (!result.complete)
            report.notes.push_back(
                fmt::format("the budget ended first: epsilon {} scene units was reached, not {}",
                            result.epsilon, options.epsilon));
        break;
    }
    }
    return selection;
}

/// What the meshes may expect of a certified table, but for the region that overlaps at rest (METHOD 3.5).
void setBounds(Table& table, const SphereFit& a, const SphereFit& b, double margin, const RuleAtRest& ruled) {
    if (!table.certified) return;
    table.boundEarly = known(std::max({a.protrusion + b.protrusion + table.epsilon, a.enclosed, b.enclosed}));
    // Tests were chosen among the pairs that come within the margin: where the surfaces meet one does.
    if (!ruled.spheres && margin >= a.coverage + b.coverage) table.boundMiss = margin;
    if (!(table.epsilon > 0)) return;
    // Where spheres touch, some test's gap is at most epsilon: counted as contact from there on it misses
    // nothing. At rest all are farther apart than that.
    table.restGaps.resize(table.testCount(), 0);
    for (double& gap : table.restGaps) gap += table.epsilon;
}

/// Bounds that are true of next to nothing are to be known as that.
void noteExempt(const SceneModel& scene, const Pair& pair, const RestRegion& region,
                std::vector<std::string>& notes) {
    constexpr double most = 0.9;
    const std::pair<int, const std::vector<SurfacePart>*> sides[] = {{pair.bodyA, &region.a},
                                                                     {pair.bodyB, &region.b}};
    for (const auto& [index, parts] : sides) {
        const Body& body = scene.bodies[static_cast<std::size_t>(index)];
        const double share = parts->empty() ? 0 : area(body.mesh, *parts) / area(body.mesh);
        if (share > most)
            notes.push_back(
                fmt::format("{}: {:.0f} % of its surface is exempt, for it overlaps the other body "
                            "at rest or hangs together with what does: the bounds are about the rest "
                            "alone; a finer --tolerance or a rest pose with less overlap leaves more",
                            body.path, 100 * share));
    }
}

} // namespace

double clearanceAtRest(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion) {
    const std::vector<double> rest = restValues(motion);
    const double distance = MeshQuery(a).distanceTo(MeshQuery(b), pose(motion, rest));
    return distance > touchingDistance(a, b, motion) ? distance : 0;
}

SphereOptions sphereOptions(const BakeOptions& options, double tolerance) {
    SphereOptions how;
    how.method = options.spheres;
    how.tolerance = tolerance;
    how.maxSpheres = options.maxSpheres;
    how.conservative = options.conservative;
    how.growth = options.growth;
    return how;
}

// Medial spheres stand in the contact zone only, fine where the verdict needs it; the paper's fill the
// bodies.
PairSpheres fillPair(const SceneModel& scene, const Pair& pair, const Motion& motion,
                     const BakeOptions& options, const Progress& progress) {
    const Body &a = scene.bodies[pair.bodyA], &b = scene.bodies[pair.bodyB];
    const double tolerance = options.tolerance.value_or(defaultTolerance(a, b));
    PairSpheres spheres;
    if (options.spheres == SphereMethod::Medial) {
        ContactZoneOptions zone;
        zone.tolerance = tolerance;
        zone.depth = options.depth;
        zone.epsilon = options.epsilon;
        zone.atRest = options.atRest;
        zone.maxSpheres = options.maxSpheres;
        zone.conservative = options.conservative;
        zone.whole = manyDofs(motion, options);
        const TriangleMesh meshA = cleaned(meshOf(a)), meshB = cleaned(meshOf(b));
        ContactZoneFit fit = fitContactZone(meshA, meshB, motion, zone, progress);
        if (fit.a.fit.spheres.empty() || fit.b.fit.spheres.empty())
            spheres =
                spheresApart(a, b, motion, tolerance, {fit.a.fit.hollow, fit.b.fit.hollow}, fit, progress);
        else
            spheres = {
                std::move(fit.a.fit),
                std::move(fit.b.fit),
                std::move(fit.a.zone),
                std::move(fit.b.zone),
                {},
                {},
                fit.rest.clearance,
                {partsOf(a.mesh, meshA, fit.rest.region.a), partsOf(b.mesh, meshB, fit.rest.region.b)}};
    } else {
        Nesting nesting;
        if (options.spheres != SphereMethod::Surface) // those stand on the surface anyway
            nesting = findNested(Solid(cleaned(meshOf(a))), Solid(cleaned(meshOf(b))), motion, 2 * tolerance,
                                 progress);
        spheres.a = wholeBody(a, options, tolerance, nesting.outer.a, progress);
        spheres.b = wholeBody(b, options, tolerance, nesting.outer.b, progress);
        spheres.a.enclosed = nesting.apart(nesting.undecided.a);
        spheres.b.enclosed = nesting.apart(nesting.undecided.b);
        spheres.clearanceAtRest = clearanceAtRest(meshOf(a), meshOf(b), motion);
    }
    roundToFloat(spheres.a);
    roundToFloat(spheres.b);
    spheres.stickOut = spheres.a.protrusion + spheres.b.protrusion;
    checkRest(spheres, motion, options);
    return spheres;
}

PairTable tabulatePair(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options,
                       PairReport& report, const Progress& progress) {
    const SphereFit &fitA = spheres.a, &fitB = spheres.b;
    const RuleAtRest ruled = ruleAtRest(spheres, motion, options);
    const double margin = askedWithin(fitA, fitB, options);
    const CandidatePairs candidates =
        search(fitA.spheres, fitB.spheres, motion, options, margin, ruled.rule, progress);
    BakeRecord record;
    record.spheresA = fitA.spheres.size();
    record.spheresB = fitB.spheres.size();
    const bool listed = candidates.certified || options.search == SearchMethod::Sampled;
    record.candidatePairs = listed ? candidates.pairs.size() : 0;
    record.fitA = recorded(spheres.figuresA, fitA);
    record.fitB = recorded(spheres.figuresB, fitB);
    noteRest(spheres, ruled, motion, options, report.notes);
    Selection selection;
    if (candidates.certified && candidates.pairs.empty())
        selection.proof = NeverCollides{candidates.clearance, candidates.explored, {}, {}, {}};
    else if (asksAll(fitA.spheres, fitB.spheres, motion, options))
        selection = selectAll(fitA.spheres, fitB.spheres, candidates, motion, ruled.rule, report);
    else
        selection = select(fitA.spheres, fitB.spheres, candidates, motion, options, margin, ruled.rule,
                           report, progress);
    if (selection.proof) {
        // The meshes stay as far apart as the spheres do, less what these lack of the surfaces. Where that is
        // nothing, or the meshes meet at rest, it is a table without tests.
        double& clearance = selection.proof->clearance;
        clearance -= fitA.coverage + fitB.coverage;
        if (!(std::isfinite(clearance) && clearance > 0) || !ruled.rule.empty() || !ruled.region.empty()) {
            selection.proof.reset();
            selection.certified = true;
        }
    }
    const std::string method = methodName(options);
    if (selection.proof) {
        selection.proof->method = method;
        selection.proof->record = record;
        return {nullptr, std::make_shared<NeverCollides>(*selection.proof)};
    }
    auto table = std::make_shared<Table>(makeTable(fitA.spheres, fitB.spheres, selection.reduced.pairs,
                                                   selection.reduced.restGaps, motion, nullptr, nullptr,
                                                   options.keepSpheres ? Keep::All : Keep::Used));
    table->method = method;
    table->epsilon = selection.epsilon;
    table->gapDepth = options.reduce == ReduceMethod::Cover ? options.depth : 0;
    table->certified = selection.certified;
    table->record = record;
    table->record.lowerBound = static_cast<std::uint64_t>(std::ceil(selection.reduced.lowerBound));
    table->restRegion = ruled.region;
    setBounds(*table, fitA, fitB, margin, ruled);
    report.epsilon = table->epsilon;
    return {table, nullptr};
}

void bakePair(SceneModel& scene, Pair& pair, const BakeOptions& options, PairReport& report,
              const Progress& progress) {
    const Motion motion = pairMotion(scene, pair);
    checkMotion(motion);
    PairSpheres spheres = fillPair(scene, pair, motion, options, progress);
    if (!tss::report(progress, "spheres", 1)) throw InputError("stopped before the table was made");
    spheres.figuresA = measured(scene.bodies[pair.bodyA], spheres.a, spheres.zoneA);
    spheres.figuresB = measured(scene.bodies[pair.bodyB], spheres.b, spheres.zoneB);
    const std::pair<int, const SphereFit*> fits[] = {{pair.bodyA, &spheres.a}, {pair.bodyB, &spheres.b}};
    for (const auto& [body, fit] : fits) {
        const std::string& path = scene.bodies[static_cast<std::size_t>(body)].path;
        if (!fit->note.empty()) report.notes.push_back(path + ": " + fit->note);
        if (!std::isfinite(fit->enclosed))
            report.notes.push_back(
                path + ": whether the other body ever stands inside without touching could not be "
                       "decided for all poses: how early contact may be reported is not known");
    }
    PairTable made = tabulatePair(spheres, motion, options, report, progress);
    pair.table = std::move(made.table);
    pair.proof = std::move(made.proof);
    if (pair.table) noteExempt(scene, pair, pair.table->restRegion, report.notes);
    pair.sourceHash = sourceHash(scene, pair);
}

} // namespace tss
