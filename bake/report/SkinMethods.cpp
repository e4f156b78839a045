#include "bake/report/SkinStudy.h"

#include "bake/base/Order.h"
#include "bake/base/Stopwatch.h"
#include "bake/compare/EnclosingTree.h"
#include "bake/report/Timing.h"

#include <algorithm>
#include <functional>

namespace tss::reporting {

namespace {

using namespace compare;

using Found = std::vector<char>; ///< one per skin vertex

/// One method: marks the skin spheres that touch, says the work.
using Method = std::function<Work(const SkinStep&, Found&)>;

bool overlap(const Sphere& a, const Sphere& b) {
    const double sum = a.radius + b.radius;
    return (a.centre - b.centre).squaredNorm() <= sum * sum;
}

Work allPairs(const SkinSetting& setting, const SkinStep& step, Found& found) {
    for (std::size_t i = 0; i < setting.skin.size(); ++i)
        for (const Sphere& sphere : step.muscle)
            found[i] = found[i] | (overlap(setting.skin[i], sphere) ? 1 : 0);
    return sphereTests(setting.skin.size() * step.muscle.size());
}

Work byTable(const SkinSetting& setting, const SkinStep& step, Found& found) {
    const Table& table = setting.table;
    for (std::size_t row = 0; row + 1 < table.rowOffsets.size(); ++row) {
        const Sphere& sphere = setting.skin[setting.rowVertex[row]];
        for (std::uint32_t k = table.rowOffsets[row]; k < table.rowOffsets[row + 1]; ++k)
            if (overlap(sphere, step.muscle[table.columns[k]])) found[setting.rowVertex[row]] = 1;
    }
    return sphereTests(table.testCount());
}

/// A tree over spheres that move: the shape of the tree stays, its balls follow each step.
struct RefittedTree {
    EnclosingTree tree;

