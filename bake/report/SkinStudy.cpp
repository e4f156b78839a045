#include "bake/report/SkinStudy.h"

#include "bake/base/Parallel.h"
#include "bake/compare/Ellipsoid.h"
#include "bake/pipeline/BakeSkin.h"
#include "bake/search/SkinSearch.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <numeric>

namespace tss::reporting {

namespace {

using namespace compare;
using Clock = std::chrono::steady_clock;

/// All that is the same for every method at one activation.
struct Step {
    SphereSet muscle;                      ///< spheres of all muscles, in the table's order
    std::vector<BentEllipsoid> ellipsoids; ///< one a muscle, fitted to its surface here
    std::vector<double> distances;         ///< #skin: from each vertex to the muscles, negative inside
    double activation = 0;                 ///< mean over the muscles
};

struct Setting {
    SphereSet skin; ///< one a vertex
    std::vector<Step> steps;
    std::vector<std::uint32_t> rowVertex; ///< of each row of the table
    Table table;                          ///< rows are skin spheres, columns into Step::muscle
};

using Found = std::vector<char>; ///< one a skin vertex

/// One method: marks the skin spheres that touch, says the work.
using Method = std::function<Work(const Step&, Found&)>;

bool overlap(const Sphere& a, const Sphere& b) {
    const double sum = a.radius + b.radius;
    return (a.centre - b.centre).squaredNorm() <= sum * sum;
}

Work allPairs(const Setting& setting, const Step& step, Found& found) {
    for (std::size_t i = 0; i < setting.skin.size(); ++i)
        for (const Sphere& sphere : step.muscle)
            found[i] = found[i] | (overlap(setting.skin[i], sphere) ? 1 : 0);
    const std::uint64_t tests = setting.skin.size() * step.muscle.size();
    return {tests, tests * productsPerSphereTest};
}

Work byTable(const Setting& setting, const Step& step, Found& found) {
    const Table& table = setting.table;
    for (std::size_t row = 0; row + 1 < table.rowOffsets.size(); ++row) {
        const Sphere& sphere = setting.skin[setting.rowVertex[row]];
        for (std::uint32_t k = table.rowOffsets[row]; k < table.rowOffsets[row + 1]; ++k)
            if (overlap(sphere, step.muscle[table.columns[k]])) found[setting.rowVertex[row]] = 1;
    }
    return {table.testCount(), table.testCount() * productsPerSphereTest};
}

/// A tree over spheres that move: the shape of the tree stays, its balls follow each step.
struct RefittedTree {
    BallTree tree;
    std::vector<std::uint32_t> leafOf; ///< sphere of each leaf node

