#include "bake/pipeline/FillPair.h"

#include "bake/base/Error.h"
#include "bake/fill/ContactZoneFit.h"
#include "bake/fill/HollowBodies.h"
#include "bake/fill/NestedBodies.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/PartSet.h"
#include "bake/geometry/Solid.h"
#include "bake/pipeline/RestRule.h"
#include "bake/reduce/CertifiedCover.h"
#include "bake/search/CertifiedSearch.h"
#include "bake/spheres/FitMetrics.h"
#include "bake/spheres/RoundToFloat.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace tss {

namespace {

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

/// Which bodies are hollow: those known, and those found by spheres that touch where the surfaces are far
/// apart (findHollow()).
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

double smallerSize(const Body& a, const Body& b) {
    return std::min(diagonal(a.mesh), diagonal(b.mesh));
}

double toleranceOf(const Body& a, const Body& b, const BakeOptions& options) {
    return options.tolerance.value_or(smallerSize(a, b) / 500);
}

/// Spheres of two bodies whose surfaces are known never to come near each other: the coarsest of which a
/// search shows the same, so that the proof can be repeated with them.
PairSpheres coarsestApart(const Body& a, const Body& b, const Motion& motion, double tolerance,
                          HollowBodies hollow, const ContactZoneFit& fit, const BakeOptions& options,
                          const Progress& progress) {
    SphereOptions how;
    const double smaller = smallerSize(a, b);
    for (how.tolerance = std::max(tolerance, smaller / 30);;) {
        SphereOptions howA = how, howB = how;
        howA.hollow = hollow.a;
        howB.hollow = hollow.b;
        howA.medial.neighbour = fit.a.neighbour;
        howB.medial.neighbour = fit.b.neighbour;
        PairSpheres spheres{fitSpheres(cleaned(meshOf(a)), howA, progress),
                            fitSpheres(cleaned(meshOf(b)), howB, progress)};
        spheres.clearanceAtRest = fit.rest.clearance;
        if (neverCollide(spheres.a.spheres, spheres.b.spheres, motion, {}, 0, progress)) return spheres;
        if (options.inside == Inside::Free) {
            const HollowBodies now = hollowBodies(a, b, spheres, hollow, motion, how.tolerance, progress);
            const bool moreHollow = now.a != hollow.a || now.b != hollow.b;
            hollow = now;
            if (moreHollow) continue;
        }
        if (how.tolerance <= tolerance) return spheres;
        how.tolerance = std::max(tolerance, how.tolerance / 2);
    }
}

/// What is known of one body inside the other, where spheres of this tolerance fill them.
Nesting nestingOf(const Body& a, const Body& b, const Motion& motion, const BakeOptions& options,
                  double tolerance, const Progress& progress, const NestingEffort& effort = {}) {
    const Solid solidA(cleaned(meshOf(a))), solidB(cleaned(meshOf(b)));
    if (options.inside == Inside::Contact) return insideIsContact(solidA, solidB);
    return findNested(solidA, solidB, motion, 2 * tolerance, progress, effort);
}

/// Medial spheres of the contact zone. known: if given, the result of findNested(), and all of both surfaces
/// is filled. margin: surface outside the zone stays farther from the other body than this, scene units.
PairSpheres fillZone(const Body& a, const Body& b, const Motion& motion, const BakeOptions& options,
                     double tolerance, const Nesting* known, double margin, const Progress& progress) {
    ContactZoneOptions zone;
    zone.tolerance = tolerance;
    zone.depth = options.depth;
    zone.epsilon = options.epsilon;
    zone.atRest = options.atRest;
    zone.maxSpheres = options.maxSpheres;
    zone.conservative = options.conservative;
    zone.medial.mostPatches = options.mostPatches;
    zone.effort = options.effort;
    zone.margin = margin;
    zone.whole = known != nullptr;
    zone.solid = options.inside == Inside::Contact;
    if (known)
        zone.nesting = *known;
    else if (zone.solid)
        zone.nesting = nestingOf(a, b, motion, options, tolerance, progress);
    zone.kept = options.kept;
    zone.pathA = a.path;
    zone.pathB = b.path;
    const TriangleMesh meshA = cleaned(meshOf(a)), meshB = cleaned(meshOf(b));
    ContactZoneFit fit = fitContactZone(meshA, meshB, motion, zone, progress);
    if (fit.a.fit.spheres.empty() || fit.b.fit.spheres.empty())
        return coarsestApart(a, b, motion, tolerance, {fit.a.fit.hollow, fit.b.fit.hollow}, fit, options,
                             progress);
    return {std::move(fit.a.fit),
            std::move(fit.b.fit),
            std::move(fit.a.zone),
            std::move(fit.b.zone),
            known ? std::numeric_limits<double>::infinity() : margin, // no surface is outside of all
            {},
            {},
            fit.rest.clearance,
            {partsOf(a.mesh, meshA, fit.rest.region.a), partsOf(b.mesh, meshB, fit.rest.region.b)}};
}

/// Spheres of the other methods, which fill all of the bodies.
PairSpheres fillWhole(const Body& a, const Body& b, const Motion& motion, const BakeOptions& options,
                      double tolerance, const Nesting* known, const Progress& progress) {
    PairSpheres spheres;
    Nesting nesting;
    if (options.spheres != SphereMethod::Surface) // these do not fill what is inside
        nesting = known ? *known : nestingOf(a, b, motion, options, tolerance, progress);
    spheres.a = wholeBody(a, options, tolerance, nesting.outer.a, progress);
    spheres.b = wholeBody(b, options, tolerance, nesting.outer.b, progress);
    spheres.a.enclosed = nesting.apart();
    spheres.b.enclosed = nesting.apart();
    spheres.clearanceAtRest = clearanceAtRest(meshOf(a), meshOf(b), motion);
    return spheres;
}

bool asksForCover(const BakeOptions& options) {
    return options.reduce == ReduceMethod::Cover && options.search == SearchMethod::Certified;
}

/// Rounds the spheres as the file stores them, and adds to the protrusion by how much they grow.
void roundToFloat(SphereFit& fit) {
    double grown = 0;
    for (Sphere& sphere : fit.spheres) {
        const Sphere rounded = tss::roundToFloat(sphere);
        grown = std::max(grown, (rounded.centre - sphere.centre).norm() + rounded.radius - sphere.radius);
        sphere = rounded;
    }
    fit.protrusion += grown;
}

/// The figures of a fit; its bounds become those measured where these are better.
FitRecord measured(const Body& body, SphereFit& fit, const std::optional<std::vector<Patch>>& zone) {
    const Solid solid(cleaned(meshOf(body)), fit.hollow ? Interior::Hollow : Interior::Filled);
    FitMetrics metrics = measureFit(solid, fit.spheres, zone ? *zone : patchesOf(solid.mesh()));
    if (!fit.hollow) metrics.volumeRatio = measureVolumeRatio(solid, fit.spheres);
    fit.coverage = std::min(fit.coverage, metrics.coverage);
    fit.protrusion = std::min(fit.protrusion, metrics.protrusion);
    FitRecord figures;
    figures.coverageMean = boundOrUnknown(metrics.coverageMean);
    figures.coverageP95 = boundOrUnknown(metrics.coverageP95);
    figures.protrusionMean = boundOrUnknown(metrics.protrusionMean);
    figures.protrusionP95 = boundOrUnknown(metrics.protrusionP95);
    if (!fit.hollow) figures.volumeRatio = boundOrUnknown(metrics.volumeRatio);
    return figures;
}

/// The spheres as a file holds them, checked to be apart at rest as required.
PairSpheres stored(PairSpheres spheres, const Motion& motion, const BakeOptions& options) {
    roundToFloat(spheres.a);
    roundToFloat(spheres.b);
    spheres.protrusions = spheres.a.protrusion + spheres.b.protrusion;
    checkRest(spheres, motion, options);
    return spheres;
}

/// known: if given, the result of findNested(), and all of both surfaces is filled.
PairSpheres fill(const Body& a, const Body& b, const Motion& motion, const BakeOptions& options,
                 double tolerance, const Nesting* known, const Progress& progress) {
    return stored(options.spheres == SphereMethod::Medial
                      ? fillZone(a, b, motion, options, tolerance, known, 0, progress)
                      : fillWhole(a, b, motion, options, tolerance, known, progress),
                  motion, options);
}

/// A tolerance, scene units, and the spheres of both bodies to it.
struct Level {
    double tolerance;
    PairSpheres spheres;

