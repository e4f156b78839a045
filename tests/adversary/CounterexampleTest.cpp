// What an audit found to be said and not so, or so and refused: each file of it where those are at hand, and
// a scene of the same kind made here, always.
#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/check/VerifyPair.h"
#include "bake/pipeline/Bake.h"
#include "bake/scene/SceneFile.h"
#include "bake/table/Query.h"
#include "tests/Shapes.h"
#include "tests/SharedMeshes.h"
#include "tests/adversary/judge/Trial.h"
#include "tests/adversary/scenes/Draws.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <optional>

using namespace adversary;

namespace {

constexpr double degree = pi / 180;

/// Empty where it is absent.
std::string counterexampleFile(const std::string& name) {
    const std::string file = sharedMesh("../counterexamples/" + name + ".tss");
    if (std::filesystem::exists(file)) return file;
    WARN("skipped, no " << name << ".tss");
    return {};
}

std::optional<tss::SceneModel> counterexample(const std::string& name) {
    const std::string file = counterexampleFile(name);
    if (file.empty()) return {};
    return tss::loadScene(file);
}

TrialOptions unhurried() {
    TrialOptions options;
    options.poses = 4000;
    options.bakeSeconds = options.verifySeconds = 60;
    return options;
}

/// Baked and claimed rightly, and proven again; or refused with a word that says why.
Trial rightly(tss::SceneModel scene, const tss::BakeSettings& given, const std::string& reason = "") {
    for (const auto& [key, text] : given) scene.pairs[0].settings[key] = text;
    const tss::ThreadLimit one(1);
    const Trial trial = tryScene(std::move(scene), "counterexample", 1, unhurried());
    CHECK_FALSE(trial.stopped);
    for (const std::string& trouble : trial.troubles) FAIL_CHECK(trouble);
    if (!trial.verifyRefusal.empty()) FAIL_CHECK("verify: " << trial.verifyRefusal);
    if (!trial.refusal.empty()) {
        INFO(trial.refusal);
        CHECK_FALSE(reason.empty());
        CHECK(trial.refusal.find(reason) != std::string::npos);
    }
    return trial;
}

std::string verifySays(const tss::SceneModel& scene) {
    try {
        return tss::verifyPair(scene, scene.pairs.at(0)).reason;
    } catch (const tss::InputError& error) {
        return error.what();
    }
}

/// Proven again as it is, and nothing to be found against it.
void holds(const tss::SceneModel& scene) {
    CHECK(verifySays(scene).empty());
    const Findings found = attackPair(scene, scene.pairs.at(0), {4000, 1});
    INFO(found.what);
    CHECK_FALSE(found.failed());
    CHECK(found.contacts > 0);
}

/// The harm is there, and verify refuses.
void refuses(const tss::SceneModel& scene) {
    CHECK(attackPair(scene, scene.pairs.at(0), {4000, 1}).missed > 0);
    CHECK_FALSE(verifySays(scene).empty());
}

/// The same scene without what was baked of it.
tss::SceneModel unbaked(tss::SceneModel scene) {
    tss::Pair& pair = scene.pairs.at(0);
    pair.table.reset();
    pair.proof.reset();
    pair.tablePath.clear();
    pair.sourceHash.clear();
    return scene;
}

tss::SceneModel baked(const Draft& draft) {
    tss::SceneModel scene = sceneOf(draft, "baked");
    tss::bake(scene, {});
    REQUIRE(scene.pairs[0].table);
    return scene;
}

/// A ball over a block, with one bump that looks aside; turned about Y it comes down.
Draft bumpOverBlock(double clearance, double height, double width = 0.2) {
    Draft draft;
    draft.a = boxMesh({-2, -2, -3 - clearance}, {2, 2, -1 - clearance});
    draft.b = bumpyBall(1, 3, {{1, 0, 0}}, height, width);
    draft.motion.dofs = {turn(Vec3::Zero(), {0, 1, 0}, -90 * degree, 90 * degree)};
    return draft;
}

/// Two rough balls, one on a hinge that may be far away, all of it `off` from the origin.
Draft ballsOnHinge(double lever, const Vec3& off) {
    Draft draft;
    draft.a = movedBy(extreme::roughBall(Vec3::Zero(), 1, 1), off);
    draft.b = movedBy(extreme::roughBall({0, 2.2, 0}, 1, 1), off);
    draft.tolerance = 0.03;
    const double swing = lever > 10 ? 0.6 / lever : 0.4;
    draft.motion.dofs = {turn(off + Vec3(lever, 0, 0), {0, 0, 1}, -swing, swing)};
    draft.settings["at-rest"] = "collide";
    return draft;
}

} // namespace

