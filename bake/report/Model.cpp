#include "bake/report/Model.h"

#include "bake/reduce/CertifiedCover.h"
#include "bake/reduce/Cooccurrence.h"
#include "bake/reduce/Minimal.h"
#include "bake/search/CertifiedSearch.h"
#include "bake/search/SampledSearch.h"
#include "bake/spheres/GenerateSpheres.h"
#include "bake/spheres/RoundToFloat.h"

#include <chrono>
#include <cmath>

namespace tss::reporting {

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

SampledSearchOptions sampledOptions(const Recipe& recipe) {
    SampledSearchOptions options;
    options.samples = recipe.samples;
    options.atRest = AtRest::Collide;
    return options;
}

Reduced byCover(Model& model) {
    CoverOptions options;
    options.epsilon = model.recipe.epsilon;
    options.atRest = AtRest::Collide;
    const compare::Problem& problem = model.problem;
    CoverResult cover = certifiedCover(problem.a, problem.b, nullptr, problem.motion, options);
    model.complete = cover.complete;
    model.clearance = cover.clearance;
    model.proofOfNever = cover.complete && cover.pairs.empty();
    model.problem.table.epsilon = cover.epsilon;
    model.problem.table.certified = std::isfinite(cover.epsilon);
    return cover;
}

Reduced bySearch(Model& model) {
    const compare::Problem& problem = model.problem;
    CandidatePairs candidates;
    if (model.recipe.search == SearchMethod::Sampled) {
        candidates = searchSampled(problem.a, problem.b, problem.motion, sampledOptions(model.recipe));
    } else {
        CertifiedSearchOptions options;
        options.atRest = AtRest::Collide;
        candidates = searchCertified(problem.a, problem.b, problem.motion, options);
    }
    model.candidatePairs = candidates.pairs.size();
    if (model.recipe.reduce == ReduceMethod::Cooccurrence) return reduceCooccurrence(candidates);
    if (model.recipe.reduce == ReduceMethod::Minimal)
        return reduceMinimal(problem.a, problem.b, problem.motion, sampledOptions(model.recipe));
    Reduced all;
    all.pairs = candidates.pairs;
    return all;
}

} // namespace

Spheres makeSpheres(const TriangleMesh& mesh, const Recipe& recipe) {
    SphereOptions options;
    options.method = recipe.spheres;
    options.tolerance = recipe.tolerance;
    options.maxSpheres = recipe.maxSpheres;
    options.conservative = recipe.conservative;
    const SphereFit fit = fitSpheres(mesh, options);
    Spheres spheres;
    for (const Sphere& sphere : fit.spheres) spheres.set.push_back(roundToFloat(sphere));
    spheres.fit = {std::isfinite(fit.coverage) ? fit.coverage : -1,
                   std::isfinite(fit.protrusion) ? fit.protrusion : -1};
    return spheres;
}

std::unique_ptr<Model> makeModel(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                                 const Recipe& recipe) {
    const auto start = Clock::now();
    const Spheres spheresA = makeSpheres(a, recipe), spheresB = makeSpheres(b, recipe);
    const double seconds = since(start);
    auto model = makeModel(a, b, motion, recipe, spheresA, spheresB);
    model->sphereSeconds = seconds;
    return model;
}

std::unique_ptr<Model> makeModel(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                                 const Recipe& recipe, const Spheres& spheresA, const Spheres& spheresB) {
    auto model = std::make_unique<Model>();
    model->recipe = recipe;
    model->problem = {a, b, motion, spheresA.set, spheresB.set, spheresA.fit, spheresB.fit, {}};
    const auto start = Clock::now();
    const Reduced reduced = recipe.reduce == ReduceMethod::Cover ? byCover(*model) : bySearch(*model);
    model->lowerBound = reduced.lowerBound;
    Table table = makeTable(spheresA.set, spheresB.set, reduced.pairs, reduced.restGaps, motion);
    table.epsilon = model->problem.table.epsilon;
    table.certified = model->problem.table.certified;
    const double miss = compare::missOf(spheresA.fit, spheresB.fit), early = compare::earlyOf(spheresA.fit, spheresB.fit);
    // The table's gap is at most epsilon above the model's: it may see a contact later by that, never sooner.
    table.boundMiss = miss < 0 ? -1 : miss + table.epsilon;
    table.boundEarly = early;
    model->problem.table = std::move(table);
    model->tableSeconds = since(start);
    return model;
}

} // namespace tss::reporting
