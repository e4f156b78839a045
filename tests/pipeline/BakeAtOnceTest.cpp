// Several pairs in work at once: the same tables, told in order.
#include "bake/pipeline/Bake.h"

#include "bake/base/Parallel.h"
#include "bake/model/AddPair.h"
#include "tests/Joints.h"
#include "tests/Shapes.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <tbb/global_control.h>

using namespace tss;

namespace {

/// A row of balls about a box, each on a hinge of its own; the first takes longest.
SceneModel ballsAboutBox(int count) {
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "Row";
    const auto addBody = [&](const std::string& name, TriangleMesh mesh) {
        Body body;
        body.path = "/Row/" + name;
        body.mesh = std::move(mesh);
        scene.bodies.push_back(std::move(body));
    };
    addBody("Box", boxMesh({-1, -1, -1}, {1, 1, 1}));
    for (int k = 0; k < count; ++k) {
        addBody("Ball" + std::to_string(k), ballMesh({1.8 + 0.1 * k, 0, 0}, 0.5, 2));
        Motion motion;
        motion.dofs = {joints::turn({1.5, 1.5 + 0.1 * k, 0}, {0, 0, 1}, -1.2, 0.3)};
        addPair(scene, 0, k + 1, motion, "Hinge" + std::to_string(k));
        scene.pairs.back().settings["tolerance"] = k == 0 ? "0.02" : "0.1";
    }
    return scene;
}

} // namespace

TEST_CASE("pairs that are baked at once have the tables that each has alone, and are told in their order") {
    const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
    SceneModel many = ballsAboutBox(6), alone = many;
    BakeRequest request;
    std::vector<std::string> told;
    std::atomic<int> calling = 0;
    bool together = false;
    request.done = [&](const PairReport& report) { told.push_back(report.path); };
    const auto reports = bake(many, request, [&](std::string_view, double) {
        together = together || ++calling > 1;
        --calling;
        return true;
    });
    CHECK(told == pathsToBake(many, {}));
    REQUIRE(reports.size() == told.size());
    for (std::size_t k = 0; k < told.size(); ++k) CHECK(reports[k].path == told[k]);
    CHECK_FALSE(together);
    for (const std::string& path : pathsToBake(alone, {})) {
        BakeRequest one;
        one.pairs = {path};
        bake(alone, one);
    }
    for (std::size_t k = 0; k < many.pairs.size(); ++k) {
        const Pair &a = many.pairs[k], &b = alone.pairs[k];
        CHECK(a.sourceHash == b.sourceHash);
        REQUIRE(a.table);
        REQUIRE(b.table);
        CHECK(a.table->testCount() > 0);
        CHECK(a.table->columns == b.table->columns);
        CHECK(a.table->rowOffsets == b.table->rowOffsets);
        CHECK(a.table->epsilon == b.table->epsilon);
        REQUIRE(a.table->a.size() == b.table->a.size());
        for (std::size_t i = 0; i < a.table->a.size(); ++i) {
            CHECK(a.table->a[i].centre == b.table->a[i].centre);
            CHECK(a.table->a[i].radius == b.table->a[i].radius);
        }
    }
}

TEST_CASE("of pairs in work at once the first that fails in their order is the one that is thrown") {
    const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
    SceneModel scene = ballsAboutBox(6);
    // Samples prove nothing of all pairs, and there is no time for more.
    for (const std::size_t k : {1, 2, 4})
        for (const auto& [key, text] : BakeSettings{{"search", "sampled"}, {"budget", "1e-9"}})
            scene.pairs[k].settings[key] = text;
    const std::string first = scene.pairs[1].path;
    SceneModel thrown = scene;
    try {
        bake(thrown);
        FAIL("expected an error");
    } catch (const InputError& error) {
        CHECK(error.where.path == first);
    }
    BakeRequest request;
    std::vector<std::string> failed;
    request.failed = [&](const InputError& error) { failed.push_back(error.where.path); };
    bake(scene, request);
    CHECK(failed == std::vector{scene.pairs[1].path, scene.pairs[2].path, scene.pairs[4].path});
    for (const std::size_t k : {0, 3, 5}) CHECK((scene.pairs[k].table || scene.pairs[k].proof));
}

TEST_CASE("a bake that is stopped leaves what is in work as it was") {
    const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
    SceneModel scene = ballsAboutBox(6);
    BakeRequest request;
    std::size_t baked = 0;
    request.done = [&](const PairReport&) { ++baked; };
    std::atomic<int> asked = 0;
    request.interrupted = [&] { return ++asked > 40; };
    bake(scene, request);
    std::size_t there = 0;
    for (const Pair& pair : scene.pairs) there += pair.table || pair.proof;
    CHECK(there == baked);
    CHECK(there < scene.pairs.size());
}
