#pragma once
#include "bake/geometry/Solid.h"
#include "bake/spheres/Patches.h"
#include "bake/spheres/SphereSet.h"

#include <span>

namespace tss {

/// How well spheres stand for a body (METHOD 1.5). Lengths in scene units, >= 0.
struct FitMetrics {
    double coverage = 0;     ///< delta: no point of the surface is farther outside the union (a proven bound)
    double coverageMean = 0; ///< over the surface, sampled
    double coverageP95 = 0;
    double protrusion = 0;     ///< pi: no point of a sphere is farther from the body (a proven bound)
    double protrusionMean = 0; ///< of the bounds of the spheres
    double protrusionP95 = 0;
    double volumeRatio = 0; ///< volume of the union of the spheres over that of the body with its openings
                            ///< closed, sampled: right to about 1 %; 0 for a body without volume
};

/// The fit of spheres to all of a body. No sphere at all: the coverage is infinite.
FitMetrics measureFit(const Solid& solid, std::span<const Sphere> spheres);

/// The same with the coverage of these patches only (a contact zone), and without the volume ratio.
FitMetrics measureFit(const Solid& solid, std::span<const Sphere> spheres, std::span<const Patch> zone);

/// FitMetrics::volumeRatio.
double measureVolumeRatio(const Solid& solid, std::span<const Sphere> spheres);

/// delta of the patches, within 2 % of the truth where that is not below 1e-6 of their size. On a patch the
/// distance to one sphere is convex, so its largest value is at a corner; patches are halved where the bound
/// is worst. 0: the union contains all of them.
double coverageBound(std::span<const Sphere> spheres, std::span<const Patch> patches);

} // namespace tss
