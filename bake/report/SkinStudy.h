#pragma once
#include "bake/compare/Ellipsoid.h"
#include "bake/report/SkinMotion.h"
#include "bake/report/Study.h"

namespace tss::reporting {

/// One way to find which skin spheres touch what is below at an activation.
struct SkinMethod {
    std::string name, about;
    double tests = 0, products = 0; ///< a step, mean over the activations
    double nanoseconds = 0;         ///< a step, median
    std::size_t missed = 0;         ///< skin vertices within their thickness of what is below and not found
    std::size_t early = 0;          ///< found although it is farther
    double deepestMiss = 0;         ///< scene units: how far inside its thickness the worst one is
    double farthestEarly = 0;       ///< scene units: how far beyond its thickness
    std::vector<double> perStep;    ///< tests at each activation
};

/// A skin over its muscles (METHOD 6.2, 7), the paper's second example, or over bones.
struct SkinStudy {
    std::string path;
    double millimetres = 1;
    std::size_t muscles = 0, bones = 0;                  ///< below the skin, as the scene has them
    std::size_t skinSpheres = 0, muscleSpheres = 0;      ///< muscleSpheres: of the bones too
    std::size_t usedSkin = 0, usedMuscle = 0, tests = 0; ///< the paper's way: skin at its rest place
    std::size_t carriedSkin = 0, carriedMuscle = 0,
                carriedTests = 0;         ///< the scene's way: skin that is carried
    std::size_t judged = 0, touching = 0; ///< vertices times activations, by the surfaces
    int activations = 0;                  ///< 1, at rest, where nothing below can contract
    double thickness = 0;                 ///< radius of a skin sphere, scene units
    double productsEllipsoid = 0;         ///< of one test of a sphere against a bent ellipsoid, mean
    std::vector<double> activation;       ///< mean over the muscles, at each step
    std::vector<SkinMethod> methods;
    SkinMotionStudy motion;
    std::vector<NotRun> notRun;
    double seconds = 0;

    std::size_t below() const { return muscles + bones; }
    std::string partName() const;  ///< what it lies on: "muscle", "bone", "muscle or bone"
    std::string partCount() const; ///< "1 muscle and 2 bones"
};

SkinStudy studySkin(const SceneModel& scene, const SkinModel& skin, const ReportOptions& options,
                    const Progress& progress);

/// All that is the same for every method at one activation.
struct SkinStep {
    SphereSet muscle;                               ///< spheres of all muscles, in the table's order
    std::vector<compare::BentEllipsoid> ellipsoids; ///< one per muscle, fitted to its surface here
    std::vector<double> distances; ///< #skin: from each vertex to the muscles, negative inside
    double activation = 0;         ///< mean over the muscles
};

struct SkinSetting {
    SphereSet skin; ///< one per vertex
    std::vector<SkinStep> steps;
    std::vector<std::uint32_t> rowVertex; ///< of each row of the table
    Table table;                          ///< rows are skin spheres, columns into SkinStep::muscle
};

/// Asks every method at every step: contacts missed and early ones, tests, products and times.
void runSkinMethods(const SkinSetting& setting, SkinStudy& study);

} // namespace tss::reporting
