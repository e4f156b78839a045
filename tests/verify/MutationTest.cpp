// Damages to a table, its spheres, its motion and its promises. The verifier must refuse every one that
// matters: those that a table of this motion may not have at all, and those for which a pose is known that
// shows the harm.
#include "bake/table/Query.h"
#include "tests/verify/Baked.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>

using namespace tss;

namespace {

/// What is put before the verifier.
struct Exhibit {
    SphereSet a, b;
    Table table;
    Motion motion;
};

struct Count {
    int tried = 0, caught = 0, harmless = 0, scenes = 0;
};
using Counts = std::map<std::string, Count>;

VerifyResult judge(const Exhibit& x) {
    return verifyTable(x.a, x.b, x.table, x.motion, colliding());
}

/// How far a pose that the verifier names may be from one that shows the harm, on scenes about a unit across.
constexpr double rounding = 1e-8;

/// By how much the table breaks its promise at a pose; negative where it keeps it.
double lag(const Exhibit& x, const std::vector<double>& q) {
    const Pose at = pose(x.motion, q);
    const double models = queryAllPairs(x.a, x.b, at).gap;
    if (models > x.table.gapMargin + rounding) return -1;
    return query(x.table, at).gap - std::max(models, -x.table.gapDepth) - x.table.epsilon;
}

/// Looks for a pose at which a table breaks its promise by more than rounding: random ones, those of
/// `likely`, and the ends of segments between contact and its absence.
bool harmShown(const Exhibit& x, const std::vector<std::vector<double>>& likely, std::uint64_t seed) {
    const auto shows = [&](const std::vector<double>& q) {
        return withinLimits(x.motion, q) && lag(x, q) > 10 * rounding;
    };
    if (std::any_of(likely.begin(), likely.end(), shows)) return true;
    scenes::Random random(seed);
    const scenes::Scene scene{x.a, x.b, x.motion};
    std::vector<double> free, hit;
    for (int k = 0; k < 200; ++k) {
        const auto q = scenes::randomPose(random, x.motion);
        if (shows(q)) return true;
        (queryAllPairs(x.a, x.b, pose(x.motion, q)).gap <= 0 ? hit : free) = q;
        if (k % 8 || free.empty() || hit.empty()) continue;
        if (shows(bisected(scene, free, hit).second)) return true;
    }
    return false;
}

/// A damage that no table of the scene may have.
void forbidden(Counts& counts, const std::string& kind, const Exhibit& damaged) {
    Count& count = counts[kind];
    ++count.tried;
    const VerifyResult result = judge(damaged);
    count.caught += !result.proven;
    if (result.proven) UNSCOPED_INFO("passed: " << kind);
    CHECK_FALSE(result.proven);
}

/// A damage that may be harmless: it must be caught when a pose shows its harm; a refusal must name a pose
/// that does.
void harmful(Counts& counts, const std::string& kind, const Exhibit& damaged, std::uint64_t seed) {
    Count& count = counts[kind];
    const VerifyResult result = judge(damaged);
    if (result.proven) {
        const bool harm = harmShown(damaged, {}, seed);
        CHECK_FALSE(harm);
        count.tried += harm;
        count.harmless += !harm;
        return;
    }
    ++count.tried;
    ++count.caught;
    if (result.pose.empty()) return;
    CHECK(withinLimits(damaged.motion, result.pose));
    CHECK(lag(damaged, result.pose) > -rounding);
}

void removePairs(Counts& counts, const Exhibit& good, std::uint64_t seed) {
    for (std::size_t k = 0; k < good.table.testCount(); ++k) {
        Exhibit less = good;
        less.table = without(good.table, k);
        harmful(counts, "a pair removed", less, seed);
    }
    Exhibit empty = good;
    empty.table = makeTable({}, {}, {}, {}, good.motion);
    harmful(counts, "all pairs removed", empty, seed);
}

void changeRadii(Counts& counts, const Exhibit& good, scenes::Random& random) {
    for (SphereSet Table::*set : {&Table::a, &Table::b})
        for (double factor : {1 - 0x1p-52, 1 + 0x1p-52, 0.99, 1.01}) {
            Exhibit x = good;
            SphereSet& spheres = x.table.*set;
            spheres[std::size_t(random.below(int(spheres.size())))].radius *= factor;
            forbidden(counts, "a radius changed, from its last bit on", x);
        }
    Exhibit x = good;
    double& coordinate = x.table.b[std::size_t(random.below(int(x.table.b.size())))].centre.y();
    coordinate = std::nextafter(coordinate, 10);
    forbidden(counts, "a centre moved in its last bit", x);
}

/// With a tolerance radii may differ by less than it: only what goes beyond the bound is a damage.
void changeRadiiBeyond(Counts& counts, const scenes::Scene& scene, std::uint64_t seed) {
    constexpr double epsilon = 0.004;
    Exhibit good{scene.a, scene.b, baked(scene, epsilon), scene.motion};
    if (good.table.testCount() < 2) return;
    CHECK(judge(good).proven);
    for (std::size_t k = 0; k < good.table.a.size(); ++k)
        for (double change : {-epsilon / 2, -1.001 * epsilon, -2 * epsilon}) {
            Exhibit x = good;
            x.table.a[k].radius += change;
            if (x.table.a[k].radius > 0) harmful(counts, "a radius less than the tolerance allows", x, seed);
        }
    for (std::size_t k = 0; k < good.table.b.size(); ++k) {
        Exhibit x = good;
        x.table.b[k].radius += 1.0001 * epsilon;
        const Sphere grown = x.table.b[k];
        // Unless it still lies inside some sphere of the set grown by the tolerance, where nothing is early.
        if (std::any_of(x.b.begin(), x.b.end(), [&](const Sphere& s) {
                return (s.centre - grown.centre).norm() + grown.radius <= s.radius + epsilon;
            }))
            continue;
        forbidden(counts, "a radius more than the tolerance allows", x);
    }
}

void widenLimits(Counts& counts, const Exhibit& good, std::uint64_t seed) {
    for (std::size_t k = 0; k < good.motion.dofCount(); ++k) {
        Exhibit x = good;
        Dof& dof = x.motion.dofs[k];
        if (dof.kind == DofKind::Path) dof.path.back().value += 1;
        dof.upper = std::nextafter(dof.upper, 100);
        forbidden(counts, "a limit widened by one bit", x);
        if (dof.kind == DofKind::Path) continue;
        x = good;
        x.motion.dofs[k].lower = std::nextafter(x.motion.dofs[k].lower, -100);
        forbidden(counts, "a limit widened by one bit", x);
        x = good;
        x.motion.dofs[k].lower -= 0.5;
        x.motion.dofs[k].upper += 0.5;
        x.table.motion = x.motion;
        harmful(counts, "a limit widened in the motion and in the table", x, seed);
    }
}

/// Tilts or moves one thing about a DOF.
std::vector<std::function<void(Dof&)>> axisDamages(const Dof& dof, double size) {
    if (dof.kind == DofKind::Path)
        return {[size](Dof& d) { d.path[1].translation.x() += size; },
                [size](Dof& d) {
                    d.path[1].rotation =
                        Eigen::Quaterniond(Eigen::AngleAxisd(size, Vec3::UnitY())) * d.path[1].rotation;
                },
                [size](Dof& d) { d.frame.translation().z() += size; }};
    std::vector<std::function<void(Dof&)>> damages{[size](Dof& d) {
        const double length = d.axis.norm();
        d.axis = (d.axis + size * d.axis.unitOrthogonal()).normalized() * length;
    }};
    if (dof.kind == DofKind::Rotation) damages.push_back([size](Dof& d) { d.origin.x() += size; });
    return damages;
}

void moveAxes(Counts& counts, const Exhibit& good, std::uint64_t seed) {
    for (std::size_t k = 0; k < good.motion.dofCount(); ++k) {
        const std::size_t kinds = axisDamages(good.motion.dofs[k], 0).size();
        for (std::size_t n = 0; n < kinds; ++n) {
            Exhibit x = good;
            axisDamages(x.motion.dofs[k], 1e-12)[n](x.motion.dofs[k]);
            forbidden(counts, "an axis moved by 1e-12", x);
            x = good;
            axisDamages(x.motion.dofs[k], 0.2)[n](x.motion.dofs[k]);
            x.table.motion = x.motion;
            harmful(counts, "an axis moved in the motion and in the table", x, seed);
        }
    }
    Exhibit x = good;
    x.motion.base.translation().z() += 1e-12;
    forbidden(counts, "the moving body placed elsewhere by 1e-12", x);
}

void loosenPlanes(Counts& counts, scenes::Scene scene, std::uint64_t seed) {
    if (scene.motion.dofCount() < 2) return;
    scenes::Random random(seed);
    LimitPlane plane{std::vector<double>(scene.motion.dofCount(), 0.0), 0.05};
    for (double& c : plane.coefficients) c = random.in(-1, 1);
    scene.motion.planes = {plane};
    const Exhibit good{scene.a, scene.b, baked(scene), scene.motion};
    CHECK(judge(good).proven);
    Exhibit x = good;
    x.motion.planes[0].bound = std::nextafter(plane.bound, 1);
    forbidden(counts, "a coupling of limits loosened by one bit", x);
    x.motion.planes.clear();
    forbidden(counts, "a coupling of limits removed", x);
    x.table.motion = x.motion;
    harmful(counts, "a coupling removed in the motion and in the table", x, seed);
}

void claimTooMuch(Counts& counts, const scenes::Scene& scene, std::uint64_t seed) {
    const Exhibit good{scene.a, scene.b, baked(scene, 0.02, 0.05, 0.02), scene.motion};
    CHECK(judge(good).proven);
    Exhibit x = good;
    x.table.epsilon = 0.0005;
    harmful(counts, "a smaller epsilon claimed", x, seed);
    x = good;
    x.table.gapDepth = 0.3;
    harmful(counts, "a larger depth claimed", x, seed);
    x = good;
    x.table.gapMargin = 0.5;
    harmful(counts, "a larger margin claimed", x, seed);
}

void changeRestGaps(Counts& counts, scenes::Scene scene, std::uint64_t seed) {
    scene.motion.base.translation() *= 0.8; // they overlap at rest
    const Table table = baked(scene, 0, 0, 0, AtRest::Offset);
    if (table.restGaps.empty()) return;
    const Exhibit good{scene.a, scene.b, table, scene.motion};
    const auto refused = [&](const Exhibit& x) {
        return !verifyTable(x.a, x.b, x.table, x.motion, offset(scene)).proven;
    };
    INFO("rest gaps, seed " << seed);
    CHECK_FALSE(refused(good));
    for (std::size_t k = 0; k < table.testCount(); ++k) {
        if (table.restGaps[k] >= 0) continue;
        Exhibit x = good;
        x.table.restGaps[k] *= 0.99;
        Count& count = counts["a test that overlaps at rest reports earlier"];
        ++count.tried;
        count.caught += refused(x);
        CHECK(refused(x));
    }
}

void report(const Counts& counts, int scenes) {
    for (const auto& [kind, count] : counts) {
        WARN(scenes << " scenes: " << kind << ": " << count.caught << " of " << count.tried << " caught"
                    << (count.harmless ? ", " + std::to_string(count.harmless) + " harmless" : ""));
        CHECK(count.caught == count.tried);
        CHECK(count.tried >= 5);
    }
    CHECK(counts.size() == 18);
}

void mutateScenes(int scenes) {
    Counts counts;
    int done = 0;
    for (std::uint64_t seed = 1; done < scenes && seed < 1000; ++seed) {
        const auto scene = scenes::randomScene(seed, 1 + int(seed % 3), 30, seed % 4 == 0);
        const Exhibit good{scene.a, scene.b, baked(scene), scene.motion};
        if (good.table.testCount() < 2) continue;
        CAPTURE(seed);
        REQUIRE(judge(good).proven);
        scenes::Random random(seed);
        removePairs(counts, good, seed);
        changeRadii(counts, good, random);
        changeRadiiBeyond(counts, scene, seed);
        widenLimits(counts, good, seed);
        moveAxes(counts, good, seed);
        loosenPlanes(counts, scene, seed);
        claimTooMuch(counts, scene, seed);
        changeRestGaps(counts, scene, seed);
        ++done;
    }
    CHECK(done == scenes);
    report(counts, done);
}

} // namespace

TEST_CASE("every damage that matters is caught, on 24 scenes") {
    mutateScenes(24);
}
