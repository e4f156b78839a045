#include "bake/verify/Verify.h"
#include "bake/base/Parallel.h"
#include "bake/search/CertifiedSearch.h"
#include "bake/table/Query.h"
#include "tests/verify/Baked.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;

namespace {

/// What the result says really holds at the pose it gives.
void checkWitness(const scenes::Scene& scene, const Table& table, const VerifyResult& result) {
    if (result.pose.empty()) return;
    CHECK(withinLimits(scene.motion, result.pose));
    const double models = queryAllPairs(scene.a, scene.b, pose(scene.motion, result.pose)).gap;
    CHECK(models <= table.gapMargin + 1e-9);
    CHECK(query(table, result.pose).gap > std::max(models, -table.gapDepth) + table.epsilon);
}

/// A scene whose bodies meet, so that its table has tests to damage. Seeds that do not meet are skipped.
template <typename Body>
int forScenesThatMeet(int count, Body body) {
    int done = 0;
    for (std::uint64_t seed = 1; done < count && seed < 200; ++seed) {
        const int dofs = 1 + int(seed % 3);
        const auto scene = scenes::randomScene(seed, dofs, 30, seed % 4 == 0);
        const Table table = baked(scene);
        if (table.testCount() < 2) continue;
        INFO("seed " << seed);
        body(scene, table, seed);
        ++done;
    }
    return done;
}

} // namespace

TEST_CASE("certified tables of random scenes are proven again") {
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        INFO("seed " << seed);
        const int dofs = 1 + int(seed % 4);
        const auto scene = scenes::randomScene(seed, dofs, dofs < 4 ? 40 : 12, seed % 3 == 0);
        const auto lossless = verifyTable(scene.a, scene.b, baked(scene), scene.motion, colliding());
        INFO(lossless.reason);
        CHECK(lossless.proven);
        if (dofs == 4) continue;
        for (const Table& table : {baked(scene, 0.01), baked(scene, 0.01, 0.1, 0.05)}) {
            const auto result = verifyTable(scene.a, scene.b, table, scene.motion, colliding());
            INFO(result.reason);
            CHECK(result.proven);
        }
    }
}

TEST_CASE("a jaw-like table is proven again") {
    const auto scene = scenes::jawLike(1158, 812);
    const auto result = verifyTable(scene.a, scene.b, baked(scene), scene.motion, colliding());
    INFO(result.reason);
    CHECK(result.proven);
    const auto gapTrue = verifyTable(scene.a, scene.b, baked(scene, 0.001, 1), scene.motion, colliding());
    INFO(gapTrue.reason);
    CHECK(gapTrue.proven);
}

TEST_CASE("a table from which a needed pair was removed is refused with a pose that shows it") {
    int needed = 0;
    CHECK(forScenesThatMeet(20, [&](const auto& scene, const Table& table, std::uint64_t) {
              int caught = 0;
              for (std::size_t k = 0; k < table.testCount(); ++k) {
                  const Table less = without(table, k);
                  const auto result = verifyTable(scene.a, scene.b, less, scene.motion, colliding());
                  if (result.proven) { // then no pose may miss it
                      scenes::Random random(k);
                      for (int n = 0; n < 500; ++n) {
                          const auto q = scenes::randomPose(random, scene.motion);
                          if (query(table, q).hit()) CHECK(query(less, q).gap <= result.band);
                      }
                      continue;
                  }
                  ++caught;
                  checkWitness(scene, less, result);
              }
              CHECK(caught >= int(table.testCount()) - 1);
              needed += caught;
          }) == 20);
    CHECK(needed > 60);
}