    double pairs() const {
        return std::max<double>(1, spheres.a.spheres.size()) * std::max<double>(1, spheres.b.spheres.size());
    }
};

/// The finest spheres, no finer than the tolerance `least`, of which all pairs can be tested, to a step,
/// found from the tolerance `first` on. Where there are none, the coarsest tried: coarser ones are hardly
/// fewer where most stand for what overlaps or is near at rest.
Level finestToTestAll(const Body& a, const Body& b, const Motion& motion, const BakeOptions& options,
                      double least, double first, const Nesting& known, const Progress& progress) {
    constexpr int mostFills = 8;
    constexpr double enough = 0.35, aim = 0.6; // shares of the pairs that can be tested
    const double coarsest = std::sqrt(diagonal(a.mesh) * diagonal(b.mesh)) / 4; // tolerance of any use
    const auto filled = [&](double tolerance) {
        return Level{tolerance, fill(a, b, motion, options, tolerance, &known, progress)};
    };
    Level last = filled(std::max(toleranceNextTo(first), least));
    std::optional<Level> good;
    double tooFine = 0; // the coarsest tolerance seen that takes too many pairs
    double power = 3;   // the number of pairs falls with about this power of the tolerance
    for (int fills = 1;; ++fills) {
        const double tolerance = last.tolerance, pairs = last.pairs();
        const double share = pairs / static_cast<double>(options.mostTests);
        if (canTestAll(last.spheres, options))
            good = std::move(last);
        else
            tooFine = tolerance;
        const bool close =
            good && (good->tolerance <= least || good->tolerance < 1.1 * toleranceStep * tooFine);
        if (fills == mostFills || close || (share > enough && share <= 1)) break;
        double next = tolerance * std::pow(share / aim, 1 / power);
        if (!good) next = std::max(next, toleranceStep * tooFine);
        if (good && next <= tooFine) next = std::sqrt(good->tolerance * tooFine);
        if (tolerance >= coarsest && next > tolerance) break;
        if (tolerance < coarsest) next = std::min(next, coarsest);
        next = std::max(toleranceNextTo(next), least);
        if (next == tolerance || (good && next == good->tolerance)) break;
        last = filled(next);
        const double fewer = std::log(pairs / last.pairs()) / std::log(last.tolerance / tolerance);
        if (!good && last.tolerance > tolerance && fewer < 1 && !canTestAll(last.spheres, options)) break;
        power = std::clamp(fewer, 2.0, 4.0);
    }
    return good ? std::move(*good) : std::move(last);
}

/// About the tolerance from which on all pairs can be tested where these bodies are hollow, from the number
/// of spheres that hollow bodies take (METHOD 1.7).
double toTestAllOfHollow(const Body& a, const Body& b, const BakeOptions& options, const Level& solid,
                         const HollowBodies& hollow) {
    const auto count = [&](const Body& body, const SphereFit& fit, bool isHollow) {
        const double own = double(fit.spheres.size());
        return isHollow ? std::max(own, area(body.mesh) / (3 * solid.tolerance * solid.tolerance)) : own;
    };
    const double share = count(a, solid.spheres.a, hollow.a) * count(b, solid.spheres.b, hollow.b) /
                         static_cast<double>(options.mostTests);
    const double power = hollow.a && hollow.b ? 4 : 3; // the number of pairs falls with it
    return solid.tolerance * std::max(1.0, std::pow(share, 1 / power));
}

} // namespace

