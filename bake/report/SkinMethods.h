#pragma once
#include "bake/compare/CollisionMethod.h"
#include "bake/compare/Ellipsoid.h"
#include "bake/report/SkinStudy.h"

namespace tss::reporting {

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