TEST_CASE("a changed radius is caught, larger or smaller, down to the last bit") {
    CHECK(forScenesThatMeet(20, [&](const auto& scene, const Table& table, std::uint64_t seed) {
              scenes::Random random(seed);
              for (double factor : {0.9, 1.1, 1 - 0x1p-52, 1 + 0x1p-52}) {
                  Table changed = table;
                  auto& set = random.below(2) ? changed.a : changed.b;
                  set[std::size_t(random.below(int(set.size())))].radius *= factor;
                  CHECK_FALSE(verifyTable(scene.a, scene.b, changed, scene.motion, colliding()).proven);
              }
              Table moved = table;
              moved.b[0].centre.x() += 1e-12;
              CHECK_FALSE(verifyTable(scene.a, scene.b, moved, scene.motion, colliding()).proven);
          }) == 20);
}

TEST_CASE("with a tolerance, a radius changed beyond it is caught") {
    int done = 0;
    for (std::uint64_t seed = 1; done < 20 && seed < 200; ++seed) {
        const auto scene = scenes::randomScene(seed, 1 + int(seed % 2), 30);
        const Table table = baked(scene, 0.002);
        if (table.testCount() < 3) continue;
        INFO("seed " << seed);
        Table smaller = table, larger = table;
        for (Sphere& s : smaller.a) s.radius -= 0.01;
        larger.b[0].radius += 0.0021;
        const auto result = verifyTable(scene.a, scene.b, smaller, scene.motion, colliding());
        CHECK_FALSE(result.proven);
        checkWitness(scene, smaller, result);
        const double inside = 0.0021; // unless the larger sphere still lies inside another of the set
        bool hidden = false;
        for (const Sphere& s : scene.b)
            hidden |= (s.centre - table.b[0].centre).norm() + table.b[0].radius + inside <=
                      s.radius + table.epsilon;
        if (!hidden) CHECK_FALSE(verifyTable(scene.a, scene.b, larger, scene.motion, colliding()).proven);
        ++done;
    }
    CHECK(done == 20);
}

TEST_CASE("widened limits and a moved axis are caught") {
    CHECK(forScenesThatMeet(20, [&](const auto& scene, const Table& table, std::uint64_t seed) {
              scenes::Random random(seed);
              const auto k = std::size_t(random.below(int(scene.motion.dofCount())));
              Motion wider = scene.motion;
              wider.dofs[k].upper = std::nextafter(wider.dofs[k].upper, 10);
              if (wider.dofs[k].kind == DofKind::Path) wider.dofs[k].path.back().value += 1;
              CHECK_FALSE(verifyTable(scene.a, scene.b, table, wider, colliding()).proven);
              Motion narrower = scene.motion;
              narrower.dofs[k].upper -= 0.01 * (narrower.dofs[k].upper - narrower.dofs[k].lower);
              narrower.dofs[k].rest = std::min(narrower.dofs[k].rest, narrower.dofs[k].upper);
              CHECK(verifyTable(scene.a, scene.b, table, narrower, colliding()).proven);
              Motion moved = scene.motion;
              if (moved.dofs[k].kind == DofKind::Path)
                  moved.dofs[k].path[1].translation.x() += 1e-9;
              else
                  moved.dofs[k].axis = Vec3(moved.dofs[k].axis + Vec3(1e-9, 2e-9, 3e-9)) *
                                       (moved.dofs[k].kind == DofKind::Rotation
                                            ? 1 / (moved.dofs[k].axis + Vec3(1e-9, 2e-9, 3e-9)).norm()
                                            : 1);
              CHECK_FALSE(verifyTable(scene.a, scene.b, table, moved, colliding()).proven);
              Motion placed = scene.motion;
              placed.base.translation().z() += 1e-9;
              CHECK_FALSE(verifyTable(scene.a, scene.b, table, placed, colliding()).proven);
          }) == 20);
}

