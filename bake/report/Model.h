#pragma once
#include "bake/BakeOptions.h"
#include "bake/compare/Problem.h"
#include "bake/scene/SceneModel.h"

namespace tss::reporting {

/// One way to make a table for a pair.
struct Recipe {
    std::string name; ///< for rows and plots, e.g. "0.4 mm"
    SphereMethod spheres = SphereMethod::Medial;
    double tolerance = 0; ///< scene units
    SearchMethod search = SearchMethod::Certified;
    ReduceMethod reduce = ReduceMethod::Cover;
    double epsilon = 0;
    std::size_t samples = 4096; ///< of the sampled search
    int maxSpheres = 0;
    bool conservative = true;
};

/// A pair with its spheres and table, by the pipeline's own parts, and what it took.
struct Model {
    Recipe recipe;
    compare::Problem problem;
    std::size_t candidatePairs = 0; ///< Tc, or 0 where the cover was found without a list of them
    double lowerBound = 0;
    bool proofOfNever = false; ///< no pair of spheres can meet anywhere
    bool complete = true;      ///< the cover reached its epsilon
    double clearance = 0;
    double sphereSeconds = 0, tableSeconds = 0;
};

/// The spheres of a body by a recipe.
struct Spheres {
    SphereSet set;
    FitRecord fit;
};
Spheres makeSpheres(const TriangleMesh& mesh, const Recipe& recipe);

/// Contact at rest is contact here (METHOD 2.4, `collide`): the meshes say so too. One pointer, because
/// methods refer to the problem.
std::unique_ptr<Model> makeModel(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                                 const Recipe& recipe);

/// The same with spheres made before.
std::unique_ptr<Model> makeModel(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                                 const Recipe& recipe, const Spheres& spheresA, const Spheres& spheresB);

} // namespace tss::reporting
