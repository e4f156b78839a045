#include "bake/base/Stopwatch.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/motion/DofUnits.h"
#include "bake/motion/Motion.h"
#include "bake/report/Study.h"

#include <fmt/format.h>

namespace tss::reporting {

namespace {

using namespace compare;

/// Steps in which first contact is looked for along a way.
constexpr int closingSteps = 200;

/// Slow methods are judged at the first one in so many of the poses.
constexpr std::size_t slowPart = 10;

/// How many of each are looked at.
struct Sizes {
    std::size_t uniform, near, timed; ///< poses: over all limits, near contact, for timing
    std::size_t depths, motions;      ///< missed contacts whose depth is measured; closing motions
    int steps;                        ///< of the motion along which tests are counted
    TimingOptions timing;
};

Sizes sizesFor(bool quick) {
    if (quick) return {2000, 200, 1000, 12, 6, 120, {7, 0.15, 2e-3, 0.01}};
    return {20000, 2000, 2000, 100, 20, 400, {21, 2.0, 3e-3, 0.05}};
}

void fillWork(Row& row, const CollisionMethod& method, std::span<const PoseQuery> queries) {
    if (!method.work) return;
    double tests = 0, products = 0;
    for (const PoseQuery& query : queries) {
        const Work work = method.work(query);
        tests += static_cast<double>(work.tests);
        products += static_cast<double>(work.products);
    }
    row.tests = tests / static_cast<double>(queries.size());
    row.products = products / static_cast<double>(queries.size());
}

/// Whether a method of this family is made from the sphere model, so that the model's name is its setting.
bool onSpheres(const std::string& family) {
    return family.rfind("mesh tree", 0) != 0 && family != "octree sphere tree" &&
           family != "medial sphere tree" && family != "O'Rourke-Badler";
}

/// What every method is judged by.
struct Trials {
    const JudgedPoses &uniform, &near;
    const std::vector<ClosingMotion>& motions;
    const Sizes& sizes;

    /// Random poses: any first part of them hits and misses as Q does.
    std::span<const PoseQuery> timed() const {
        return {uniform.queries().data(), std::min(sizes.timed, uniform.queries().size())};
    }
};

/// The row of a method, made for that model, but for its times.
Row judged(const CollisionMethod& method, const Model& model, const Trials& trials) {
    Row row;
    row.about = method.description;
    row.method = row.about.name;
    if (onSpheres(row.about.family)) {
        row.setting = model.recipe.name;
        row.about.buildSeconds += model.sphereSeconds;
    }
    if (row.about.family == "TSS") row.about.buildSeconds += model.tableSeconds;
    // By kind and not by the clock, so that every run judges at the same poses.
    const std::size_t part = row.about.slow ? slowPart : 1;
    const auto error = [&](const JudgedPoses& poses) {
        return measureError(method, poses, poses.queries().size() / part, trials.sizes.depths);
    };
    row.uniform = error(trials.uniform);
    row.near = error(trials.near);
    const std::size_t count = trials.motions.size(),
                      ways = std::min(count, std::max<std::size_t>(2, count / part));
    row.firstContact =
        measureFirstContact(model.problem, method, std::span(trials.motions).first(ways), closingSteps);
    fillWork(row, method, trials.timed().first(std::min<std::size_t>(trials.timed().size(), 500)));
    return row;
}

/// Times all methods together, then judges each. truth: of the meshes, timed beside them.
void measureRows(PairStudy& study, const std::vector<StudiedModel>& field, const Trials& trials,
                 const MeshTruth& truth, const Progress& progress) {
    std::vector<const CollisionMethod*> methods;
    std::vector<const Model*> models;
    for (const StudiedModel& studied : field)
        for (const auto& method : studied.methods.all) {
            methods.push_back(method.get());
            models.push_back(studied.model.get());
        }
    study.timedPoses = trials.timed().size();
    report(progress, study.path + ": timing methods", 0);
    // FCL asked with as little as possible in between, to show what the interface of the methods costs.
    const auto directly =
        makeMethod({}, [&truth](const PoseQuery& query) { return truth.touches(query.pose); });
    methods.push_back(directly.get());
    const std::vector<Times> times = timeMethods(methods, trials.timed(), trials.sizes.timing);
    study.fclDirectly = times.back();
    methods.pop_back();
    for (std::size_t r = 0; r < methods.size(); ++r) {
        report(progress, study.path + ": judging methods",
               static_cast<double>(r) / static_cast<double>(methods.size()));
        study.rows.push_back(judged(*methods[r], *models[r], trials));
        study.rows.back().times = times[r];
    }
}

void describe(PairStudy& study, const SceneModel& scene, const Pair& pair, const Motion& motion) {
    study.path = pair.path;
    study.nameA = primName(scene.bodies[pair.bodyA].path);
    study.nameB = primName(scene.bodies[pair.bodyB].path);
    study.millimetres = 1000 * scene.metersPerUnit;
    for (const Dof& dof : motion.dofs)
        study.dofs.push_back(fmt::format("{}: {:.4g} to {:.4g} {}", dof.name, toUser(dof, dof.lower),
                                         toUser(dof, dof.upper), unitOf(dof, scene.metersPerUnit)));
}

} // namespace

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

PairStudy studyPair(const SceneModel& scene, const Pair& pair, const ReportOptions& options,
                    const Progress& progress) {
    const Stopwatch watch;
    const Sizes sizes = sizesFor(options.quick);
    PairStudy study;
    const Motion motion = pairMotion(scene, pair);
    checkMotion(motion);
    describe(study, scene, pair, motion);
    const TriangleMesh a = cleaned(scene.bodies[pair.bodyA].mesh);
    const TriangleMesh b = cleaned(scene.bodies[pair.bodyB].mesh);
    study.trianglesA = a.triangles.size();
    study.trianglesB = b.triangles.size();

    auto [base, field] = studiedModels(study, scene, pair, a, b, options.quick, progress);
    const Model& model = *base;
    if (field.empty()) {
        study.never = neverText(scene, pair, model);
        study.seconds = watch.seconds();
        return study;
    }

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
    measureRows(study, field, {uniform, near, motions, sizes}, truth, progress);

    report(progress, study.path + ": sweeps", 0);
    studySteps(study, scene, pair, model, truth, options, sizes.steps);
    studySampling(study, model, options);
    study.seconds = watch.seconds();
    return study;
}

} // namespace tss::reporting
