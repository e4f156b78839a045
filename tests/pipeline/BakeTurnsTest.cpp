// A bake in a given time: what comes first, and how long each may take.
#include "bake/pipeline/BakeTurns.h"
#include "bake/pipeline/BakeOptions.h"

#include "bake/model/AddPair.h"
#include "tests/Joints.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

using namespace tss;

namespace {

std::vector<std::size_t> itemsOf(BakeTurns& turns) {
    std::vector<std::size_t> items;
    while (const auto turn = turns.next()) items.push_back(turn->item);
    return items;
}

} // namespace

TEST_CASE("without a time limit each has one turn without one, in the order given") {
    BakeTurns turns({4, 2, 9}, {});
    const auto first = turns.next();
    REQUIRE(first);
    CHECK(first->item == 4);
    CHECK_FALSE(first->until.comes());
    CHECK(itemsOf(turns) == std::vector<std::size_t>{2, 9});
}

TEST_CASE(
    "many have a brief turn each, then a quarter of the time, twice as long after one that was cut short") {
    std::vector<std::size_t> many;
    for (std::size_t k = 0; k < 100; ++k) many.push_back(99 - k);
    BakeTurns turns(many, Deadline(1000));
    const auto expectTurn = [&](std::size_t item, double seconds) {
        const auto turn = turns.next();
        REQUIRE(turn);
        CHECK(turn->item == item);
        CHECK(turn->until.left() == Approx(seconds).epsilon(0.01));
        CHECK(turn->brief == (seconds < 100));
        return *turn;
    };
    for (const std::size_t item : many) turns.cutShort(expectTurn(item, 10));
    expectTurn(99, 250);
    turns.cutShort(expectTurn(98, 250));
    turns.cutShort(expectTurn(97, 500));
    for (std::size_t item = 97; item-- > 0;) expectTurn(item, 1000);
    expectTurn(98, 1000);      // with all that is left
    CHECK_FALSE(turns.next()); // 97: no more than twice the time
    CHECK_FALSE(BakeTurns({0}, Deadline(0)).next());
}

TEST_CASE("brief turns end with half of the time, and all that wait follow in their order") {
    std::vector<std::size_t> many{7, 3, 5, 1, 2, 4, 6, 8, 9};
    BakeTurns turns(many, Deadline(0.5));
    REQUIRE(turns.next()->item == 7); // takes no time
    const auto cut = turns.next();    // 3
    REQUIRE(cut->brief);
    turns.cutShort(*cut);
    std::this_thread::sleep_for(std::chrono::milliseconds(260));
    const auto next = turns.next();
    REQUIRE(next);
    CHECK_FALSE(next->brief);
    CHECK(next->item == 3);
    CHECK(turns.next()->item == 5);
}

TEST_CASE("few have no brief turn, and a fair share where that is more than a quarter") {
    BakeTurns turns({5, 6}, Deadline(1000));
    for (const std::size_t item : {5, 6}) {
        const auto turn = turns.next();
        REQUIRE(turn);
        CHECK(turn->item == item);
        CHECK(turn->until.left() == Approx(item == 5 ? 500 : 1000).epsilon(0.01));
        CHECK_FALSE(turn->brief);
        if (item == 5) turns.cutShort(*turn);
    }
    // Again, but only with twice the time: less than 1000 s are left by now.
    CHECK_FALSE(turns.next());

    BakeTurns three({5, 6, 7}, Deadline(1000));
    const auto third = three.next();
    REQUIRE(third);
    three.cutShort(*third);
    CHECK(three.next()->item == 6);
    CHECK(three.next()->item == 7);
    const auto again = three.next();
    REQUIRE(again);
    CHECK(again->item == 5);
    CHECK(again->until.left() == Approx(1000).epsilon(0.01));
    CHECK_FALSE(three.next());
}

TEST_CASE(
    "where several are baked at once each has the time of all of them, and one that is cut late waits") {
    std::vector<std::size_t> many;
    for (std::size_t k = 0; k < 10; ++k) many.push_back(k);
    BakeTurns turns(many, Deadline(1000), 4);
    std::vector<BakeTurns::Turn> brief;
    for (std::size_t k = 0; k < 10; ++k) brief.push_back(*turns.next());
    CHECK(brief[0].until.left() == Approx(40).epsilon(0.01));
    CHECK_FALSE(turns.next()); // those in work may be cut short yet
    turns.cutShort(brief[2]);
    const auto longer = turns.next();
    REQUIRE(longer);
    CHECK(longer->item == 2);
    CHECK(longer->until.left() == Approx(1000).epsilon(0.01));
    turns.cutShort(brief[7]);
    const auto late = turns.next();
    REQUIRE(late);
    CHECK(late->item == 7);
    CHECK(late->round == longer->round);
    CHECK(late->until.left() == Approx(1000).epsilon(0.01));
}

TEST_CASE("pairs that a joint ties come first, then what is nearest at rest") {
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "Chain";
    const std::pair<const char*, double> places[] = {{"A", 0}, {"B", 2}, {"C", 5}, {"D", 6.5}};
    for (const auto& [name, x] : places) {
        Body body;
        body.path = std::string("/Chain/") + name;
        body.mesh = boxMesh({x, 0, 0}, {x + 1, 1, 1});
        scene.bodies.push_back(body);
    }
    Motion motion;
    motion.dofs = {joints::turn({0, 5, 0}, {0, 0, 1}, -0.1, 0.1)};
    addPair(scene, 2, 3, motion, "CD");
    addPair(scene, 0, 1, motion, "AB");
    addPair(scene, 1, 2, motion, "BC");
    const auto chain = [&](int a, int b, std::vector<int> joints) {
        Pair pair;
        pair.bodyA = a, pair.bodyB = b, pair.joints = std::move(joints);
        scene.pairs.push_back(pair);
    };
    chain(0, 2, {1, 2});    // 4 apart
    chain(0, 3, {1, 2, 0}); // 5.5
    chain(1, 3, {2, 0});    // 3.5
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < scene.pairs.size(); ++k) all.push_back(k);
    std::string order;
    for (const std::size_t k : pairsByWeight(scene, all)) {
        const Pair& pair = scene.pairs[k];
        for (const int body : {std::min(pair.bodyA, pair.bodyB), std::max(pair.bodyA, pair.bodyB)})
            order += scene.bodies[body].path.back();
        order += ' ';
    }
    CHECK(order == "CD AB BC BD AC AD ");
    CHECK(pairsByWeight(scene, {4, 1}).front() == 1);
}

TEST_CASE("the pairs of a scene share how many tests they may keep where they are many") {
    SceneModel scene;
    scene.pairs.resize(1);
    CHECK(optionsFor(scene, scene.pairs[0]).mostTests == 1'000'000);
    scene.pairs.resize(35);
    CHECK(optionsFor(scene, scene.pairs[0]).mostTests == 1'000'000);
    scene.pairs.resize(500);
    CHECK(optionsFor(scene, scene.pairs[0]).mostTests == 80'000);
    scene.pairs.resize(100'000);
    CHECK(optionsFor(scene, scene.pairs[0]).mostTests == 10'000);
    scene.pairs[0].settings["max-tests"] = "123";
    CHECK(optionsFor(scene, scene.pairs[0]).mostTests == 123);
}