    explicit RefittedTree(const SphereSet& spheres) : tree(buildEnclosingTree(spheres, 8, Enclosure::Box)) {}
    void refit(const SphereSet& spheres) {
        for (std::size_t n = tree.nodes.size(); n-- > 0;) {
            EnclosingTree::Node& node = tree.nodes[n];
            if (node.count == 0) {
                node.centre = spheres[node.first].centre;
                node.radius = spheres[node.first].radius;
                continue;
            }
            node.centre = Vec3::Zero();
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
                node.centre += tree.nodes[k].centre;
            node.centre /= node.count;
            node.radius = 0;
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
                node.radius =
                    std::max(node.radius, (tree.nodes[k].centre - node.centre).norm() + tree.nodes[k].radius);
        }
    }
};

/// Both trees together; every leaf pair that overlaps is found, for a skin needs all its contacts.
Work byTrees(const RefittedTree& skin, const std::vector<std::uint32_t>& vertexOf, RefittedTree& muscle,
             const SphereSet& spheres, Found& found) {
    muscle.refit(spheres);
    CountWork counter;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack;
    const auto test = [&](std::uint32_t a, std::uint32_t b) {
        counter.sphereTest();
        const EnclosingTree::Node &na = skin.tree.nodes[a], &nb = muscle.tree.nodes[b];
        if (!overlap({na.centre, na.radius}, {nb.centre, nb.radius})) return false;
        if (na.count == 0 && nb.count == 0) {
            found[vertexOf[na.first]] = 1;
        } else {
            stack.emplace_back(a, b);
        }
        return false; // go on
    };
    if (!skin.tree.nodes.empty() && !muscle.tree.nodes.empty()) test(0, 0);
    while (!stack.empty()) {
        const auto [a, b] = stack.back();
        stack.pop_back();
        openLarger(skin.tree, muscle.tree, a, b, test);
    }
    return counter.work;
}

Work byEllipsoids(const SkinSetting& setting, const std::vector<std::uint32_t>& vertices,
                  const SkinStep& step, Found& found, bool count) {
    Work work;
    for (const std::uint32_t v : vertices)
        for (const BentEllipsoid& ellipsoid : step.ellipsoids) {
            ++work.tests;
            if (touches(ellipsoid, setting.skin[v], count ? &work.products : nullptr)) found[v] = 1;
        }
    return work;
}

void judge(SkinMethod& method, const SkinSetting& setting, const Method& run) {
    std::vector<double> times;
    for (const SkinStep& step : setting.steps) {
        Found found(setting.skin.size(), 0);
        const Work work = run(step, found);
        method.perStep.push_back(static_cast<double>(work.tests));
        method.tests += static_cast<double>(work.tests) / setting.steps.size();
        method.products += static_cast<double>(work.products) / setting.steps.size();
        for (std::size_t v = 0; v < found.size(); ++v) {
            const double beyond = step.distances[v] - setting.skin[v].radius;
            if (beyond <= 0 && !found[v]) {
                ++method.missed;
                method.deepestMiss = std::max(method.deepestMiss, -beyond);
            }
            if (beyond > 0 && found[v]) {
                ++method.early;
                method.farthestEarly = std::max(method.farthestEarly, beyond);
            }
        }
        std::vector<double> rounds;
        for (int round = 0; round < 5; ++round) {
            const double start = threadSeconds();
            run(step, found);
            rounds.push_back(1e9 * (threadSeconds() - start));
        }
        times.push_back(median(std::move(rounds)));
    }
    method.nanoseconds = median(std::move(times));
}

void addMethod(SkinStudy& study, const SkinSetting& setting, const std::string& name,
               const std::string& about, const Method& run) {
    SkinMethod method;
    method.name = name;
    method.about = about;
    judge(method, setting, run);
    study.methods.push_back(std::move(method));
}

/// Bent ellipsoids, against some of the skin's vertices; their products are counted apart from their time.
void addEllipsoids(SkinStudy& study, const SkinSetting& setting, const std::vector<std::uint32_t>& vertices,
                   const std::string& name, const std::string& against) {
    addMethod(study, setting, name,
              "one bent ellipsoid a " + study.partName() +
                  ", refitted each step (not timed; a test ends early where the sphere's centre is inside), "
                  "against " +
                  against,
              [&](const SkinStep& step, Found& found) {
                  return byEllipsoids(setting, vertices, step, found, false);
              });
    Work work;
    for (const SkinStep& step : setting.steps) {
        Found found(setting.skin.size(), 0);
        const Work one = byEllipsoids(setting, vertices, step, found, true);
        work.tests += one.tests;
        work.products += one.products;
    }
    study.methods.back().products = static_cast<double>(work.products) / setting.steps.size();
    if (work.tests > 0)
        study.productsEllipsoid = static_cast<double>(work.products) / static_cast<double>(work.tests);
}

} // namespace

void runSkinMethods(const SkinSetting& setting, SkinStudy& study) {
    std::vector<std::uint32_t> every = indicesOf(setting.skin.size());
    SphereSet inRows;
    for (const std::uint32_t v : setting.rowVertex) inRows.push_back(setting.skin[v]);
    const RefittedTree skinAll(setting.skin), skinUsed(inRows);
    RefittedTree muscleAll(setting.steps[0].muscle);
    addMethod(study, setting, "tss", "the table's tests, skin at its rest place (the paper's way)",
              [&](const SkinStep& step, Found& found) { return byTable(setting, step, found); });
    const std::string part = study.partName();
    addMethod(study, setting, "all-pairs", "every skin sphere against every " + part + " sphere",
              [&](const SkinStep& step, Found& found) { return allPairs(setting, step, found); });
    addMethod(study, setting, "tree-all-8",
              "trees over all skin and all " + part + " spheres, the " + part +
                  "'s refitted each step (case 1)",
              [&](const SkinStep& step, Found& found) {
                  return byTrees(skinAll, every, muscleAll, step.muscle, found);
              });
    addMethod(study, setting, "tree-used-8",
              "trees over the table's skin spheres and all " + part + " spheres (case 2)",
              [&](const SkinStep& step, Found& found) {
                  return byTrees(skinUsed, setting.rowVertex, muscleAll, step.muscle, found);
              });
    addEllipsoids(study, setting, setting.rowVertex, "ellipsoid-used", "the table's skin spheres");
    addEllipsoids(study, setting, every, "ellipsoid-all", "all skin spheres");
}

} // namespace tss::reporting
