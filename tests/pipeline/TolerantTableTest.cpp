#include "bake/motion/WholeTurn.h"
#include "bake/pipeline/Bake.h"
#include "bake/pipeline/BakePair.h"
#include "bake/pipeline/RestRule.h"
#include "bake/search/NodePairs.h"
#include "bake/table/Query.h"
#include "bake/verify/MeshVerify.h"
#include "bake/verify/Verify.h"
#include "tests/GroundTruth.h"
#include "tests/Shapes.h"
#include "tests/pipeline/LumpyPair.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

TEST_CASE("a table with a tolerance misses no contact: it reports by as much earlier") {
    int missedInAll = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        CAPTURE(seed);
        const Motion motion = swing();
        const SceneModel scene = lumpyPair(seed);
        BakeOptions options;
        options.tolerance = 0.05;
        options.epsilon = 0.05;
        options.atRest = AtRest::Collide;
        const PairSpheres spheres = fillPair(scene, scene.pairs[0], motion, options);
        PairReport report;
        const PairTable made = tabulatePair(spheres, motion, options, report);
        REQUIRE(made.table);
        const Table& table = *made.table;
        REQUIRE(table.epsilon > 0);
        CHECK(table.boundMiss == 0);
        CHECK(table.boundEarly <= 2 * 0.05 + table.epsilon + 1e-6);
        const SphereTree a(spheres.a.spheres), b(spheres.b.spheres);
        Table late = table;
        late.restGaps.clear();
        int touching = 0, missed = 0, lateMissed = 0;
        double farthest = 0;
        random_table::Random random(seed);
        for (int i = 0; i < 2000; ++i) {
            const std::vector<double> q = random_table::values(random, motion);
            const double gap = smallestGap(a, b, pose(motion, q), 10);
            const bool hit = query(table, q).hit();
            touching += gap <= 0;
            missed += gap <= 0 && !hit;
            lateMissed += gap <= 0 && !query(late, q).hit();
            if (hit) farthest = std::max(farthest, gap);
        }
        CHECK(touching > 100);
        CHECK(missed == 0);
        CHECK(farthest <= table.epsilon * (1 + 1e-9));
        const VerifyOptions asked;
        CHECK(verifyTable(spheres.a.spheres, spheres.b.spheres, table, motion, asked).reason.empty());
        CHECK(verifyOnMeshes(scene.bodies[0].mesh, scene.bodies[1].mesh, table, motion).reason.empty());
        missedInAll += lateMissed;
    }
    // The tolerance was used: without what the thresholds carry contact would have been missed.
    CHECK(missedInAll > 0);
}

TEST_CASE("with a tolerance, bodies that overlap at rest are free there and nothing else is missed") {
    int touching = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        CAPTURE(seed);
        SceneModel scene = lumpyPair(seed);
        scene.bodies[1].mesh =
            transformed(scene.bodies[1].mesh, Eigen::Affine3d(Eigen::Translation3d(-1, 0, 0)));
        const Motion motion = swing();
        BakeOptions options;
        options.tolerance = options.epsilon = 0.05;
        const PairSpheres spheres = fillPair(scene, scene.pairs[0], motion, options);
        const RuleAtRest ruled = ruleAtRest(spheres, motion, options);
        REQUIRE_FALSE(ruled.rule.empty());
        REQUIRE_FALSE(ruled.region.empty());
        PairReport report;
        const Table table = *tabulatePair(spheres, motion, options, report).table;
        CHECK(table.boundMiss == 0);
        CHECK(table.restRegion.depth == ruled.region.depth);
        CHECK_FALSE(query(table, restValues(motion)).hit());
        random_table::Random random(seed);
        const SphereTree a(spheres.a.spheres), b(spheres.b.spheres);
        for (int i = 0; i < 500; ++i) {
            const std::vector<double> q = random_table::values(random, motion);
            bool touches = false;
            visitPairsWithin(a, b, pose(motion, q), 0, [&](std::uint32_t j, std::uint32_t k, double gap) {
                touches |= ruled.rule.touches({j, k}, gap);
            });
            if (touches) CHECK(query(table, q).hit());
            touching += touches;
        }
        VerifyOptions how;
        how.regionA = ruled.rule.regionA();
        how.regionB = ruled.rule.regionB();
        how.depth = ruled.region.depth;
        CHECK(verifyTable(spheres.a.spheres, spheres.b.spheres, table, motion, how).reason.empty());
    }
    CHECK(touching > 100);
}