    RefittedTree(const SphereSet& spheres, int arity) : tree(buildBallTree(spheres, arity, Enclosure::Box)) {
        // Leaves are copies of the spheres: found again by their place.
        std::vector<std::uint32_t> order(spheres.size());
        std::iota(order.begin(), order.end(), 0u);
        const auto less = [](const Sphere& a, const Sphere& b) {
            return std::tuple(a.centre.x(), a.centre.y(), a.centre.z(), a.radius) <
                   std::tuple(b.centre.x(), b.centre.y(), b.centre.z(), b.radius);
        };
        std::sort(order.begin(), order.end(),
                  [&](std::uint32_t i, std::uint32_t j) { return less(spheres[i], spheres[j]); });
        std::vector<char> taken(spheres.size(), 0);
        leafOf.assign(tree.nodes.size(), 0);
        for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
            if (tree.nodes[n].count > 0) continue;
            const Sphere leaf{tree.nodes[n].centre, tree.nodes[n].radius};
            auto at = std::lower_bound(order.begin(), order.end(), leaf,
                                       [&](std::uint32_t i, const Sphere& s) { return less(spheres[i], s); });
            while (taken[*at]) ++at; // equal spheres: each leaf takes its own
            taken[*at] = 1;
            leafOf[n] = *at;
        }
    }
    void refit(const SphereSet& spheres) {
        for (std::size_t n = tree.nodes.size(); n-- > 0;) {
            BallTree::Node& node = tree.nodes[n];
            if (node.count == 0) {
                node.centre = spheres[leafOf[n]].centre;
                node.radius = spheres[leafOf[n]].radius;
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
        const BallTree::Node &na = skin.tree.nodes[a], &nb = muscle.tree.nodes[b];
        if (!overlap({na.centre, na.radius}, {nb.centre, nb.radius})) return;
        if (na.count == 0 && nb.count == 0) {
            found[vertexOf[skin.leafOf[a]]] = 1;
        } else {
            stack.emplace_back(a, b);
        }
    };
    if (!skin.tree.nodes.empty() && !muscle.tree.nodes.empty()) test(0, 0);
    while (!stack.empty()) {
        const auto [a, b] = stack.back();
        stack.pop_back();
        const BallTree::Node &na = skin.tree.nodes[a], &nb = muscle.tree.nodes[b];
        const bool openA = nb.count == 0 || (na.count > 0 && na.radius >= nb.radius);
        const BallTree::Node& opened = openA ? na : nb;
        for (std::uint32_t k = opened.first; k < opened.first + opened.count; ++k)
            openA ? test(k, b) : test(a, k);
    }
    return counter.work;
}

Work byEllipsoids(const Setting& setting, const std::vector<std::uint32_t>& vertices, const Step& step,
                  Found& found, bool count) {
    Work work;
    for (const std::uint32_t v : vertices)
        for (const BentEllipsoid& ellipsoid : step.ellipsoids) {
            ++work.tests;
            if (touches(ellipsoid, setting.skin[v], count ? &work.products : nullptr)) found[v] = 1;
        }
    return work;
}

void judge(SkinMethod& method, const Setting& setting, const Method& run) {
    std::vector<double> times;
    for (const Step& step : setting.steps) {
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
        std::sort(rounds.begin(), rounds.end());
        times.push_back(rounds[2]);
    }
    std::sort(times.begin(), times.end());
    method.nanoseconds = times[times.size() / 2];
}

Step makeStep(const Setting& setting, const std::vector<std::shared_ptr<const MuscleDeformer>>& deformers,
              const std::vector<MuscleTrack>& tracks, const std::vector<SphereSet>& rest, double share) {
    Step step;
    step.distances.assign(setting.skin.size(), std::numeric_limits<double>::infinity());
    for (std::size_t m = 0; m < deformers.size(); ++m) {
        const Muscle& muscle = deformers[m]->muscle();
        if (muscle.surface.empty()) continue;
        const double activation =
            muscle.activationLower + share * (muscle.activationUpper - muscle.activationLower);
        step.activation += activation / static_cast<double>(deformers.size());
        const TrackPlace place = locate(tracks[m].nodes, activation);
        for (std::size_t s = 0; s < rest[m].size(); ++s)
            step.muscle.push_back({trackPosition(tracks[m], place, s),
                                   rest[m][s].radius * trackThickness(tracks[m], place, s)});
        TriangleMesh surface = deformers[m]->muscle().surface;
        surface.vertices = deformers[m]->vertices(activation);
        step.ellipsoids.push_back(fitEllipsoid(surface));
        const MeshQuery query(surface);
        parallelFor(setting.skin.size(), [&](std::size_t v) {
            const Vec3& p = setting.skin[v].centre;
            const double distance = query.distance(p);
            step.distances[v] = std::min(step.distances[v], query.inside(p) ? -distance : distance);
        });
    }
    return step;
}

Table wholeTable(const SkinTable& skinTable, const std::vector<SphereSet>& rest,
                 std::vector<std::uint32_t>& rowVertex) {
    // The table keeps used spheres only: they are found again in the whole sets by their place at rest.
    std::vector<Sphere> all;
    for (const SphereSet& set : rest) all.insert(all.end(), set.begin(), set.end());
    Table table = skinTable.table;
    std::vector<std::uint32_t> index(table.b.size(), 0);
    for (std::size_t b = 0; b < table.b.size(); ++b)
        for (std::uint32_t s = 0; s < all.size(); ++s)
            if (all[s].centre == table.b[b].centre && all[s].radius == table.b[b].radius) index[b] = s;
    for (std::uint32_t& column : table.columns) column = index[column];
    rowVertex = skinTable.skinVertices;
    return table;
}

} // namespace

SkinStudy studySkin(const SceneModel& scene, const SkinModel& skin, const ReportOptions& options,
                    const Progress& progress) {
    const auto start = Clock::now();
    report(progress, skin.path + ": skin", 0);
    SkinStudy study;
    study.path = skin.path;
    study.millimetres = 1000 * scene.metersPerUnit;
    const TriangleMesh& mesh = scene.bodies[static_cast<std::size_t>(skin.body)].mesh;
    const BakeOptions settings = optionsFor(skin.settings, {}, scene.metersPerUnit);
    PairReport notes;
    const FilledMuscles filled = fillMuscles(scene, skin, settings, notes);
    const auto& deformers = filled.deformers;
    std::vector<SphereSet> rest;
    std::vector<MuscleTrack> tracks;
    for (const SkinSearchMuscle& muscle : filled.searched) {
        rest.push_back(muscle.spheres);
        std::vector<MusclePoint> points;
        for (const Sphere& sphere : muscle.spheres) points.push_back(muscle.deformer->bind(sphere.centre));
        tracks.push_back(makeTrack(*muscle.deformer, points,
                                   activationNodes(muscle.deformer->muscle().activationLower,
                                                   muscle.deformer->muscle().activationUpper)));
        study.muscleSpheres += muscle.spheres.size();
    }
    study.muscles = deformers.size();

    SkinSearchOptions search;
    search.thickness = skin.thickness;
    search.path = SkinPath::AtRest;
    search.facingOnly = false;
    SkinSearchCounts counts;
    const SkinTable atRest = searchSkin(mesh, filled.searched, search, {}, &counts);
    study.skinSpheres = counts.skinSpheres;
    study.usedSkin = counts.usedSkin;
    study.usedMuscle = counts.usedMuscle;
    study.tests = counts.tests;

    SceneModel baked = scene;
    SkinModel carried = skin;
    bakeSkin(baked, carried, settings, notes, {});
    const UsedSpheres used = usedSpheres(carried.table->table);
    study.carriedSkin = used.a;
    study.carriedMuscle = used.b;
    study.carriedTests = carried.table->table.testCount();

    Setting setting;
    study.thickness = skin.thickness > 0 ? skin.thickness : skinThickness(mesh);
    for (const Vec3& v : mesh.vertices) setting.skin.push_back({v, study.thickness});
    setting.table = wholeTable(atRest, rest, setting.rowVertex);
    study.activations = options.quick ? 9 : 33;
    for (int k = 0; k < study.activations; ++k) {
        const double share = static_cast<double>(k) / (study.activations - 1);
        setting.steps.push_back(makeStep(setting, deformers, tracks, rest, share));
        study.activation.push_back(setting.steps.back().activation);
        for (std::size_t v = 0; v < setting.skin.size(); ++v) {
            ++study.judged;
            study.touching += setting.steps.back().distances[v] <= study.thickness ? 1 : 0;
        }
    }

    std::vector<std::uint32_t> every(setting.skin.size());
    std::iota(every.begin(), every.end(), 0u);
    SphereSet inRows;
    for (const std::uint32_t v : setting.rowVertex) inRows.push_back(setting.skin[v]);
    RefittedTree skinAll(setting.skin, 8), skinUsed(inRows, 8);
    RefittedTree muscleAll(setting.steps[0].muscle, 8);
    const auto add = [&](const std::string& name, const std::string& about, const Method& run) {
        SkinMethod method;
        method.name = name;
        method.about = about;
        judge(method, setting, run);
        study.methods.push_back(std::move(method));
    };
    add("tss", "the table's tests, skin at its rest place (the paper's way)",
        [&](const Step& step, Found& found) { return byTable(setting, step, found); });
    add("all-pairs", "every skin sphere against every muscle sphere",
        [&](const Step& step, Found& found) { return allPairs(setting, step, found); });
    add("tree-all-8", "trees over all skin and all muscle spheres, the muscle's refitted each step (case 1)",
        [&](const Step& step, Found& found) {
            return byTrees(skinAll, every, muscleAll, step.muscle, found);
        });
    add("tree-used-8", "trees over the table's skin spheres and all muscle spheres (case 2)",
        [&](const Step& step, Found& found) {
            return byTrees(skinUsed, setting.rowVertex, muscleAll, step.muscle, found);
        });
    for (const bool all : {false, true}) {
        const auto& vertices = all ? every : setting.rowVertex;
        add(all ? "ellipsoid-all" : "ellipsoid-used",
            std::string(
                "one bent ellipsoid a muscle, refitted each step (not timed; a test ends early where the "
                "sphere's centre is inside), against ") +
                (all ? "all skin spheres" : "the table's skin spheres"),
            [&](const Step& step, Found& found) {
                return byEllipsoids(setting, vertices, step, found, false);
            });
        SkinMethod& method = study.methods.back();
        Work work;
        for (const Step& step : setting.steps) {
            Found found(setting.skin.size(), 0);
            const Work one = byEllipsoids(setting, vertices, step, found, true);
            work.tests += one.tests;
            work.products += one.products;
        }
        method.products = static_cast<double>(work.products) / setting.steps.size();
        if (work.tests > 0)
            study.productsEllipsoid = static_cast<double>(work.products) / static_cast<double>(work.tests);
    }
    study.notRun.push_back({"FCL, Bullet on the skin",
                            "they answer for triangles of two rigid meshes; here each skin vertex "
                            "needs its own verdict on a surface that deforms"});
    study.notRun.push_back({"angular region, allowed paths, C-space grid",
                            "one activation a muscle would fit a grid, but each of the vertices needs one of "
                            "its own: that is a stored animation, not a test"});
    report(progress, skin.path + ": skin in motion", 0.5);
    study.motion = studySkinMotion(scene, carried, deformers, options.quick);
    study.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return study;
}

} // namespace tss::reporting
