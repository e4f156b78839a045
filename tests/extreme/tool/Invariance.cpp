#include "tests/extreme/tool/Invariance.h"

#include "bake/pipeline/Bake.h"
#include "bake/table/Query.h"
#include "bake/table/TablePairs.h"
#include "tests/extreme/scenes/Builders.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <random>
#include <set>

namespace extreme {

namespace {

using namespace tss;

/// The changed pair, and how what came of it is taken back.
struct Change {
    std::string name;
    SceneModel scene;
    double unit = 1; ///< changed length over the first's
    Pose turned =
        Pose::Identity(); ///< of both bodies' frames: changed = turned * first, lengths in the first's
    bool swapped = false;
    std::vector<double> dofUnits{}; ///< changed value over the first's, a DOF
    double rounding = 2e-6;         ///< of a centre as the file holds it, as a share of the size
};

constexpr double size = 40; ///< of the swing

std::shared_ptr<const Table> tableFor(SceneModel scene) {
    bake(scene, {});
    return scene.pairs[0].table;
}

/// The swing with every point and axis of both bodies moved by a pose.
SceneModel moved(const Pose& pose) {
    SceneModel scene = swing();
    for (Body& body : scene.bodies)
        for (Vec3& v : body.mesh.vertices) v = pose * v;
    scene.joints[0].frame0 = pose * scene.joints[0].frame0;
    scene.joints[0].frame1 = pose * scene.joints[0].frame1;
    return scene;
}

Change inUnits(const std::string& name, double factor) {
    Change change{name, swing()};
    change.unit = factor;
    for (Body& body : change.scene.bodies)
        for (Vec3& v : body.mesh.vertices) v *= factor;
    Joint& joint = change.scene.joints[0];
    joint.frame0.translation() *= factor;
    joint.frame1.translation() *= factor;
    joint.dofs[0].axis *= factor;
    change.scene.pairs[0].settings["tolerance"] = fmt::format("{}", 0.2 * factor);
    return change;
}

std::vector<Change> changes() {
    std::vector<Change> all;
    for (const auto& [name, factor] : {std::pair{"units 2^20 times as small", 0x1p20},
                                       {"units 2^20 times as large", 0x1p-20},
                                       {"units 1e6 times as small", 1e6},
                                       {"units 1e6 times as large", 1e-6}})
        all.push_back(inUnits(name, factor));

    SceneModel placed = swing();
    for (Body& body : placed.bodies)
        body.placement = Pose(Eigen::Translation3d(1e7, -1e7, 1e7)) * body.placement;
    all.push_back({"placed 1e7 units off", placed});

    for (const double far : {100., 1e4, 1e7}) {
        Change change{"modelled " + std::to_string(long(far)) + " units off", {}};
        change.turned = Pose(Eigen::Translation3d(far, -far, far));
        change.scene = moved(change.turned);
        change.rounding = 2e-6 + 4 * std::ldexp(far, -23) / size;
        all.push_back(std::move(change));
    }
    const Vec3 axes[] = {{0, 0, 1}, {1, 0, 0}, {1, -2, 3}};
    const double angles[] = {90 * degree, 180 * degree, 0.7};
    for (int k = 0; k < 3; ++k) {
        Change change{"turned by " + std::to_string(int(std::round(angles[k] / degree))) + " degrees", {}};
        change.turned = Eigen::AngleAxisd(angles[k], axes[k].normalized());
        change.scene = moved(change.turned);
        all.push_back(std::move(change));
    }
    Change swapped{"A and B swapped", swing()};
    std::swap(swapped.scene.pairs[0].bodyA, swapped.scene.pairs[0].bodyB);
    swapped.swapped = true;
    all.push_back(std::move(swapped));

    Change shuffled{"triangles shuffled", swing()};
    std::mt19937_64 random(3);
    for (Body& body : shuffled.scene.bodies)
        for (std::size_t k = body.mesh.triangles.size(); k-- > 1;)
            std::swap(body.mesh.triangles[k], body.mesh.triangles[random() % (k + 1)]);
    all.push_back(std::move(shuffled));

    for (const double scale : {1e-3, 1e4}) {
        Change change{scale < 1 ? "the slide in thousandths" : "the slide in units of 10000", swing()};
        Dof& dof = change.scene.joints[0].dofs[0];
        dof.axis *= scale;
        dof.lower /= scale;
        dof.upper /= scale;
        change.dofUnits = {1 / scale, 1};
        all.push_back(std::move(change));
    }
    return all;
}

/// For every sphere the nearest like of the other set, and the farthest distance of one.
std::vector<std::size_t> likes(const SphereSet& spheres, const Change& change, const SphereSet& base,
                               double& off) {
    std::vector<std::size_t> found;
    const Pose back = change.turned.inverse();
    for (const Sphere& sphere : spheres) {
        const Vec3 centre = back * Vec3(sphere.centre / change.unit);
        double best = std::numeric_limits<double>::infinity();
        std::size_t like = 0;
        for (std::size_t k = 0; k < base.size(); ++k) {
            const double away =
                (centre - base[k].centre).norm() + std::abs(sphere.radius / change.unit - base[k].radius);
            if (away < best) {
                best = away;
                like = k;
            }
        }
        off = std::max(off, best);
        found.push_back(like);
    }
    return found;
}

using Likes = std::set<std::pair<std::size_t, std::size_t>>;

Likes testLikes(const Table& table, const std::vector<std::size_t>& a, const std::vector<std::size_t>& b,
                bool swapped) {
    Likes pairs;
    for (const SpherePair& pair : tests(table))
        pairs.insert(swapped ? std::pair{b[pair.b], a[pair.a]} : std::pair{a[pair.a], b[pair.b]});
    return pairs;
}

Invariance compare(const Table& base, const Change& change, int poses) {
    const std::shared_ptr<const Table> table = tableFor(change.scene);
    Invariance result;
    result.change = change.name;
    result.sameTable = change.rounding < 1e-5;
    result.sameCount = table->testCount() == base.testCount();
    const SphereSet &baseA = change.swapped ? base.b : base.a, &baseB = change.swapped ? base.a : base.b;
    const auto a = likes(table->a, change, baseA, result.off);
    const auto b = likes(table->b, change, baseB, result.off);
    Likes own;
    for (const SpherePair& pair : tests(base)) own.insert({pair.a, pair.b});
    result.sameTests = result.sameCount && testLikes(*table, a, b, change.swapped) == own;
    result.band = 4 * change.rounding * size;
    for (const std::vector<double>& q : latticePoses(base.motion, poses)) {
        std::vector<double> there = q;
        for (std::size_t k = 0; k < change.dofUnits.size(); ++k) there[k] *= change.dofUnits[k];
        if (change.swapped) std::reverse(there.begin(), there.end());
        const double gap = query(base, q).gap, other = query(*table, there).gap / change.unit;
        ++result.poses;
        result.hits += gap <= 0;
        result.differ += std::abs(gap) > result.band && (gap <= 0) != (other <= 0);
    }
    return result;
}

} // namespace

std::vector<Invariance> invariances(int poses) {
    const std::shared_ptr<const Table> base = tableFor(swing());
    std::vector<Invariance> results;
    for (const Change& change : changes()) results.push_back(compare(*base, change, poses));
    return results;
}

} // namespace extreme