double clearanceAtRest(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion) {
    const std::vector<double> rest = restValues(motion);
    const double distance = MeshQuery(a).distanceTo(MeshQuery(b), pose(motion, rest));
    return distance > touchingDistance(a, b, motion) ? distance : 0;
}

double toleranceNextTo(double tolerance) {
    return std::exp2(std::round(2 * std::log2(tolerance)) / 2);
}

SphereOptions sphereOptions(const BakeOptions& options, double tolerance) {
    SphereOptions how;
    how.method = options.spheres;
    how.tolerance = tolerance;
    how.maxSpheres = options.maxSpheres;
    how.conservative = options.conservative;
    how.growth = options.growth;
    how.medial.mostPatches = options.mostPatches;
    return how;
}

std::optional<double> boundOrUnknown(double bound) {
    return std::isfinite(bound) ? std::optional(bound) : std::nullopt;
}

bool canTestAll(const PairSpheres& spheres, const BakeOptions& options) {
    return asksForCover(options) && spheres.a.spheres.size() * spheres.b.spheres.size() <= options.mostTests;
}

bool mayCoarsenToTestAll(const BakeOptions& options) {
    return asksForCover(options) && options.depth <= 0 && options.conservative;
}

bool manyDofs(const Motion& motion, const BakeOptions& options) {
    return motion.dofCount() > (options.budget == 0 ? mostCoverDofs : 3);
}

