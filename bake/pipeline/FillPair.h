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
    double zoneMargin =
        0; ///< scene units: surface outside the zone stays farther from the other body than this
    FitRecord figuresA{}, figuresB{}; ///< as far as they were measured
    double clearanceAtRest = 0;       ///< of the surfaces, scene units; 0: they touch or overlap
    RestRegion region{};              ///< exempt parts of the meshes as loaded, of medial spheres
    double protrusions = 0; ///< scene units: the sum of both bodies' protrusions, the resolution of depths
    bool testAll =
        false; ///< the table is to test all pairs that are not known to stay apart, without a cover
};

/// Whether the spheres are so few that a table may test all their pairs in place of a certified cover.
bool canTestAll(const PairSpheres& spheres, const BakeOptions& options);

/// Whether coarser spheres may be made so that canTestAll(). Not for a table that states a gap, which is
/// verified against exactly the spheres that its settings make.
bool mayCoarsenToTestAll(const BakeOptions& options);

/// How far apart the surfaces are where the joint rests; 0: they touch or overlap.
double clearanceAtRest(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion);

/// The options for filling all of a body as a bake says, with this tolerance, scene units.
SphereOptions sphereOptions(const BakeOptions& options, double tolerance);

/// Fills the two bodies of a pair as the options say (METHOD 1). The same spheres at every call. Where no
/// tolerance is asked for and the usual one takes too many spheres, a coarser one is taken, and noted.
PairSpheres fillPair(const SceneModel& scene, const Pair& pair, const Motion& motion,
                     const BakeOptions& options, const Progress& progress = {});

/// fillPair() for up to three DOFs, but with spheres over all surface that comes within `margin`, scene
/// units, of the other body. For a pair that the spheres of fillPair() have shown never to touch: these show
/// how far apart the bodies stay, at most the margin.
PairSpheres fillWithin(const SceneModel& scene, const Pair& pair, const Motion& motion,
                       const BakeOptions& options, double margin, const Progress& progress = {});

/// Whether there are more DOFs than a contact zone and a cover can be found for in usual time; with no limit
/// of time (a budget of 0) more of them count as few.
bool manyDofs(const Motion& motion, const BakeOptions& options);

/// Where many pairs share their bodies those of one body ask for the same spheres of it (WholeFits):
/// tolerances are powers of two and of its square root, scene units. The one next to this one.
double toleranceNextTo(double tolerance);
constexpr double toleranceStep = 1.4142135623730951; ///< from one to the next

/// Tolerances no finer than the options ask for, the coarsest first, scene units: to try whether few spheres
/// show quickly that two bodies never meet whose surfaces come as near as that, scene units.
std::vector<double> coarserTolerances(const SceneModel& scene, const Pair& pair, const BakeOptions& options,
                                      double nearest);

/// Fills all of both bodies as solids to a tolerance, scene units, whether or not the other body can stand
/// inside: where such spheres stay apart, so do the surfaces.
PairSpheres fillSolid(const SceneModel& scene, const Pair& pair, const Motion& motion,
                      const BakeOptions& options, double tolerance, const Progress& progress = {});

/// Fills all of both surfaces, as finely as the options say, but so coarsely that all pairs can be tested.
PairSpheres fillToTestAll(const SceneModel& scene, const Pair& pair, const Motion& motion,
                          const BakeOptions& options, const Progress& progress = {});

/// Measures how well the spheres fit: fills in the figures, and lowers the bounds where the measured are
/// better.
void measureSpheres(const SceneModel& scene, const Pair& pair, PairSpheres& spheres);

/// A bound as a file states it: nothing where it is infinite.
std::optional<double> boundOrUnknown(double bound);

} // namespace tss
