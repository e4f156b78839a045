#include "bake/report/PairStudy.h"

#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"

#include <chrono>
#include <cmath>
#include <fmt/format.h>

namespace tss::reporting {

namespace {

using namespace compare;
using Clock = std::chrono::steady_clock;

struct Sizes {
    std::size_t uniform, near, timed, worst, motions;
    int steps;
    TimingOptions timing;
};

Sizes sizesFor(bool quick) {
    if (quick) return {1500, 200, 200, 24, 6, 120, {5, 0.25, 1e-3}};
    return {10000, 1000, 500, 120, 20, 400, {15, 2.0, 3e-3}};
}

std::string lengthName(double length, double millimetres) {
    return fmt::format("{:.3g} mm", length * millimetres);
}

std::vector<Recipe> recipes(double base, bool quick, double millimetres) {
    std::vector<Recipe> list;
    for (const double factor : quick ? std::vector{4.0, 2.0} : std::vector{8.0, 4.0, 2.0, 1.0, 0.5}) {
        Recipe recipe;
        recipe.tolerance = factor * base;
        recipe.name = lengthName(recipe.tolerance, millimetres);
        list.push_back(recipe);
    }
    return list;
}

BakePoint bakePoint(const Model& model) {
    const Table& table = model.problem.table;
    return {model.recipe.tolerance,
            model.problem.a.size(),
            model.problem.b.size(),
            table.a.size(),
            table.b.size(),
            table.testCount(),
            (table.a.size() + table.b.size()) * 4 * sizeof(float) +
                (table.rowOffsets.size() + table.columns.size()) * sizeof(std::uint32_t),
            model.lowerBound,
            model.sphereSeconds,
            model.tableSeconds};
}

void fillWork(Row& row, const Rival& rival, const std::vector<PoseQuery>& queries) {
    double tests = 0, products = 0;
    for (const PoseQuery& query : queries) {
        const auto work = rival.work(query);
        if (!work) return;
        tests += static_cast<double>(work->tests);
        products += static_cast<double>(work->products);
    }
    row.tests = tests / static_cast<double>(queries.size());
    row.products = products / static_cast<double>(queries.size());
}

/// Does the method stand on the sphere model, so that its setting is the spheres' tolerance?
bool onSpheres(const std::string& family) {
    return family.rfind("mesh tree", 0) != 0 && family != "octree sphere tree" &&
           family != "medial sphere tree" && family != "O'Rourke-Badler";
}

struct Lineup {
    std::vector<Contestants> contestants;
    std::vector<std::unique_ptr<Model>> models;
};

void measureRows(PairStudy& study, const Lineup& field, const JudgedPoses& uniform, const JudgedPoses& near,
                 const std::vector<ClosingMotion>& motions, const Sizes& sizes, const Progress& progress) {
    std::vector<const Rival*> rivals;
    std::vector<const Model*> models;
    for (std::size_t m = 0; m < field.models.size(); ++m)
        for (const auto& rival : field.contestants[m].rivals) {
            rivals.push_back(rival.get());
            models.push_back(field.models[m].get());
        }
    // Evenly through the uniform poses, so that hits and misses come as they come over Q.
    std::vector<PoseQuery> timed;
    const std::size_t stride = std::max<std::size_t>(1, uniform.queries().size() / sizes.timed);
    for (std::size_t i = 0; i < uniform.queries().size() && timed.size() < sizes.timed; i += stride)
        timed.push_back(uniform.queries()[i]);
    study.timedPoses = timed.size();
    const std::vector<Times> times = timeMethods(rivals, timed, sizes.timing);
    for (std::size_t r = 0; r < rivals.size(); ++r) {
        report(progress, study.path + ": judging methods", static_cast<double>(r) / rivals.size());
        Row row;
        row.about = rivals[r]->description();
        row.method = row.about.name;
        if (onSpheres(row.about.family)) row.setting = models[r]->recipe.name;
        row.times = times[r];
        row.uniform = measureError(*rivals[r], uniform, sizes.worst);
        row.near = measureError(*rivals[r], near, sizes.worst);
        row.firstContact = measureFirstContact(models[r]->problem, *rivals[r], motions, 100);
        fillWork(row, *rivals[r], timed);
        study.rows.push_back(std::move(row));
    }
}

void describe(PairStudy& study, const SceneModel& scene, const Pair& pair, const Motion& motion) {
    const auto last = [](const std::string& path) { return path.substr(path.rfind('/') + 1); };
    study.path = pair.path;
    study.nameA = last(scene.bodies[static_cast<std::size_t>(pair.bodyA)].path);
    study.nameB = last(scene.bodies[static_cast<std::size_t>(pair.bodyB)].path);
    study.millimetres = 1000 * scene.metersPerUnit;
    constexpr double degrees = 180 / 3.14159265358979323846;
    for (const Dof& dof : motion.dofs) {
        const double factor = dof.kind == DofKind::Rotation ? degrees : 1;
        study.dofs.push_back(fmt::format("{}: {:.4g} to {:.4g}{}", dof.name, dof.lower * factor,
                                         dof.upper * factor,
                                         dof.kind == DofKind::Rotation ? " degrees" : ""));
    }
}

} // namespace

double Row::worst() const {
    return std::max({uniform.deepestMiss, near.deepestMiss, uniform.farthestEarly, near.farthestEarly});
}

PairStudy studyPair(const SceneModel& scene, const Pair& pair, const ReportOptions& options,
                    const Progress& progress) {
    const auto start = Clock::now();
    const Sizes sizes = sizesFor(options.quick);
    PairStudy study;
    const Motion motion = pairMotion(scene, pair);
    checkMotion(motion);
    describe(study, scene, pair, motion);
    const TriangleMesh a = cleaned(scene.bodies[static_cast<std::size_t>(pair.bodyA)].mesh);
    const TriangleMesh b = cleaned(scene.bodies[static_cast<std::size_t>(pair.bodyB)].mesh);
    study.trianglesA = a.triangles.size();
    study.trianglesB = b.triangles.size();
    study.baseTolerance = std::min(bounds(a).diagonal().norm(), bounds(b).diagonal().norm()) / 500;
    const auto set = pair.settings.find("tolerance");
    if (set != pair.settings.end()) study.baseTolerance = parseLength(set->second, scene.metersPerUnit);

    Lineup field;
    for (const Recipe& recipe : recipes(study.baseTolerance, options.quick, study.millimetres)) {
        report(progress, study.path + ": spheres and table, " + recipe.name, 0);
        field.models.push_back(makeModel(a, b, motion, recipe));
        study.bakes.push_back(bakePoint(*field.models.back()));
    }
    const std::size_t base = options.quick ? field.models.size() - 1 : field.models.size() - 2;
    Model& model = *field.models[base];
    if (model.proofOfNever) {
        study.neverCollides = true;
        study.clearance = model.clearance;
        study.seconds = std::chrono::duration<double>(Clock::now() - start).count();
        return study;
    }
    report(progress, study.path + ": poses", 0);
    const MeshTruth truth(a, b);
    const JudgedPoses uniform(model.problem, truth, randomPoses(motion, sizes.uniform, options.seed));
    const JudgedPoses near(model.problem, truth,
                           nearContactPoses(truth, motion, sizes.near, 1e-6, options.seed + 1));
    const auto motions = closingMotions(model.problem, truth, sizes.motions, 400, options.seed + 2);
    study.uniformPoses = sizes.uniform;
    study.touchingUniform = uniform.touching();
    study.nearPoses = near.queries().size();
    for (std::size_t m = 0; m < field.models.size(); ++m) {
        report(progress, study.path + ": building methods", static_cast<double>(m) / field.models.size());
        field.contestants.push_back(makeContestants(*field.models[m], m == base ? Field::Whole : Field::Model,
                                                    options.quick, options.methods, options.seed + 3));
    }
    study.notRun = field.contestants[base].notRun;
    measureRows(study, field, uniform, near, motions, sizes, progress);

    report(progress, study.path + ": sweeps", 0);
    studyPaper(study, model, options);
    studySteps(study, scene, pair, model, truth, options, sizes.steps);
    studySampling(study, model, options);
    studyEpsilon(study, model, options);
    study.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return study;
}

} // namespace tss::reporting
