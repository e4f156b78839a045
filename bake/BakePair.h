#pragma once
#include "bake/Bake.h"
#include "bake/search/SkinSearch.h"
#include "bake/spheres/GenerateSpheres.h"
#include "bake/spheres/Patches.h"

#include <optional>

namespace tss {

/// The spheres of both bodies as a file can hold them, with what is proven of them.
struct PairSpheres {
    SphereFit a, b;
    /// The surface that they stand for, where that is not all of it: the contact zone.
    std::optional<std::vector<Patch>> zoneA{}, zoneB{};
    FitRecord figuresA{}, figuresB{}; ///< as far as they were measured
    double clearanceAtRest = 0;       ///< of the surfaces; 0: they touch or overlap
    RestRegion region{};              ///< of the meshes as loaded, where spheres are fitted to surfaces
    double stickOut = 0;              ///< of the spheres of both together, by which they tell no depths apart
};

/// How far apart the surfaces are where the joint rests; 0: they touch or overlap.
double clearanceAtRest(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion);

/// Of the whole of a body, as the options of a bake say, with this tolerance.
SphereOptions sphereOptions(const BakeOptions& options, double tolerance);

/// Fills the two bodies of a pair as the options say (METHOD 1). The same spheres at every call.
PairSpheres fillPair(const SceneModel& scene, const Pair& pair, const Motion& motion,
                     const BakeOptions& options, const Progress& progress = {});

/// What a pair has instead of its meshes at run time: one of the two.
struct PairTable {
    std::shared_ptr<const Table> table;
    std::shared_ptr<const NeverCollides> proof;
};

/// Search, reduction and bounds over spheres from fillPair() (METHOD 2, 3). What a person should know, and
/// the epsilon reached, go into the report.
PairTable tabulatePair(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options,
                       PairReport& report, const Progress& progress = {});

/// One pair from its meshes to its table or its proof (METHOD 1 to 3). The result goes into the pair; what a
/// person should know goes into the report.
void bakePair(SceneModel& scene, Pair& pair, const BakeOptions& options, PairReport& report,
              const Progress& progress);

/// The muscles of a skin, filled with spheres.
struct FilledMuscles {
    std::vector<std::shared_ptr<const MuscleDeformer>> deformers;
    std::vector<SkinSearchMuscle> searched; ///< point to the deformers
};
FilledMuscles fillMuscles(const SceneModel& scene, const SkinModel& skin, const BakeOptions& options,
                          PairReport& report, const Progress& progress = {});

/// One skin from its muscles to the rows that they can reach (METHOD 6.2).
void bakeSkin(SceneModel& scene, SkinModel& skin, const BakeOptions& options, PairReport& report,
              const Progress& progress);

} // namespace tss
