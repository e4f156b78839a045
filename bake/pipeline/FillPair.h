#pragma once
#include "bake/base/Progress.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/spheres/GenerateSpheres.h"
#include "bake/spheres/Patches.h"

#include <optional>

namespace tss {

/// The spheres of both bodies as a file can hold them, with what is proven of them.
struct PairSpheres {
    SphereFit a, b;
    /// The surface that they stand for, where that is not all of it: the contact zone.
    std::optional<std::vector<Patch>> zoneA{}, zoneB{};
    double zoneMargin = 0;            ///< surface out of the zone stays farther from the other body than this
    FitRecord figuresA{}, figuresB{}; ///< as far as they were measured
    double clearanceAtRest = 0;       ///< of the surfaces; 0: they touch or overlap
    RestRegion region{};              ///< of the meshes as loaded, where spheres are fitted to surfaces
    double stickOut = 0;              ///< of the spheres of both together, by which they tell no depths apart
    bool askAll = false; ///< so few that a table can ask all their pairs that are not known to stay apart
};

/// Whether a table of so many spheres may ask all their pairs: they answer for themselves, where no cover of
/// them is asked for by another method.
bool canAskAll(const PairSpheres& spheres, const BakeOptions& options);

/// Whether spheres may be made so coarse that canAskAll(): a table that states a gap is verified against the
/// very spheres that its settings make.
bool canAskAllInstead(const BakeOptions& options);

/// How far apart the surfaces are where the joint rests; 0: they touch or overlap.
double clearanceAtRest(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion);

/// Of the whole of a body, as the options of a bake say, with this tolerance.
SphereOptions sphereOptions(const BakeOptions& options, double tolerance);

/// Fills the two bodies of a pair as the options say (METHOD 1). The same spheres at every call.
PairSpheres fillPair(const SceneModel& scene, const Pair& pair, const Motion& motion,
                     const BakeOptions& options, const Progress& progress = {});

/// fillPair() for up to three DOFs, with spheres all over what comes within the margin, scene units: they
/// tell how far apart bodies stay, up to that, where spheres of what may touch have shown that nothing does.
PairSpheres fillWithin(const SceneModel& scene, const Pair& pair, const Motion& motion,
                       const BakeOptions& options, double margin, const Progress& progress = {});

/// Over more DOFs than these no cover is looked for.
constexpr std::size_t mostCoverDofs = 6;

/// Over more DOFs than these neither what is within reach nor a cover is found in any time that people have,
/// unless as much as they like is asked for.
bool manyDofs(const Motion& motion, const BakeOptions& options);

/// Coarser than the options ask for, the coarsest first, scene units: spheres that may show in a moment that
/// two bodies never meet.
std::vector<double> coarserTolerances(const SceneModel& scene, const Pair& pair, const BakeOptions& options);

/// Fills all of both surfaces to a tolerance, scene units, and what is inside of them too, whether or not
/// the other body can stand there: apart, they show that the surfaces are.
PairSpheres fillSolid(const SceneModel& scene, const Pair& pair, const Motion& motion,
                      const BakeOptions& options, double tolerance, const Progress& progress = {});

/// Fills all of both surfaces, as finely as the options say or as coarsely as leaves all pairs to be asked.
PairSpheres fillToAskAll(const SceneModel& scene, const Pair& pair, const Motion& motion,
                         const BakeOptions& options, const Progress& progress = {});

/// Measures how well the spheres fit: their figures, and their bounds where these become better.
void measureSpheres(const SceneModel& scene, const Pair& pair, PairSpheres& spheres);

/// A bound as a file states it: none where there is none.
std::optional<double> boundOrUnknown(double bound);

} // namespace tss
