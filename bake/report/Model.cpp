#include "bake/report/Model.h"

#include "bake/base/Parallel.h"
#include "bake/base/Stopwatch.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/Solid.h"
#include "bake/spheres/RoundToFloat.h"

#include <algorithm>

namespace tss::reporting {

namespace {

std::unique_ptr<Model> sameMeshes(const Model& model, const Recipe& recipe) {
    auto other = std::make_unique<Model>();
    other->recipe = recipe;
    other->problem.motion = model.problem.motion;
    other->problem.meshA = model.problem.meshA;
    other->problem.meshB = model.problem.meshB;
    return other;
}

/// The model with its table over spheres and meshes that are there already.
std::unique_ptr<Model> complete(std::unique_ptr<Model> model) {
    compare::ComparedPair& problem = model->problem;
    problem.a = model->spheres->a.spheres;
    problem.b = model->spheres->b.spheres;
    PairReport notes;
    const Stopwatch watch;
    const PairTable made = tabulatePair(*model->spheres, problem.motion, model->recipe.options, notes);
    model->tableSeconds = watch.seconds();
    model->proof = made.proof;
    if (made.table) problem.table = *made.table;
    const BakeRecord& record = made.table ? made.table->record : made.proof->record;
    problem.fitA = record.fitA;
    problem.fitB = record.fitB;
    return model;
}

} // namespace

std::unique_ptr<Model> makeModel(const SceneModel& scene, const Pair& pair, const Recipe& recipe) {
    auto model = std::make_unique<Model>();
    model->recipe = recipe;
    model->problem.motion = pairMotion(scene, pair);
    model->problem.meshA = cleaned(scene.bodies[pair.bodyA].mesh);
    model->problem.meshB = cleaned(scene.bodies[pair.bodyB].mesh);
    const Stopwatch watch;
    model->spheres =
        std::make_shared<PairSpheres>(fillPair(scene, pair, model->problem.motion, recipe.options));
    model->sphereSeconds = watch.seconds();
    return complete(std::move(model));
}

std::unique_ptr<Model> makeModel(const Model& model, const Recipe& recipe) {
    auto other = sameMeshes(model, recipe);
    other->spheres = model.spheres;
    other->sphereSeconds = model.sphereSeconds;
    return complete(std::move(other));
}

std::unique_ptr<Model> wholeBodies(const Model& model, const Recipe& recipe) {
    auto other = sameMeshes(model, recipe);
    SphereOptions options;
    options.tolerance = recipe.options.tolerance.value_or(0);
    const Stopwatch watch;
    PairSpheres spheres{fitSpheres(other->problem.meshA, options), fitSpheres(other->problem.meshB, options)};
    other->sphereSeconds = watch.seconds();
    for (SphereFit* fit : {&spheres.a, &spheres.b}) fit->spheres = roundToFloat(std::move(fit->spheres));
    other->spheres = std::make_shared<PairSpheres>(std::move(spheres));
    return complete(std::move(other));
}

double protrusionOf(const SphereSet& spheres, const TriangleMesh& mesh) {
    const Solid solid(mesh);
    std::vector<double> each(spheres.size(), 0.0);
    parallelFor(each.size(),
                [&](std::size_t i) { each[i] = solid.protrusion(spheres[i].centre, spheres[i].radius); });
    return each.empty() ? 0 : *std::ranges::max_element(each);
}

} // namespace tss::reporting
