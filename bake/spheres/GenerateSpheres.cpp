#include "bake/spheres/GenerateSpheres.h"

#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/spheres/Patches.h"
#include "bake/spheres/SphereMethods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace tss {

void addNote(SphereFit& fit, const std::string& note) {
    if (!note.empty()) fit.note += (fit.note.empty() ? "" : "; ") + note;
}

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

SphereFit medialFit(const Solid& solid, const SphereOptions& options, double tolerance,
                    const Progress& progress) {
    const double protrusion = protrusionFor(tolerance, magnitude(solid.mesh()));
    const auto make = options.method == SphereMethod::Medial ? medialSpheres : shrinkingSpheres;
    SphereFit fit;
    const MedialSet set = make(solid, patchesOf(solid.mesh()), protrusion, options.medial, progress);
    fit.spheres = options.conservative ? set.spheres : inscribed(set);
    fit.protrusion = options.conservative ? protrusion : 0;
    fit.coverage = options.conservative ? 0 : protrusion;
    return fit;
}

SphereFit surfaceFit(const Solid& solid, const SphereOptions& options, double tolerance) {
    SphereFit fit;
    fit.spheres = surfaceSpheres(solid.mesh(), options.conservative);
    for (const Sphere& s : fit.spheres) fit.protrusion = std::max(fit.protrusion, s.radius);
    fit.coverage = options.conservative ? 0 : unbounded;
    if (options.tolerance > 0 && fit.protrusion > tolerance)
        fit.note = fmt::format("tolerance {} not reached: surface spheres stand on the vertices and have "
                               "radii up to {} scene units",
                               tolerance, fit.protrusion);
    return fit;
}

SphereFit growthFit(const Solid& solid, const SphereOptions& options, const Progress& progress) {
    SphereFit fit;
    for (const GrownSphere& grown : growSpheres(solid.mesh(), options.growth, progress))
        fit.spheres.push_back(grown.sphere);
    for (const Sphere& s : fit.spheres)
        fit.protrusion = std::max(fit.protrusion, solid.protrusion(s.centre, s.radius));
    fit.coverage = unbounded;
    if (fit.spheres.empty())
        fit.note = "growth made no sphere: with these lengths no ball met a second triangle centroid";
    return fit;
}

SphereFit fitOnce(const Solid& solid, const SphereOptions& options, double tolerance,
                  const Progress& progress) {
    switch (options.method) {
    case SphereMethod::Surface:
        return surfaceFit(solid, options, tolerance);
    case SphereMethod::Growth:
        return growthFit(solid, options, progress);
    default:
        return medialFit(solid, options, tolerance, progress);
    }
}

double asked(const Solid& solid, const SphereOptions& options) {
    return options.tolerance > 0 ? options.tolerance : solid.diagonal() / 400;
}

/// Searches the finest tolerance that needs at most `limit` spheres. count(tolerance): how many it takes,
/// about falling in the tolerance. Looks at most a dozen times, coarse ones first, and never finer than
/// `finest`; ends with a count within 3 % of the limit or a tolerance within 2 % of one that takes too many.
/// coarsest: a tolerance that one sphere reaches. Returns the finest tolerance that was seen to do.
double toleranceFor(std::size_t limit, double finest, double coarsest,
                    const std::function<std::size_t(double)>& count, const Progress& progress) {
    constexpr int looks = 12;
    const double n = static_cast<double>(limit);
    double good = coarsest, goodCount = 1; // takes few enough
    double bad = 0, badCount = 0;          // takes too many; 0: none seen
    double next = std::max(finest, coarsest / 64);
    for (int look = 0; look < looks; ++look) {
        const double taken = static_cast<double>(count(next));
        if (taken <= n) {
            good = next;
            goodCount = taken;
        } else {
            bad = next;
            badCount = taken;
        }
        if (!report(progress, "max-spheres", (look + 1.0) / looks)) break;
        if (good <= finest || (taken <= n && taken >= 0.97 * n) || (bad > 0 && good < 1.02 * bad)) break;
        // The count goes about as a power of the tolerance; aimed a little low.
        if (bad > 0) {
            const double slope = std::log(badCount / goodCount) / std::log(good / bad);
            const double guess = good * std::pow(goodCount / (0.985 * n), 1 / std::max(slope, 0.1));
            const double width = good / bad;
            next = std::clamp(guess, bad * std::pow(width, 0.1), good * std::pow(width, -0.1));
        } else {
            next = good * std::clamp(std::pow(goodCount / (0.985 * n), 1 / 1.3), 0.2, 0.9);
        }
        next = std::max(next, finest);
    }
    return good;
}