TEST_CASE("bf17: a bump that turns near a body less than the tolerance away is not free of contact") {
    if (const auto scene = counterexample("bf17"))
        CHECK(rightly(*scene, {{"tolerance", "0.09"}}, "tolerance").found.contacts > 0);
    for (const double clearance : {0.004, 0.008})
        for (const double width : {0.1, 0.25}) {
            CAPTURE(clearance, width);
            Draft draft = bumpOverBlock(clearance, 0.02, width);
            draft.tolerance = 0.09;
            CHECK(rightly(sceneOf(draft, "bump"), {}, "tolerance").found.contacts > 0);
        }
}

TEST_CASE("ball0i: leaving out what overlaps at rest is no proof that the rest of the bodies never meet") {
    if (const auto scene = counterexample("ball0i"))
        CHECK(rightly(*scene, {{"at-rest", "ignore"}}, "tolerance").found.contacts > 0);
    Draft draft = bumpOverBlock(0.01, 0.04);
    draft.settings["at-rest"] = "ignore";
    rightly(sceneOf(draft, "bump"), {}, "tolerance");
}

TEST_CASE("rest_zero: bodies that overlap at the only pose do not pass for bodies that never collide") {
    if (const auto scene = counterexample("rest_zero")) rightly(*scene, {}, "rest");
    Draft draft;
    draft.a = boxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    draft.b = boxMesh({0.4, -0.4, -0.3}, {1.4, 0.6, 0.7});
    draft.motion.dofs = {turn(Vec3::Zero(), {0, 0, 1}, 0, 0)};
    rightly(sceneOf(draft, "boxes"), {}, "rest");
    const Trial collides = rightly(sceneOf(draft, "boxes"), {{"at-rest", "collide"}});
    CHECK_FALSE(collides.proof);
}

TEST_CASE("plane3_5: limits that leave no pose are refused") {
    const auto refused = [](const std::function<tss::SceneModel()>& make) {
        const tss::ThreadLimit one(1);
        std::string refusal;
        try { // where it is read, or where it is baked
            refusal = tryScene(make(), "planes", 1, unhurried()).refusal;
        } catch (const tss::InputError& error) {
            refusal = error.what();
        }
        INFO(refusal);
        CHECK(refusal.find("plane") != std::string::npos);
    };
    const std::string file = counterexampleFile("plane3_5");
    if (!file.empty()) refused([&] { return tss::loadScene(file); });
    Draft draft = ballsOnHinge(3, Vec3::Zero());
    draft.motion.dofs = {slide({0, -1, 0}, -0.3, 0.5), slide({1, 0, 0}, -0.3, 0.3)};
    draft.motion.planes = {{{1, 1}, -0.1}, {{-1, -1}, 0.05}}; // a sum of at most -0.1 and at least -0.05
    refused([&] { return sceneOf(draft, "planes"); });
    draft.motion.planes = {{{0, 1}, -0.31}}; // beyond the box
    refused([&] { return sceneOf(draft, "planes"); });
}

TEST_CASE("wire: triangles without area are surface, or are refused by name") {
    if (const auto scene = counterexample("wire")) {
        const Trial trial = rightly(*scene, {}, "area");
        if (trial.refusal.empty()) CHECK(trial.found.contacts > trial.found.poses / 4);
    }
    Random random(1);
    for (int k = 0; k < 4; ++k) { // both spellings come
        Draft draft;
        draft.a = boxMesh({-1, -1, -0.05}, {1, 1, 0.05});
        addWire(random, draft.a, {0.3, 0.2, 0}, {0.3, 0.2, 1});
        draft.b = boxMesh({-0.1, -0.1, 0.5}, {0.1, 0.1, 0.7});
        draft.motion.dofs = {slide({0.9, 0.6, 0}, 0, 0.7)};
        draft.tolerance = 0.01;
        const Trial trial = rightly(sceneOf(draft, "wire"), {}, "area");
        if (trial.refusal.empty()) CHECK(trial.found.contacts > 0);
    }
}