TEST_CASE("damage to both the motion and the table's copy of it is caught by the geometry") {
    // Consistent files with other limits or another axis: nothing but the poses themselves can tell.
    int caught = 0, tried = 0;
    forScenesThatMeet(20, [&](const auto& scene, const Table& table, std::uint64_t) {
        for (std::size_t k = 0; k < scene.motion.dofCount(); ++k) {
            if (scene.motion.dofs[k].kind == DofKind::Path) continue;
            auto changed = scene;
            changed.motion.dofs[k].lower -= 0.5;
            changed.motion.dofs[k].upper += 0.5;
            Table same = table;
            same.motion = changed.motion;
            const auto result = verifyTable(scene.a, scene.b, same, changed.motion, colliding());
            ++tried;
            caught += !result.proven;
            if (!result.proven) checkWitness(changed, same, result);
        }
    });
    CHECK(caught > tried / 2);
}

TEST_CASE("limit planes must not be loosened") {
    auto scene = scenes::randomScene(6, 2, 40);
    scene.motion.planes = {{{1, 0.7}, 0.05}};
    const Table table = baked(scene);
    CHECK(verifyTable(scene.a, scene.b, table, scene.motion, colliding()).proven);
    Motion loose = scene.motion;
    loose.planes[0].bound += 1e-12;
    CHECK_FALSE(verifyTable(scene.a, scene.b, table, loose, colliding()).proven);
    loose.planes.clear();
    CHECK_FALSE(verifyTable(scene.a, scene.b, table, loose, colliding()).proven);
}

TEST_CASE("a claimed tolerance smaller than the true one is caught") {
    int caught = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        INFO("seed " << seed);
        const auto scene = scenes::randomScene(seed, 2, 40);
        Table table = baked(scene, 0.05);
        if (table.testCount() < 2) continue;
        table.epsilon = 0.0001;
        const auto result = verifyTable(scene.a, scene.b, table, scene.motion, colliding());
        caught += !result.proven;
        if (!result.proven) checkWitness(scene, table, result);
    }
    CHECK(caught > 6);
}

TEST_CASE("rest gaps are checked both ways") {
    auto scene = scenes::randomScene(3, 2, 25);
    scene.motion.base.translation() *= 0.7;
    const Table table = baked(scene, 0, 0, 0, AtRest::Offset);
    REQUIRE(!table.restGaps.empty());
    const VerifyOptions offset = ::offset(scene);
    const auto result = verifyTable(scene.a, scene.b, table, scene.motion, offset);
    INFO(result.reason);
    CHECK(result.proven);
    const auto k = std::size_t(
        std::find_if(table.restGaps.begin(), table.restGaps.end(), [](double g) { return g < 0; }) -
        table.restGaps.begin());
    Table early = table, late = table;
    early.restGaps[k] *= 0.5;
    for (double& g : late.restGaps) g -= 0.05;
    CHECK_FALSE(verifyTable(scene.a, scene.b, early, scene.motion, offset).proven);
    CHECK_FALSE(verifyTable(scene.a, scene.b, late, scene.motion, offset).proven);
    CHECK_FALSE(verifyTable(scene.a, scene.b, table, scene.motion, colliding()).proven);
}

TEST_CASE("the verdict is the same with one thread and with two") {
    const auto scene = scenes::jawLike(300, 300);
    const Table table = baked(scene);
    const Table less = without(table, table.testCount() / 2);
    for (const Table& t : {table, less}) {
        const auto two = verifyTable(scene.a, scene.b, t, scene.motion, colliding());
        const ThreadLimit one(1);
        const auto single = verifyTable(scene.a, scene.b, t, scene.motion, colliding());
        CHECK(two.proven == single.proven);
        CHECK(two.pose == single.pose);
        CHECK(two.cells == single.cells);
    }
}

TEST_CASE("nothing is proven about what was stopped, and empty sets need no table") {
    const auto scene = scenes::jawLike(200, 200);
    const Table table = baked(scene);
    CHECK_FALSE(verifyTable(scene.a, scene.b, table, scene.motion, colliding(), [](std::string_view, double) {
                    return false;
                }).proven);
    Table empty;
    empty.motion = scene.motion;
    CHECK(verifyTable({}, scene.b, empty, scene.motion, colliding()).proven);
    CHECK_FALSE(verifyTable(scene.a, scene.b, empty, scene.motion, colliding()).proven);
}