SphereFit limitedFit(const Solid& solid, const SphereOptions& options, const Progress& progress) {
    const auto limit = static_cast<std::size_t>(options.maxSpheres);
    // Without a tolerance asked for, finer than this is not worth the time.
    const double finest = options.tolerance > 0 ? options.tolerance : solid.diagonal() * 1e-5;
    SphereFit best;
    double bestTolerance = std::numeric_limits<double>::infinity();
    SphereOptions trial = options;
    trial.medial = forTrial(options.medial, limit);
    const auto count = [&](double tolerance) {
        SphereFit fit;
        try {
            fit = fitOnce(solid, trial, tolerance, {});
        } catch (const TooFine&) {
            return std::numeric_limits<std::size_t>::max();
        }
        const std::size_t n = fit.spheres.size();
        if (n <= limit && tolerance < bestTolerance) {
            best = std::move(fit);
            bestTolerance = tolerance;
        }
        return n;
    };
    const double reached = toleranceFor(limit, finest, 2 * solid.diagonal(), count, progress);
    if (best.spheres.empty()) best = fitOnce(solid, options, reached, progress);
    if (options.tolerance > 0 && reached > options.tolerance)
        addNote(best, fmt::format("tolerance {} not reached: {} spheres allow {:.4g} scene units",
                                  options.tolerance, limit, reached));
    return best;
}

} // namespace

void checkOptions(const SphereOptions& o) {
    const auto need = [](bool good, const char* what) {
        if (!good) throw InputError(fmt::format("sphere options: {}", what));
    };
    need(std::isfinite(o.tolerance) && o.tolerance >= 0, "the tolerance must be a number >= 0");
    need(o.maxSpheres >= 0, "the largest number of spheres must be >= 0");
    need(o.growth.start > 0 && o.growth.step > 0 && o.growth.end >= o.growth.start &&
             o.growth.maxRadius > 0 && std::isfinite(o.growth.end / o.growth.step),
         "growth needs start, step, maximum radius > 0 and end >= start");
}

double magnitude(const TriangleMesh& mesh) {
    double m = 0;
    for (const Vec3& v : mesh.vertices) m = std::max(m, v.cwiseAbs().maxCoeff());
    return m;
}

double protrusionFor(double tolerance, double magnitude) {
    // Rounding moves a centre by at most sqrt(3) half units in the last place; the radius grows by as much
    // and by half a unit of its own. Where floats are coarser than the tolerance they cannot carry it: not
    // reserved for.
    const double rounding = 8 * std::ldexp(magnitude, -24);
    return tolerance * (1 - 1e-4) - std::min(rounding, 0.1 * tolerance);
}

SphereFit fitSpheres(const TriangleMesh& mesh, const SphereOptions& options, const Progress& progress) {
    checkOptions(options);
    const Solid solid(cleaned(mesh), options.hollow ? Interior::Hollow : Interior::Filled);
    const bool tunable = options.method == SphereMethod::Medial || options.method == SphereMethod::Shrinking;
    SphereFit fit = tunable && options.maxSpheres > 0
                        ? limitedFit(solid, options, progress)
                        : fitOnce(solid, options, asked(solid, options), progress);
    if (options.maxSpheres > 0 && fit.spheres.size() > static_cast<std::size_t>(options.maxSpheres))
        addNote(fit, fmt::format("{} spheres instead of {}: this method has no tolerance to widen",
                                 fit.spheres.size(), options.maxSpheres));
    fit.hollow = solid.hollow();
    addNote(fit, solid.assumptions());
    return fit;
}

} // namespace tss
