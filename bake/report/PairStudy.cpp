#include "bake/report/PairStudy.h"

#include "bake/base/Degrees.h"
#include "bake/base/Error.h"
#include "bake/base/Stopwatch.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/motion/RandomPoses.h"
#include "bake/report/Text.h"

#include <fmt/format.h>

namespace tss::reporting {

namespace {

using namespace compare;

/// Steps in which first contact is looked for along a way.
constexpr int closingSteps = 200;

/// Slow methods are judged at the first one in so many of the poses.
constexpr std::size_t slowPart = 10;

struct Sizes {
    std::size_t uniform, near, timed, depths, motions;
    int steps;
    TimingOptions timing;
};

Sizes sizesFor(bool quick) {
    if (quick) return {2000, 200, 1000, 12, 6, 120, {7, 0.15, 2e-3, 0.01}};
    return {20000, 2000, 2000, 100, 20, 400, {21, 2.0, 3e-3, 0.05}};
}

/// A model with the methods that were made for it.
struct StudiedModel {
    std::unique_ptr<Model> model;
    std::string about;
    MethodScope scope;
    MethodSet methods;
};

std::string inMillimetres(double length, double millimetres) {
    return fmt::format("{:.3g} mm", length * millimetres);
}

/// Names a recipe by its tolerance and, where it has one, its epsilon.
Recipe named(BakeOptions options, double millimetres) {
    std::string name = inMillimetres(*options.tolerance, millimetres);
    if (options.epsilon > 0) name += ", ε " + inMillimetres(options.epsilon, millimetres);
    return {name, std::move(options)};
}

/// What `tss bake` would be asked for, but for contact at rest, which is contact here as it is to the meshes.
BakeOptions baseOptions(const SceneModel& scene, const Pair& pair, const TriangleMesh& a,
                        const TriangleMesh& b) {
    BakeOptions options = optionsFor(pair.settings, {}, scene.metersPerUnit);
    options.atRest = AtRest::Collide;
    if (!options.tolerance) options.tolerance = std::min(diagonal(a), diagonal(b)) / 500;
    return options;
}

BakePoint bakePoint(const StudiedModel& studied) {
    const Model& model = *studied.model;
    const ComparedPair& problem = model.problem;
    const Table& table = problem.table;
    BakePoint point;
    point.name = model.recipe.name;
    point.about = studied.about;
    point.tolerance = *model.recipe.options.tolerance;
    point.epsilon = model.recipe.options.epsilon;
    const auto sticksOut = [](const FitRecord& fit, const SphereSet& spheres, const TriangleMesh& mesh) {
        return fit.protrusion ? *fit.protrusion : protrusionOf(spheres, mesh);
    };
    point.protrusion = std::max(sticksOut(problem.fitA, problem.a, problem.meshA),
                                sticksOut(problem.fitB, problem.b, problem.meshB));
    point.spheresA = problem.a.size();
    point.spheresB = problem.b.size();
    point.usedA = table.a.size();
    point.usedB = table.b.size();
    point.tests = table.testCount();
    for (const double gap : table.restGaps) point.restTests += gap < 0 ? 1 : 0;
    point.bytes = tableBytes(table);
    point.certified = table.certified;
    if (table.record.lowerBound > 0) point.lowerBound = static_cast<double>(table.record.lowerBound);
    point.sphereSeconds = model.sphereSeconds;
    point.tableSeconds = model.tableSeconds;
    return point;
}

void fillWork(Row& row, const CollisionMethod& method, std::span<const PoseQuery> queries) {
    double tests = 0, products = 0;
    for (const PoseQuery& query : queries) {
        const auto work = method.work(query);
        if (!work) return;
        tests += static_cast<double>(work->tests);
        products += static_cast<double>(work->products);
    }
    row.tests = tests / static_cast<double>(queries.size());
    row.products = products / static_cast<double>(queries.size());
}

/// Whether a method of this family is made from the sphere model, so that the model's name is its setting.
bool onSpheres(const std::string& family) {
    return family.rfind("mesh tree", 0) != 0 && family != "octree sphere tree" &&
           family != "medial sphere tree" && family != "O'Rourke-Badler";
}

/// FCL asked with as little as possible in between, to show what the interface of the methods costs.
class FclDirectly final : public CollisionMethodLoop<FclDirectly> {
public:
    explicit FclDirectly(const MeshTruth& truth) : truth_(truth) {}
    bool hit(const PoseQuery& query) const override { return truth_.touches(query.pose); }

private:
    const MeshTruth& truth_;
};

void measureRows(PairStudy& study, const std::vector<StudiedModel>& field, const MeshTruth& truth,
                 const JudgedPoses& uniform, const JudgedPoses& near,
                 const std::vector<ClosingMotion>& motions, const Sizes& sizes, const Progress& progress) {
    std::vector<const CollisionMethod*> methods;
    std::vector<const Model*> models;
    for (const StudiedModel& studied : field)
        for (const auto& method : studied.methods.all) {
            methods.push_back(method.get());
            models.push_back(studied.model.get());
        }
    // Random poses: any first part of them hits and misses as Q does.
    const std::span<const PoseQuery> timed(uniform.queries().data(),
                                           std::min(sizes.timed, uniform.queries().size()));
    study.timedPoses = timed.size();
    report(progress, study.path + ": timing methods", 0);
    const FclDirectly directly(truth);
    methods.push_back(&directly);
    const std::vector<Times> times = timeMethods(methods, timed, sizes.timing);
    study.fclDirectly = times.back();
    methods.pop_back();
    for (std::size_t r = 0; r < methods.size(); ++r) {
        report(progress, study.path + ": judging methods",
               static_cast<double>(r) / static_cast<double>(methods.size()));
        Row row;
        row.about = methods[r]->description();
        row.method = row.about.name;
        if (onSpheres(row.about.family)) {
            row.setting = models[r]->recipe.name;
            row.about.buildSeconds += models[r]->sphereSeconds;
        }
        if (row.about.family == "TSS") row.about.buildSeconds += models[r]->tableSeconds;
        row.times = times[r];
        // By kind and not by the clock, so that every run judges at the same poses.
        const std::size_t part = row.about.slow ? slowPart : 1;
        row.uniform = measureError(*methods[r], uniform, uniform.queries().size() / part, sizes.depths);
        row.near = measureError(*methods[r], near, near.queries().size() / part, sizes.depths);
        const std::size_t ways = std::min(motions.size(), std::max<std::size_t>(2, motions.size() / part));
        row.firstContact = measureFirstContact(models[r]->problem, *methods[r],
                                               std::span(motions).first(ways), closingSteps);
        fillWork(row, *methods[r], timed.first(std::min<std::size_t>(timed.size(), 500)));
        study.rows.push_back(std::move(row));
    }
}

void describe(PairStudy& study, const SceneModel& scene, const Pair& pair, const Motion& motion) {
    study.path = pair.path;
    study.nameA = primName(scene.bodies[pair.bodyA].path);
    study.nameB = primName(scene.bodies[pair.bodyB].path);
    study.millimetres = 1000 * scene.metersPerUnit;
    for (const Dof& dof : motion.dofs) {
        const double factor = unitsPer(dof);
        study.dofs.push_back(fmt::format("{}: {:.4g} to {:.4g} {}", dof.name, dof.lower * factor,
                                         dof.upper * factor, unitOf(dof, scene.metersPerUnit)));
    }
}

/// A scene may ask for so many spheres at most: the tolerance that these reach is the one to study.
BakeOptions byTolerance(PairStudy& study, const SceneModel& scene, const Pair& pair, BakeOptions asked,
                        const Progress& progress) {
    if (asked.maxSpheres == 0) return asked;
    report(progress, study.path + ": spheres, as many as the scene asks for", 0);
    const StudiedModel most{makeModel(scene, pair, {"", asked}), "", MethodScope::All, {}};
    const BakePoint point = bakePoint(most);
    study.notes.push_back(fmt::format("The scene asks for at most {} spheres a body; these, {} + {}, stick "
                                      "out by {} mm, the tolerance that "
                                      "this report starts from.",
                                      asked.maxSpheres, point.spheresA, point.spheresB,
                                      number(point.protrusion * study.millimetres)));
    asked.maxSpheres = 0;
    if (point.protrusion > 0) asked.tolerance = point.protrusion;
    return asked;
}

/// Tables of ever finer spheres; returns the place of the one as asked for.
std::size_t addTolerances(PairStudy& study, const SceneModel& scene, const Pair& pair,
                          const BakeOptions& asked, bool quick, const Progress& progress,
                          std::vector<StudiedModel>& field) {
    std::size_t base = 0;
    for (const double factor : quick ? std::vector{1.0, 0.5} : std::vector{4.0, 2.0, 1.0, 0.5, 0.25, 0.125}) {
        BakeOptions changed = asked;
        changed.tolerance = factor * *asked.tolerance;
        const Recipe recipe = named(changed, study.millimetres);
        report(progress, study.path + ": spheres and table, " + recipe.name, 0);
        if (factor == 1) base = field.size();
        field.push_back(
            {makeModel(scene, pair, recipe), "", factor == 1 ? MethodScope::All : MethodScope::Spheres, {}});
        study.tolerances.push_back(bakePoint(field.back()));
    }
    study.base = study.tolerances[base];
    return base;
}

/// Tables of the same spheres for other epsilons.
void addEpsilons(PairStudy& study, const Model& model, const BakeOptions& asked, bool quick,
                 const Progress& progress, std::vector<StudiedModel>& field) {
    study.epsilons.push_back(study.base);
    for (const double factor : quick ? std::vector{0.1, 1.0} : std::vector{0.01, 0.03, 0.1, 0.3, 1.0, 3.0}) {
        BakeOptions changed = asked;
        changed.epsilon = factor * *asked.tolerance;
        const Recipe recipe = named(changed, study.millimetres);
        report(progress, study.path + ": table, " + recipe.name, 0);
        field.push_back({makeModel(model, recipe), "", MethodScope::Table, {}});
        study.epsilons.push_back(bakePoint(field.back()));
    }
}

/// Other tables and other spheres at the base's tolerance: what the paper does, and what is lost or won.
std::vector<StudiedModel> otherRecipes(const SceneModel& scene, const Pair& pair, const Model& base,
                                       bool quick) {
    const auto with = [&](const std::string& name, const auto& change) {
        Recipe recipe{name, base.recipe.options};
        change(recipe.options);
        return recipe;
    };
    std::vector<StudiedModel> models;
    const auto fill = [&](const Recipe& recipe, const std::string& about) {
        models.push_back({makeModel(scene, pair, recipe), about, MethodScope::Spheres, {}});
    };
    const auto tabulate = [&](const Recipe& recipe, const std::string& about) {
        models.push_back({makeModel(base, recipe), about, MethodScope::Table, {}});
    };
    fill(with("paper",
              [&](BakeOptions& o) {
                  o.spheres = SphereMethod::Growth;
                  o.search = SearchMethod::Sampled;
                  o.reduce = ReduceMethod::Cooccurrence;
                  if (quick) o.samples = 2000;
              }),
         "the paper's own: spheres by growth in the narrow regions, sampled search, reduction by "
         "co-occurrence");
    fill(with("growth, certified",
              [](BakeOptions& o) {
                  o.spheres = SphereMethod::Growth;
                  o.search = SearchMethod::Certified;
                  o.reduce = ReduceMethod::Cover;
              }),
         "the paper's spheres by growth, with the certified search and cover");
    if (!quick) {
        models.push_back({wholeBodies(base, with("whole bodies", [](BakeOptions&) {})),
                          "our spheres over the whole surfaces, not only where the two can meet",
                          MethodScope::Spheres,
                          {}});
        fill(with("inscribed", [](BakeOptions& o) { o.conservative = false; }),
             "spheres inside the bodies instead of about their surface (`--no-conservative`)");
        const auto sampled = [&](const std::string& name, ReduceMethod reduce) {
            return with(name, [&](BakeOptions& o) {
                o.search = SearchMethod::Sampled;
                o.reduce = reduce;
            });
        };
        tabulate(sampled("paper's reduction", ReduceMethod::Cooccurrence),
                 "our spheres, the paper's sampled search and its reduction by co-occurrence");
        tabulate(sampled("minimal over samples", ReduceMethod::Minimal),
                 "our spheres, the smallest set that answers alike at the poses explored (the paper's M_ss)");
    }
    const AtRest asked = optionsFor(pair.settings, {}, scene.metersPerUnit).atRest;
    const bool ignored = asked == AtRest::Ignore;
    if (asked != AtRest::Collide &&
        !ruleOfSpheres(base.problem.a, base.problem.b, base.problem.motion, AtRest::Ignore).empty())
        fill(with(ignored ? "at rest: ignore" : "at rest: offset", [&](BakeOptions& o) { o.atRest = asked; }),
             ignored
                 ? "what `tss bake` stores by the scene's settings: the region that overlaps at rest never "
                   "touches"
                 : "what `tss bake` stores: the region that overlaps at rest touches only where it goes "
                   "deeper");
    return models;
}

} // namespace

double Row::worst() const {
    return std::max(deepestMiss(), farthestEarly());
}

double unitsPer(const Dof& dof) {
    return dof.kind == DofKind::Rotation ? toDegrees(1) : 1;
}

std::string unitOf(const Dof& dof, double metersPerUnit) {
    switch (dof.kind) {
    case DofKind::Rotation:
        return "degrees";
    case DofKind::Translation:
        return "times " + lengthText(dof.axis.norm(), metersPerUnit);
    case DofKind::Path:
        return "of its path";
    }
    return "";
}

std::vector<const Row*> paretoFront(const std::vector<Row>& rows, const std::function<double(const Row&)>& x,
                                    const std::function<double(const Row&)>& y) {
    std::vector<const Row*> sorted, front;
    for (const Row& row : rows)
        if (x(row) > 0 && !row.slow()) sorted.push_back(&row);
    std::ranges::stable_sort(sorted, [&](const Row* a, const Row* b) { return x(*a) < x(*b); });
    for (const Row* row : sorted)
        if (front.empty() || y(*row) < y(*front.back())) front.push_back(row);
    return front;
}

double Row::wrong() const {
    return static_cast<double>(uniform.missed + uniform.early) /
           static_cast<double>(std::max<std::size_t>(1, uniform.poses));
}

PairStudy studyPair(const SceneModel& scene, const Pair& pair, const ReportOptions& options,
                    const Progress& progress) {
    const Stopwatch watch;
    const Sizes sizes = sizesFor(options.quick);
    PairStudy study;
    const Motion motion = pairMotion(scene, pair);
    checkMotion(motion);
    describe(study, scene, pair, motion);
    const auto finish = [&] { study.seconds = watch.seconds(); };
    const TriangleMesh a = cleaned(scene.bodies[pair.bodyA].mesh);
    const TriangleMesh b = cleaned(scene.bodies[pair.bodyB].mesh);
    study.trianglesA = a.triangles.size();
    study.trianglesB = b.triangles.size();

    const BakeOptions asked = byTolerance(study, scene, pair, baseOptions(scene, pair, a, b), progress);
    std::vector<StudiedModel> field;
    const std::size_t base = addTolerances(study, scene, pair, asked, options.quick, progress, field);
    const Model& model = *field[base].model;
    if (model.proof || model.problem.table.testCount() == 0) {
        study.never = neverText(scene, pair, model);
        finish();
        return study;
    }
    addEpsilons(study, model, asked, options.quick, progress, field);
    report(progress, study.path + ": other recipes", 0);
    for (StudiedModel& studied : otherRecipes(scene, pair, model, options.quick)) {
        study.recipes.push_back(bakePoint(studied));
        field.push_back(std::move(studied));
    }
    std::erase_if(field,
                  [](const StudiedModel& studied) { return studied.model->problem.table.testCount() == 0; });

    report(progress, study.path + ": poses", 0);
    const MeshTruth truth(a, b);
    const JudgedPoses uniform(model.problem, truth, randomPoses(motion, sizes.uniform, options.seed));
    const JudgedPoses near(model.problem, truth,
                           nearContactPoses(truth, motion, sizes.near, 1e-6, options.seed + 1));
    const auto motions = closingMotions(model.problem, truth, uniform, sizes.motions, closingSteps);
    study.uniformPoses = uniform.queries().size();
    study.touchingUniform = uniform.touching();
    study.nearPoses = near.queries().size();
    study.leftOut = uniform.leftOut() + near.leftOut();
    for (std::string& note : notesOf(study)) study.notes.push_back(std::move(note));
    study.earlyBound = model.problem.table.boundEarly;
    if (study.earlyBound) study.freeWithinBound = uniform.freeWithin(*study.earlyBound);
    for (StudiedModel& studied : field) {
        report(progress, study.path + ": building methods, " + studied.model->recipe.name, 0);
        studied.methods =
            makeMethods(*studied.model, studied.scope, options.quick, options.methods, options.seed + 3);
        if (studied.scope == MethodScope::All) study.notRun = studied.methods.notRun;
    }
    measureRows(study, field, truth, uniform, near, motions, sizes, progress);

    report(progress, study.path + ": sweeps", 0);
    studySteps(study, scene, pair, model, truth, options, sizes.steps);
    studySampling(study, model, options);
    finish();
    return study;
}

} // namespace tss::reporting
