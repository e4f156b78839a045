// A skin is a function of what moves it alone: nothing of what came before is left, and at rest nothing at
// all.
#include "SkinMeasure.h"
#include "SkinShapes.h"
#include "tests/FloatTraps.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;
using skins::exactlyAtRest, skins::largestMove, skins::run;

TEST_CASE("skin over a resting muscle is exactly at rest and costs nothing") {
    SkinResponse response(skins::usual().rig());
    const SkinUpdate update = response.update(std::vector<double>{0});
    CHECK(update.rest);
    CHECK_FALSE(update.moved);
    CHECK(exactlyAtRest(response));
}

TEST_CASE("the skin is exactly at rest again after 0, 1, 0") {
    SkinResponse response(skins::usual().rig());
    for (int round = 0; round < 3; ++round) {
        run(response, 1, 3);
        CHECK(largestMove(response) > 0.01);
        const SkinUpdate update = response.update(std::vector<double>{0});
        CHECK(update.moved);
        CHECK(exactlyAtRest(response));
        CHECK_FALSE(response.update(std::vector<double>{0}).moved);
    }
}

TEST_CASE("once it was at rest a skin moves as it did the first time, to the bit") {
    SkinResponse response(skins::usual().rig());
    std::vector<std::vector<Vec3>> first;
    for (int round = 0; round < 300; ++round) { // of an odd length: what counts updates is out of step
        for (int f = 0; f < 7; ++f) {
            response.update(std::vector<double>{f / 7.0});
            const std::span<const Vec3> now = response.positions();
            if (round == 0)
                first.emplace_back(now.begin(), now.end());
            else if (!std::equal(now.begin(), now.end(), first[f].begin()))
                FAIL("round " << round << ", update " << f);
        }
    }
}

TEST_CASE("over a muscle that rests skin is at rest to the bit, whatever moved it before") {
    const auto couple = skins::couple(skins::vaultedSheet(32, 1, 0.01, 0),
                                      {skins::muscleBelow(0, 0.25, -0.6), skins::muscleBelow(0, 0.25, 0.6)});
    const auto rig = couple.rig();
    SkinResponse both(rig), one(rig);
    both.update(std::vector<double>{0.5, 1});
    both.update(std::vector<double>{1, 0});
    one.update(std::vector<double>{1, 0});
    TriangleMesh mesh = couple.skin;
    int resting = 0, moving = 0;
    for (std::size_t v = 0; v < rig->vertices.size(); ++v) {
        CHECK(both.positions()[v] == one.positions()[v]);
        CHECK(both.normals()[v] == one.normals()[v]);
        mesh.vertices[rig->vertices[v]] = both.positions()[v];
        moving += both.positions()[v] != rig->rest[v];
        if (rig->rest[v].y() < 0.5) continue;
        ++resting;
        CHECK(both.positions()[v] == rig->rest[v]);
        CHECK((both.normals()[v] - rig->restNormals[v]).norm() < 1e-6); // beside what moves in floats
    }
    CHECK(resting > 50);
    CHECK(moving > 50);
    const std::vector<Vec3> normals = skinNormals(mesh);
    for (std::size_t v = 0; v < rig->vertices.size(); ++v)
        CHECK((both.normals()[v] - normals[rig->vertices[v]]).norm() < 1e-4);
}

TEST_CASE("the skin comes back on its own, not because it is told to be at rest") {
    // 1e-9 is not 0: nothing is reset, the multipliers must die away.
    SkinResponse response(skins::usual().rig());
    run(response, 1, 100);
    run(response, 1e-9, 200);
    CHECK(largestMove(response) < 1e-6 * response.rig().size);
}

TEST_CASE("an unchanged activation changes nothing once the skin has settled") {
    SkinResponse response(skins::usual().rig());
    run(response, 0.5, 400);
    const std::vector<Vec3> before(response.positions().begin(), response.positions().end());
    CHECK_FALSE(response.update(std::vector<double>{0.5}).moved);
    CHECK(std::equal(before.begin(), before.end(), response.positions().begin()));
}

TEST_CASE("any compliance, any jump: the skin stays bounded and comes back") {
    const skins::Couple couple = skins::usual();
    for (const double compliance : {0.0, 1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e12}) {
        SkinParameters parameters;
        parameters.stretchCompliance = compliance;
        parameters.bendCompliance = compliance;
        SkinResponse response(couple.rig(parameters));
        std::mt19937_64 random(11);
        std::uniform_real_distribution<double> activation(0, 1);
        double most = 0;
        for (int f = 0; f < 60; ++f) {
            const double a = f % 3 == 0 ? 0.001 : f % 3 == 1 ? 1 : activation(random);
            response.update(std::vector<double>{a});
            most = std::max(most, largestMove(response));
        }
        INFO("compliance " << compliance << ", seed 11");
        CHECK(most > 0.005);
        CHECK(most < 0.3); // the fibre shortens by 0.3
        run(response, 1e-12, 200);
        CHECK(largestMove(response) < 1e-5);
    }
}

TEST_CASE("two runs of the same calls give the same bits") {
    const skins::Couple couple = skins::usual();
    SkinResponse first(couple.rig()), second(couple.rig());
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> activation(0, 1);
    for (int f = 0; f < 30; ++f) {
        const std::vector<double> a{activation(random)};
        first.update(a);
        second.update(a);
        CHECK(std::equal(first.positions().begin(), first.positions().end(), second.positions().begin()));
        CHECK(std::equal(first.normals().begin(), first.normals().end(), second.normals().begin()));
    }
}
