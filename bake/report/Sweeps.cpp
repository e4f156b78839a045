#include "bake/base/Parallel.h"
#include "bake/motion/DofUnits.h"
#include "bake/motion/Motion.h"
#include "bake/report/Study.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace tss::reporting {

namespace {

using namespace compare;

/// A motion of a pair, and what it is in words.
struct PairMotionSteps {
    std::string about;
    std::vector<std::vector<double>> values; ///< one per DOF, each step
};

/// The scene's own animation of the pair; nothing where it has none, or where not a single joint carries it.
std::optional<PairMotionSteps> ownAnimation(const SceneModel& scene, const Pair& pair, const Motion& motion,
                                            int steps) {
    if (pair.joints.size() != 1 || !(scene.endTimeCode > scene.startTimeCode)) return std::nullopt;
    const Joint& joint = scene.joints[pair.joints[0]];
    if (joint.body0 != pair.bodyA || joint.drives.size() != motion.dofCount() ||
        std::ranges::any_of(joint.drives, &TimeSamples::empty))
        return std::nullopt;
    PairMotionSteps own{"the scene's own animation", {}};
    for (int s = 0; s < steps; ++s) {
        const double time = scene.startTimeCode + (scene.endTimeCode - scene.startTimeCode) * s / (steps - 1);
        std::vector<double> q;
        for (const TimeSamples& drive : joint.drives) q.push_back(drive.at(time));
        own.values.push_back(clampToLimits(motion, q));
    }
    return own;
}

/// The leading DOF from its upper limit to the lower one and back, the others at rest.
PairMotionSteps toAndFro(const Motion& motion, std::size_t leading, int steps) {
    const Dof& dof = motion.dofs[leading];
    PairMotionSteps swing{dof.name + " from its upper limit to the lower one and back", {}};
    for (int s = 0; s < steps; ++s) {
        std::vector<double> q = restValues(motion);
        const double share = std::abs(1 - 2.0 * s / (steps - 1));
        q[leading] = dof.lower + share * (dof.upper - dof.lower);
        swing.values.push_back(clampToLimits(motion, q));
    }
    return swing;
}

/// How often `touches` holds in slices of the leading DOF, the others anywhere in their limits. samples: of
/// each slice.
template <class Touches>
RegionCurve regionOf(const Motion& motion, std::size_t leading, int samples, std::uint64_t seed,
                     const Touches& touches) {
    constexpr int bins = 76;
    const Dof& dof = motion.dofs[leading];
    const double step = (dof.upper - dof.lower) / bins;
    std::vector<int> hits(static_cast<std::size_t>(bins), 0);
    parallelFor(hits.size(), [&](std::size_t k) {
        std::mt19937_64 random(seed + k);
        for (int s = 0; s < samples; ++s) {
            PoseQuery query;
            for (const Dof& d : motion.dofs)
                query.q.push_back(std::uniform_real_distribution<double>(d.lower, d.upper)(random));
            query.q[leading] = dof.lower + step * (static_cast<double>(k) + (s + 0.5) / samples);
            query.pose = pose(motion, query.q);
            hits[k] += touches(query) ? 1 : 0;
        }
    });
    RegionCurve region;
    for (int k = 0; k < bins; ++k) {
        region.middle.push_back(toUser(dof, dof.lower + step * (k + 0.5)));
        region.share.push_back(static_cast<double>(hits[k]) / samples);
        if (region.share.back() == 0) continue;
        if (region.upper == region.lower) region.lower = toUser(dof, dof.lower + step * k);
        region.upper = toUser(dof, dof.lower + step * (k + 1));
    }
    return region;
}

/// Share of the queries at which the whole model collides and the table does not.
double missedShare(const CollisionMethod& whole, const CollisionMethod& table,
                   const std::vector<PoseQuery>& queries) {
    std::size_t hits = 0, missed = 0;
    for (const PoseQuery& query : queries) {
        if (!whole.hit(query)) continue;
        ++hits;
        missed += table.hit(query) ? 0 : 1;
    }
    return hits > 0 ? static_cast<double>(missed) / static_cast<double>(hits) : 0;
}

} // namespace

double RegionCurve::meanShare() const {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < middle.size(); ++k)
        if (contains(middle[k])) {
            sum += share[k];
            ++count;
        }
    return count ? sum / static_cast<double>(count) : 0;
}