TEST_CASE("a budget that ends costs tests and not epsilon: all pairs that may meet are asked") {
    const bool coarser = GENERATE(false, true); // all pairs of these spheres are too many
    enum Limit { Seconds, Work, Until };
    const Limit by = GENERATE(Seconds, Work, Until);
    SceneModel scene = lumpyPair(2);
    BakeOptions options;
    options.tolerance = 0.02;
    if (coarser) options.mostTests = 3000;
    options.atRest = AtRest::Collide;
    if (by == Work) options.mostLooks = 1000;
    if (by == Seconds) options.budget = 1e-9;
    if (by == Until) options.until = Deadline(1e-9);
    const Motion motion = swing();
    const PairSpheres few = fillPair(scene, scene.pairs[0], motion, options);
    CHECK(canTestAll(few, options) == !coarser);
    PairReport report;
    bakePair(scene, scene.pairs[0], options, report, {});
    REQUIRE(scene.pairs[0].table);
    const Table& table = *scene.pairs[0].table;
    CHECK(table.epsilon == 0);
    CHECK(table.boundMiss == 0);
    CHECK(table.boundEarly < 0.3);
    CHECK(table.testCount() > 100);
    CHECK(table.testCount() <= options.mostTests);
    const bool said = std::any_of(report.notes.begin(), report.notes.end(), [&](const std::string& note) {
        return note.find(by == Work ? "1 degree of freedom: all " : "in the budget: all ") !=
               std::string::npos;
    });
    CHECK(said);
    const GroundTruth truth(scene.bodies[0].mesh, scene.bodies[1].mesh);
    int touching = 0, missed = 0;
    random_table::Random random(7);
    for (int i = 0; i < 2000; ++i) {
        const std::vector<double> q = random_table::values(random, motion);
        const bool touch = truth.touches(pose(motion, q));
        touching += touch;
        missed += touch && !query(table, q).hit();
    }
    CHECK(touching > 100);
    CHECK(missed == 0);
    CHECK(verifyOnMeshes(scene.bodies[0].mesh, scene.bodies[1].mesh, table, motion).reason.empty());
}

TEST_CASE("a search that ended by its work goes on to its own end where all pairs are too many to be asked") {
    const auto tests = [](std::uint64_t mostLooks) {
        SceneModel scene = lumpyPair(2);
        BakeOptions options;
        options.tolerance = 0.05;
        options.atRest = AtRest::Collide;
        options.mostTests = 1;
        options.mostLooks = mostLooks;
        PairReport report;
        bakePair(scene, scene.pairs[0], options, report, {});
        REQUIRE(scene.pairs[0].table);
        CHECK(scene.pairs[0].table->epsilon == 0);
        return tss::tests(*scene.pairs[0].table);
    };
    CHECK(tests(1000) == tests(BakeOptions().mostLooks));
}

TEST_CASE(
    "over four degrees of freedom the fewest tests are searched for, and where that ends all are asked") {
    SceneModel scene = lumpyPair(2);
    Motion motion = swing();
    while (motion.dofs.size() < 4) {
        Dof dof = motion.dofs[0];
        dof.axis = Vec3::Unit(static_cast<Eigen::Index>(motion.dofs.size() % 3));
        dof.lower = -0.02;
        dof.upper = 0.02;
        dof.rest = 0;
        motion.dofs.push_back(dof);
    }
    BakeOptions options;
    options.tolerance = 0.05;
    options.atRest = AtRest::Collide;
    const PairSpheres spheres = fillPair(scene, scene.pairs[0], motion, options);
    CHECK(spheres.testAll);
    const auto tabulated = [&](bool allAsked) {
        PairReport report;
        const PairTable made = tabulatePair(spheres, motion, options, report, {});
        REQUIRE(made.table);
        CHECK(made.table->epsilon == 0);
        CHECK(made.table->boundMiss == 0);
        CHECK(made.table->boundEarly);
        const bool said = std::any_of(report.notes.begin(), report.notes.end(), [](const std::string& note) {
            return note.find("--budget 0") != std::string::npos;
        });
        CHECK(said == allAsked);
        CHECK((made.table->record.lowerBound == 0) == allAsked);
        CHECK(verifyOnMeshes(scene.bodies[0].mesh, scene.bodies[1].mesh, *made.table, motion).reason.empty());
        return made.table->testCount();
    };
    const std::size_t few = tabulated(false);
    options.budget = 1e-9;
    CHECK(tabulated(true) > 2 * few);
    options.budget.reset();
    options.mostLooks = 1000;
    CHECK(tabulated(true) > 2 * few);
    options.depth = 0.05; // a table that states a gap as well
    CHECK(tabulated(true) > 2 * few);
    options.depth = 0;
    options.budget = 0;
    CHECK_FALSE(fillPair(scene, scene.pairs[0], motion, options).testAll);
}