PairSpheres fillPair(const SceneModel& scene, const Pair& pair, const Motion& motion,
                     const BakeOptions& options, const Progress& progress) {
    if (manyDofs(motion, options)) return fillToTestAll(scene, pair, motion, options, progress);
    const Body &a = scene.bodies[pair.bodyA], &b = scene.bodies[pair.bodyB];
    const double first = toleranceOf(a, b, options);
    for (double tolerance = first;; tolerance *= 2) {
        try {
            PairSpheres spheres = fill(a, b, motion, options, tolerance, nullptr, progress);
            for (SphereFit* fit : {&spheres.a, &spheres.b})
                if (tolerance > first)
                    addNote(*fit,
                            fmt::format("tolerance {:.4g} instead of {:.4g} scene units, which takes too "
                                        "many spheres where the meshes overlap at rest",
                                        tolerance, first));
            return spheres;
        } catch (const RestTooClose&) { // whatever the tolerance
            throw;
        } catch (const TooFine&) {
            if (options.tolerance || options.depth > 0 || 2 * tolerance > smallerSize(a, b) / 30) throw;
        }
    }
}

PairSpheres fillWithin(const SceneModel& scene, const Pair& pair, const Motion& motion,
                       const BakeOptions& options, double margin, const Progress& progress) {
    const Body &a = scene.bodies[pair.bodyA], &b = scene.bodies[pair.bodyB];
    return stored(fillZone(a, b, motion, options, toleranceOf(a, b, options), nullptr, margin, progress),
                  motion, options);
}

std::vector<double> coarserTolerances(const SceneModel& scene, const Pair& pair, const BakeOptions& options,
                                      double nearest) {
    constexpr double coarsest = 8, finest = 120; // shares of the smaller body
    const Body &a = scene.bodies[pair.bodyA], &b = scene.bodies[pair.bodyB];
    const double size = smallerSize(a, b), least = std::max(toleranceOf(a, b, options), size / finest);
    std::vector<double> coarser;
    for (double share = 1; share > 0.1 && (coarser.empty() || coarser.back() > least); share /= 2)
        coarser.push_back(std::max(toleranceNextTo(share * std::min(nearest / 4, size / coarsest)), least));
    return coarser;
}

PairSpheres fillSolid(const SceneModel& scene, const Pair& pair, const Motion& motion,
                      const BakeOptions& options, double tolerance, const Progress& progress) {
    const Nesting none;
    PairSpheres spheres =
        fill(scene.bodies[pair.bodyA], scene.bodies[pair.bodyB], motion, options, tolerance, &none, progress);
    spheres.testAll = true;
    return spheres;
}

PairSpheres fillToTestAll(const SceneModel& scene, const Pair& pair, const Motion& motion,
                          const BakeOptions& options, const Progress& progress) {
    const Body &a = scene.bodies[pair.bodyA], &b = scene.bodies[pair.bodyB];
    const double asked = toleranceOf(a, b, options);
    if (!asksForCover(options)) {
        const Nesting nesting = nestingOf(a, b, motion, options, asked, progress);
        return fill(a, b, motion, options, asked, &nesting, progress);
    }
    const double first = std::max(asked, std::sqrt(diagonal(a.mesh) * diagonal(b.mesh)) / 20);
    Level finest = finestToTestAll(a, b, motion, options, asked, first, {}, progress);
    // Holds for coarser ones too. Where that could not be decided, the body is taken for hollow: spheres on
    // its surface serve either case, so that walks would decide nothing.
    Nesting nesting =
        nestingOf(a, b, motion, options, finest.tolerance, progress, {.probes = 10'000'000, .walks = false});
    if (options.inside == Inside::Free) {
        nesting.outer = {nesting.outer.a || nesting.undecided.a, nesting.outer.b || nesting.undecided.b};
        nesting.undecided = {};
    }
    if (nesting.outer) // hollow bodies take more spheres
        finest = finestToTestAll(a, b, motion, options, finest.tolerance,
                                 toTestAllOfHollow(a, b, options, finest, nesting.outer), nesting, progress);
    PairSpheres spheres = std::move(finest.spheres);
    for (SphereFit* fit : {&spheres.a, &spheres.b}) {
        fit->enclosed = nesting.apart();
        if (finest.tolerance > asked)
            addNote(*fit, fmt::format("tolerance {:.4g} instead of {:.4g} scene units, so that all pairs of "
                                      "spheres can be asked",
                                      finest.tolerance, asked));
    }
    spheres.testAll = canTestAll(spheres, options);
    return spheres;
}

void measureSpheres(const SceneModel& scene, const Pair& pair, PairSpheres& spheres) {
    spheres.figuresA = measured(scene.bodies[pair.bodyA], spheres.a, spheres.zoneA);
    spheres.figuresB = measured(scene.bodies[pair.bodyB], spheres.b, spheres.zoneB);
}

} // namespace tss