void studySteps(PairStudy& study, const SceneModel& scene, const Pair& pair, const Model& model,
                const MeshTruth& truth, const ReportOptions& options, int steps) {
    const ComparedPair& problem = model.problem;
    const std::size_t leading = leadingDof(problem);
    const Dof& dof = problem.motion.dofs[leading];
    study.leading = leading;
    study.leadingDof = dof.name;
    study.leadingUnit = unitOf(dof, scene.metersPerUnit);
    const auto whole = makeSphereTree(problem, TreeOf::All, 8, Enclosure::Balls);
    study.region.spheres = regionOf(problem.motion, leading, 400, options.seed + 4,
                                    [&](const PoseQuery& query) { return whole->hit(query); });
    study.region.meshes = regionOf(problem.motion, leading, options.quick ? 30 : 200, options.seed + 5,
                                   [&](const PoseQuery& query) { return truth.touches(query.pose); });

    PairMotionSteps motion{"the motion given", options.motion};
    if (options.motion.empty())
        motion = ownAnimation(scene, pair, problem.motion, steps)
                     .value_or(toAndFro(problem.motion, leading, steps));
    study.steps.motion = motion.about;
    const auto queries = poseQueries(problem.motion, motion.values);
    for (const PoseQuery& query : queries) {
        const double value = toUser(dof, query.q[leading]);
        study.steps.leading.push_back(value);
        study.steps.touching.push_back(truth.touches(query.pose) ? 1 : 0);
        study.steps.inRegion.push_back(study.region.spheres.contains(value));
        study.steps.inMeshRegion += study.region.meshes.contains(value) ? 1 : 0;
    }
    std::vector<std::pair<std::string, std::unique_ptr<CollisionMethod>>> methods;
    methods.emplace_back("all pairs, until the first hit", makeAllPairs(problem));
    methods.emplace_back("sphere tree, all spheres (case 1)",
                         makeSphereTree(problem, TreeOf::All, 8, Enclosure::Balls));
    methods.emplace_back("sphere tree, used spheres (case 2)",
                         makeSphereTree(problem, TreeOf::Used, 8, Enclosure::Balls));
    methods.emplace_back("medial sphere tree", makeAdaptiveMedial(problem, 3));
    methods.emplace_back("octree sphere tree", makeOctree(problem, 6));
    methods.emplace_back("TSS", makePairList(problem));
    for (const auto& [name, method] : methods) {
        StepSeries series{name, {}};
        for (const PoseQuery& query : queries)
            series.tests.push_back(static_cast<double>(method->work(query).tests));
        study.steps.series.push_back(std::move(series));
    }
    StepSeries mixed{"TSS in the angular region only", {}};
    for (std::size_t s = 0; s < queries.size(); ++s)
        mixed.tests.push_back(study.steps.inRegion[s] ? static_cast<double>(problem.table.testCount()) : 0);
    study.steps.series.push_back(std::move(mixed));
}

void studySampling(PairStudy& study, const Model& model, const ReportOptions& options) {
    const ComparedPair& problem = model.problem;
    const auto whole = makeSphereTree(problem, TreeOf::All, 8, Enclosure::Balls);
    const std::size_t count = options.quick ? 4000 : 20000;
    const auto uniform = poseQueries(problem.motion, randomPoses(problem.motion, count, options.seed + 5));
    const auto near =
        poseQueries(problem.motion, nearContactPoses(
                                        [&](const Pose& at) {
                                            return whole->hit({{}, at});
                                        },
                                        problem.motion, options.quick ? 600 : 4000, 1e-6, options.seed + 6));
    for (const int samples :
         options.quick ? std::vector{30, 300, 3000} : std::vector{30, 100, 300, 1000, 3000, 10000, 30000})
        for (const auto& [reduce, name] :
             {std::pair{ReduceMethod::Cooccurrence, "cooccurrence"}, std::pair{ReduceMethod::None, "none"}}) {
            Recipe recipe = model.recipe;
            recipe.options.search = SearchMethod::Sampled;
            recipe.options.reduce = reduce;
            recipe.options.samples = samples;
            const auto sampled = makeModel(model, recipe);
            const auto table = makePairList(sampled->problem);
            study.sampling.push_back({static_cast<std::size_t>(samples), name,
                                      sampled->problem.table.testCount(),
                                      missedShare(*whole, *table, uniform), missedShare(*whole, *table, near),
                                      sampled->tableSeconds});
        }
}

} // namespace tss::reporting