TEST_CASE("re__shrink_and_count: spheres that no longer hold the surface are not believed") {
    if (const auto scene = counterexample("re__shrink_and_count")) refuses(*scene);
    for (const char* keep : {"false", "true"}) {
        Draft draft = ballsOnHinge(3, Vec3::Zero());
        draft.settings["keep-spheres"] = keep;
        tss::SceneModel scene = baked(draft);
        CHECK(verifySays(scene).empty());
        tss::Table table = *scene.pairs[0].table;
        for (tss::SphereSet* spheres : {&table.a, &table.b})
            for (tss::Sphere& sphere : *spheres) sphere.radius = float(0.9 * sphere.radius);
        table.record.spheresA = table.a.size();
        table.record.spheresB = table.b.size();
        scene.pairs[0].table = std::make_shared<tss::Table>(table);
        refuses(scene);
    }
}

TEST_CASE(
    "rn__miss0_cov0: a bound on misses is proven from the meshes, not from what the file says of coverage") {
    if (const auto scene = counterexample("rn__miss0_cov0")) refuses(*scene);
    Draft draft = ballsOnHinge(3, Vec3::Zero());
    draft.settings["conservative"] = "false";
    tss::SceneModel scene = baked(draft);
    CHECK(verifySays(scene).empty());
    tss::Table table = *scene.pairs[0].table;
    CHECK(table.boundMiss > 0);
    table.boundMiss = table.record.fitA.coverage = table.record.fitB.coverage = 0;
    scene.pairs[0].table = std::make_shared<tss::Table>(table);
    refuses(scene);
}

TEST_CASE(
    "far_9, off1e5, t76: a good table is proven again however far its axis or its bodies and however small "
    "its range") {
    for (const char* name : {"far_9_baked", "off1e5_baked", "t76_baked"}) {
        CAPTURE(name);
        if (const auto scene = counterexample(name)) {
            holds(*scene);
            rightly(unbaked(*scene), {});
        }
    }
    for (const double far : {1e3, 1e5}) {
        CAPTURE(far);
        CHECK(rightly(sceneOf(ballsOnHinge(far, Vec3::Zero()), "axis"), {}).found.contacts > 0);
        CHECK(rightly(sceneOf(ballsOnHinge(3, {far, -far, 0.3 * far}), "bodies"), {}).found.contacts > 0);
    }
    for (const double range : {1e-8, 1e-5}) {
        CAPTURE(range);
        Draft draft = ballsOnHinge(3, Vec3::Zero());
        draft.motion.dofs[0].lower *= range;
        draft.motion.dofs[0].upper *= range;
        bringTogether(draft.a, draft.b, {0, 1, 0}, 0.1 * range);
        rightly(sceneOf(draft, "range"), {}, "tolerance");
    }
}

TEST_CASE("fe1: the band that a kernel states holds what it is off, for axes far away too") {
    const auto within = [](const tss::SceneModel& scene) {
        const Findings found = attackPair(scene, scene.pairs.at(0), {40000, 1});
        INFO(found.what);
        CHECK(found.kernel == 0);
        CHECK(found.fired > 0);
    };
    if (const auto scene = counterexample("fe1_baked")) within(*scene);
    for (const double far : {3., 1e3, 1e5}) {
        CAPTURE(far);
        Draft draft = ballsOnHinge(far, Vec3::Zero());
        draft.settings["epsilon"] = "1e-9";
        draft.motion.dofs.push_back(turn({0, 2, 0.5}, {0.3, 1, -0.2}, -0.3, 0.3));
        within(baked(draft));
    }
}

TEST_CASE(
    "solidin: a body wholly inside another, surfaces apart, is no contact, or early says how far apart") {
    if (const auto scene = counterexample("solidin"))
        CHECK(rightly(*scene, {{"tolerance", "0.03"}}).found.fired > 0);
    Draft draft;
    draft.a = ballMesh(Vec3::Zero(), 2, 2);
    draft.b = ballMesh({0.05, 0.1, 0}, 0.3, 1);
    draft.motion.dofs = {slide({1, 0, 0}, -3, 3)};
    CHECK(rightly(sceneOf(draft, "inside"), {}).found.fired > 0);
    draft.a = boxMesh({-2, -2, -2}, {2, 2, 2});
    CHECK(rightly(sceneOf(draft, "inside"), {}).found.fired > 0);
}
