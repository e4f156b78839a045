#pragma once
#include "bake/compare/CollisionMethod.h"
#include "bake/pipeline/BakePair.h"

namespace tss::reporting {

/// One way to make a table for a pair.
struct Recipe {
    std::string name; ///< for rows and plots, e.g. "0.4 mm"
    BakeOptions options;
};

/// A pair with its spheres and table, made as `tss bake` makes them, and what it took.
struct Model {
    Recipe recipe;
    std::shared_ptr<const PairSpheres> spheres;
    compare::ComparedPair problem; ///< the table is empty where there is a proof instead
    std::shared_ptr<const NeverCollides> proof;
    double sphereSeconds = 0, tableSeconds = 0;
};

/// Spheres and table of a pair by a recipe. One pointer, because methods refer to the problem.
std::unique_ptr<Model> makeModel(const SceneModel& scene, const Pair& pair, const Recipe& recipe);

/// Another table over the spheres of a model made before.
std::unique_ptr<Model> makeModel(const Model& model, const Recipe& recipe);

/// The same meshes filled whole with medial spheres of the recipe's tolerance, contact zone or not.
std::unique_ptr<Model> wholeBodies(const Model& model, const Recipe& recipe);

/// How far a sphere sticks out of its body at most, scene units: a bound.
double protrusionOf(const SphereSet& spheres, const TriangleMesh& mesh);

} // namespace tss::reporting