TEST_CASE(
    "over four degrees of freedom a tolerance far too fine becomes the finest of which all pairs can be "
    "asked") {
    SceneModel scene = lumpyPair(2);
    while (scene.joints[0].dofs.size() < 4) {
        const auto k = static_cast<Eigen::Index>(scene.joints[0].dofs.size());
        scene.joints[0].dofs.push_back(joints::turn({0, 0, 0}, Vec3::Unit(k % 3), -0.02, 0.02));
    }
    scene.joints[0].drives.resize(4);
    BakeOptions options;
    options.tolerance = 1e-5; // of which one body alone would take more patches than are made
    options.atRest = AtRest::Collide;
    setOption(options, "max-tests", "20000", 1);
    CHECK_THROWS_AS(setOption(options, "max-tests", "0", 1), InputError);
    REQUIRE(options.mostTests == 20'000);
    const Motion motion = pairMotion(scene, scene.pairs[0]);
    const PairSpheres spheres = fillPair(scene, scene.pairs[0], motion, options);
    const std::size_t pairs = spheres.a.spheres.size() * spheres.b.spheres.size();
    CHECK(spheres.testAll);
    CHECK(pairs <= options.mostTests);
    CHECK(pairs > options.mostTests / 3);
    CHECK(spheres.a.note.find("instead of 1e-05 scene units") != std::string::npos);
}

TEST_CASE("over four degrees of freedom bodies that never meet are proven apart, by coarser spheres than "
          "asked for") {
    SceneModel scene = lumpyPair(2);
    scene.bodies[1].mesh =
        transformed(scene.bodies[1].mesh, Eigen::Affine3d(Eigen::Translation3d(-2.1, 0, 11.4)));
    scene.joints[0].dofs = {
        joints::turn({0, 0, 0}, {0, 0, 1}, -0.8, 0.8), joints::turn({0, 0, 3}, {0, 1, 0}, -1.7, 1.7),
        joints::turn({0, 0, 3}, {0, 0, 1}, -0.8, 0.8), joints::turn({0.5, 0, 10.5}, {0, 1, 0}, -2.5, 0)};
    BakeOptions options;
    options.tolerance = 0.01;
    PairReport report;
    bakePair(scene, scene.pairs[0], options, report, {});
    CHECK_FALSE(scene.pairs[0].table);
    REQUIRE(scene.pairs[0].proof);
    CHECK(scene.pairs[0].proof->clearance > 0.05);
    const Motion motion = pairMotion(scene, scene.pairs[0]);
    CHECK(verifyOnMeshes(scene.bodies[0].mesh, scene.bodies[1].mesh, *scene.pairs[0].proof, motion)
              .reason.empty());
}

TEST_CASE("a joint that turns twice round has the table of one that turns once, and its own limits") {
    constexpr double pi = std::numbers::pi;
    const auto baked = [](double lower, double upper) {
        SceneModel scene = lumpyPair(3);
        scene.joints[0].dofs = {joints::turn({0, 0, 0}, {0, 0, 1}, lower, upper)};
        BakeOptions options;
        options.tolerance = 0.05;
        options.atRest = AtRest::Collide;
        PairReport report;
        bakePair(scene, scene.pairs[0], options, report, {});
        REQUIRE(scene.pairs[0].table);
        CHECK(scene.pairs[0].table->motion.dofs[0].lower == lower);
        CHECK(scene.pairs[0].table->motion.dofs[0].upper == upper);
        const Motion motion = onceRound(pairMotion(scene, scene.pairs[0]));
        CHECK(verifyOnMeshes(scene.bodies[0].mesh, scene.bodies[1].mesh, *scene.pairs[0].table, motion)
                  .reason.empty());
        return *scene.pairs[0].table;
    };
    const double turn = (1 + 1e-9) * 2 * pi;
    const Table once = baked(-turn / 2, turn / 2), twice = baked(-2 * pi, 2 * pi);
    CHECK(tests(twice) == tests(once));
    random_table::Random random(5);
    for (int i = 0; i < 1000; ++i) {
        std::vector<double> q = random_table::values(random, once.motion);
        const bool hit = query(once, q).hit();
        q[0] += q[0] < 0 ? 2 * pi : -2 * pi;
        CHECK(query(twice, q).hit() == hit);
    }
}

TEST_CASE("a joint that turns twice round takes the proof of one that turns once") {
    constexpr double turn = (1 + 1e-9) * 2 * std::numbers::pi;
    const auto cells = [](double lower, double upper) {
        SceneModel scene = lumpyPair(3);
        scene.bodies[1].mesh =
            transformed(scene.bodies[1].mesh, Eigen::Affine3d(Eigen::Translation3d(1, 0, 0)));
        scene.joints[0].dofs = {joints::turn({-1.3, -3, 0}, {0, 0, 1}, lower, upper)};
        PairReport report;
        bakePair(scene, scene.pairs[0], {}, report, {});
        REQUIRE(scene.pairs[0].proof);
        return scene.pairs[0].proof->cells;
    };
    CHECK(cells(-turn, turn) == cells(-turn / 2, turn / 2));
}

TEST_CASE("a budget that ends puts no bodies into contact at rest, nor states fewest tests") {
    // Apart at rest, and overlapping there.
    for (const double shift : {0.4, -0.5}) {
        CAPTURE(shift);
        int ended = 0, coarser = 0;
        for (const double budget : {1e-4, 0.003, 0.01, 0.03, 0.1}) {
            CAPTURE(budget);
            SceneModel scene = lumpyPair(2);
            scene.bodies[1].mesh =
                transformed(scene.bodies[1].mesh, Eigen::Affine3d(Eigen::Translation3d(shift, 0, 0)));
            BakeOptions options;
            options.tolerance = 0.03;
            options.depth = 0.01;
            options.mostTests = 1; // asking all is no way out
            options.budget = budget;
            Motion motion = swing();
            motion.dofs.push_back(joints::turn(Vec3(0, 0, 2), Vec3::UnitY(), -0.5, 0.5));
            PairReport report;
            const PairSpheres spheres = fillPair(scene, scene.pairs[0], motion, options);
            REQUIRE((spheres.clearanceAtRest > 0) == (shift > 0));
            try {
                const PairTable made = tabulatePair(spheres, motion, options, report);
                if (!made.table) continue;
                CHECK_FALSE(query(*made.table, restValues(motion)).hit());
                if (made.table->epsilon > 0) CHECK(made.table->record.lowerBound == 0);
                coarser += made.table->epsilon > 0;
            } catch (const InputError& error) {
                ended += std::string(error.what()).find("the budget ended") != std::string::npos;
            }
        }
        CAPTURE(coarser);
        CHECK(ended > 0);
    }
}

TEST_CASE("a path whose values are as far from 0 as doubles tell them apart comes to a table") {
    SceneModel scene = lumpyPair(2);
    Dof dof;
    dof.kind = DofKind::Path;
    for (int k = 0; k <= 2; ++k)
        dof.path.push_back({1e14 + 5 * k, Vec3(-1.3 * k, std::sin(2 * k), 2.2 - 0.5 * k),
                            Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * k, Vec3::UnitX()))});
    dof.lower = dof.rest = 1e14;
    dof.upper = 1e14 + 10;
    Motion motion;
    motion.dofs = {dof};
    BakeOptions options;
    options.tolerance = 0.005;
    options.atRest = AtRest::Collide;
    PairReport report;
    const PairSpheres spheres = fillPair(scene, scene.pairs[0], motion, options);
    const PairTable made = tabulatePair(spheres, motion, options, report);
    REQUIRE(made.table);
    const GroundTruth truth(scene.bodies[0].mesh, scene.bodies[1].mesh);
    int touching = 0, missed = 0;
    random_table::Random random(7);
    for (int i = 0; i < 500; ++i) {
        const std::vector<double> q = random_table::values(random, motion);
        const bool touch = truth.touches(pose(motion, q));
        touching += touch;
        missed += touch && !query(*made.table, q).hit();
    }
    CHECK(touching > 10);
    CHECK(missed == 0);
}

TEST_CASE("spheres that bodies near each other at rest take are not made coarser for nothing") {
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "Scene";
    for (const double x : {0.0, 1.01}) {
        Body body;
        body.path = x > 0 ? "/Scene/B" : "/Scene/A";
        body.mesh = boxMesh(Vec3(x, 0, 0), Vec3(x + 1, 1, 1));
        scene.bodies.push_back(body);
    }
    Motion motion;
    motion.dofs = {joints::turn({1, 0, 0}, {0, 0, 1}, -0.5, 0.5)};
    addPair(scene, 0, 1, motion, "Hinge");
    BakeOptions options;
    options.tolerance = 0.1;
    options.mostTests = 100;
    const PairSpheres spheres = fillToTestAll(scene, scene.pairs[0], motion, options);
    CHECK_FALSE(spheres.testAll);
    CHECK(spheres.a.spheres.size() > 100); // which their distance takes, whatever the tolerance
    CHECK(spheres.protrusions < 1);
}
