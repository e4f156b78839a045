#include "bake/pipeline/FillPair.h"

#include "bake/base/Error.h"
#include "bake/fill/ContactZoneFit.h"
#include "bake/fill/HollowBodies.h"
#include "bake/fill/NestedBodies.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/PartSet.h"
#include "bake/geometry/Solid.h"
#include "bake/pipeline/RestRule.h"
#include "bake/search/CertifiedSearch.h"
#include "bake/spheres/FitMetrics.h"
#include "bake/spheres/RoundToFloat.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

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

double smallerSize(const Body& a, const Body& b) {
    return std::min(diagonal(a.mesh), diagonal(b.mesh));
}

double toleranceOf(const Body& a, const Body& b, const BakeOptions& options) {
    return options.tolerance.value_or(smallerSize(a, b) / 500);
}

/// Spheres of two bodies whose surfaces are known never to come near each other, as coarse as shows it: what
/// can be proven again from the file alone.
PairSpheres spheresApart(const Body& a, const Body& b, const Motion& motion, double tolerance,
                         HollowBodies hollow, const ContactZoneFit& fit, const Progress& progress) {
    SphereOptions how;
    CertifiedSearchOptions apart;
    apart.measureClearance = false;
    apart.effort = 5'000'000;
    const double smaller = smallerSize(a, b);
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

/// Medial spheres stand in the contact zone only, fine where the verdict needs it; where `nesting` is given,
/// all over the surfaces.
PairSpheres fillZone(const Body& a, const Body& b, const Motion& motion, const BakeOptions& options,
                     double tolerance, std::optional<Nesting>* nesting, const Progress& progress) {
    ContactZoneOptions zone;
    zone.tolerance = tolerance;
    zone.depth = options.depth;
    zone.epsilon = options.epsilon;
    zone.atRest = options.atRest;
    zone.maxSpheres = options.maxSpheres;
    zone.conservative = options.conservative;
    zone.whole = nesting != nullptr;
    if (nesting) zone.nesting = *nesting;
    const TriangleMesh meshA = cleaned(meshOf(a)), meshB = cleaned(meshOf(b));
    ContactZoneFit fit = fitContactZone(meshA, meshB, motion, zone, progress);
    if (nesting) *nesting = fit.nesting;
    if (fit.a.fit.spheres.empty() || fit.b.fit.spheres.empty())
        return spheresApart(a, b, motion, tolerance, {fit.a.fit.hollow, fit.b.fit.hollow}, fit, progress);
    return {std::move(fit.a.fit),
            std::move(fit.b.fit),
            std::move(fit.a.zone),
            std::move(fit.b.zone),
            {},
            {},
            fit.rest.clearance,
            {partsOf(a.mesh, meshA, fit.rest.region.a), partsOf(b.mesh, meshB, fit.rest.region.b)}};
}

/// The paper's spheres fill the bodies.
PairSpheres fillWhole(const Body& a, const Body& b, const Motion& motion, const BakeOptions& options,
                      double tolerance, const Progress& progress) {
    PairSpheres spheres;
    Nesting nesting;
    if (options.spheres != SphereMethod::Surface) // those stand on the surface anyway
        nesting =
            findNested(Solid(cleaned(meshOf(a))), Solid(cleaned(meshOf(b))), motion, 2 * tolerance, progress);
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

/// The figures of a fit; its bounds become those measured where these are better.
FitRecord measured(const Body& body, SphereFit& fit, const std::optional<std::vector<Patch>>& zone) {
    const Solid solid(cleaned(meshOf(body)), fit.hollow ? Interior::Hollow : Interior::Filled);
    FitMetrics metrics = measureFit(solid, fit.spheres, zone ? *zone : patchesOf(solid.mesh()));
    if (!fit.hollow) measureVolumes(metrics, solid, fit.spheres);
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

PairSpheres fill(const SceneModel& scene, const Pair& pair, const Motion& motion, const BakeOptions& options,
                 std::optional<Nesting>* nesting, const Progress& progress) {
    const Body &a = scene.bodies[pair.bodyA], &b = scene.bodies[pair.bodyB];
    const double tolerance = toleranceOf(a, b, options);
    PairSpheres spheres = options.spheres == SphereMethod::Medial
                              ? fillZone(a, b, motion, options, tolerance, nesting, progress)
                              : fillWhole(a, b, motion, options, tolerance, progress);
    roundToFloat(spheres.a);
    roundToFloat(spheres.b);
    spheres.stickOut = spheres.a.protrusion + spheres.b.protrusion;
    checkRest(spheres, motion, options);
    return spheres;
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

std::optional<double> boundOrUnknown(double bound) {
    return std::isfinite(bound) ? std::optional(bound) : std::nullopt;
}

bool canAskAll(const PairSpheres& spheres, const BakeOptions& options) {
    return asksForCover(options) && spheres.a.spheres.size() * spheres.b.spheres.size() <= options.mostPairs;
}

bool canAskAllInstead(const BakeOptions& options) {
    return asksForCover(options) && options.depth <= 0 && options.conservative;
}

bool manyDofs(const Motion& motion, const BakeOptions& options) {
    return motion.dofCount() > (options.budget == 0 ? mostCoverDofs : 3);
}

PairSpheres fillPair(const SceneModel& scene, const Pair& pair, const Motion& motion,
                     const BakeOptions& options, const Progress& progress) {
    if (manyDofs(motion, options)) return fillToAskAll(scene, pair, motion, options, progress);
    return fill(scene, pair, motion, options, nullptr, progress);
}

std::vector<double> coarserTolerances(const SceneModel& scene, const Pair& pair, const BakeOptions& options) {
    const Body &a = scene.bodies[pair.bodyA], &b = scene.bodies[pair.bodyB];
    const double size = smallerSize(a, b);
    std::vector<double> coarser;
    for (const double share : {30, 60, 120})
        if (size / share > toleranceOf(a, b, options)) coarser.push_back(size / share);
    return coarser;
}

PairSpheres fillToAskAll(const SceneModel& scene, const Pair& pair, const Motion& motion,
                         const BakeOptions& options, const Progress& progress) {
    std::optional<Nesting> nesting; // of the finest holds for all
    PairSpheres spheres = fill(scene, pair, motion, options, &nesting, progress);
    const double asked = toleranceOf(scene.bodies[pair.bodyA], scene.bodies[pair.bodyB], options);
    BakeOptions coarser = options;
    coarser.tolerance = asked;
    // Spheres become fewer with the first to the second power of the tolerance, of either body.
    for (int tries = 0; asksForCover(options) && !canAskAll(spheres, options) && tries < 8; ++tries) {
        const double pairs = double(spheres.a.spheres.size()) * double(spheres.b.spheres.size());
        *coarser.tolerance *= std::max(1.05, std::cbrt(pairs / double(options.mostPairs)));
        spheres = fill(scene, pair, motion, coarser, &nesting, progress);
    }
    if (*coarser.tolerance > asked)
        for (SphereFit* fit : {&spheres.a, &spheres.b})
            addNote(*fit, fmt::format("tolerance {:.4g} instead of {:.4g} scene units, so that all pairs of "
                                      "spheres can be asked",
                                      *coarser.tolerance, asked));
    spheres.askAll = canAskAll(spheres, options);
    return spheres;
}

void measureSpheres(const SceneModel& scene, const Pair& pair, PairSpheres& spheres) {
    spheres.figuresA = measured(scene.bodies[pair.bodyA], spheres.a, spheres.zoneA);
    spheres.figuresB = measured(scene.bodies[pair.bodyB], spheres.b, spheres.zoneB);
}

} // namespace tss
