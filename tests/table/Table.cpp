#include "bake/table/Table.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>

using namespace tss;
using random_table::Random;

namespace {

SphereSet spheres(int count) {
    SphereSet set;
    for (int i = 0; i < count; ++i) set.push_back({Vec3(i, 0, 0), 0.1 * (i + 1)});
    return set;
}

} // namespace

TEST_CASE("a table keeps the used spheres only, in their order, and points at them") {
    std::vector<std::uint32_t> usedA, usedB;
    const Table t = makeTable(spheres(6), spheres(8), {{4, 7}, {1, 2}, {4, 2}}, {}, Motion(), &usedA, &usedB);
    CHECK(usedA == std::vector<std::uint32_t>{1, 4});
    CHECK(usedB == std::vector<std::uint32_t>{2, 7});
    REQUIRE(t.a.size() == 2);
    REQUIRE(t.b.size() == 2);
    CHECK(t.a[1].centre.x() == 4);
    CHECK(t.b[1].radius == Approx(0.8));
    CHECK(t.rowOffsets == std::vector<std::uint32_t>{0, 1, 3});
    CHECK(t.columns == std::vector<std::uint32_t>{0, 0, 1});
    CHECK(t.testCount() == 3);
    CHECK(tests(t) == std::vector<SpherePair>{{0, 0}, {1, 0}, {1, 1}});
    CHECK(t.restGaps.empty());
}

TEST_CASE("a pair given twice is one test") {
    const Table t = makeTable(spheres(3), spheres(3), {{2, 1}, {0, 0}, {2, 1}, {0, 0}}, {}, Motion());
    CHECK(t.testCount() == 2);
}

TEST_CASE("rest gaps follow their pairs into the rows") {
    const Table t = makeTable(spheres(5), spheres(5), {{3, 1}, {0, 4}, {3, 0}}, {-0.3, -0.1, -0.2}, Motion());
    CHECK(t.restGaps == std::vector<double>{-0.1, -0.2, -0.3});
    const Table none = makeTable(spheres(5), spheres(5), {{3, 1}, {0, 4}}, {0, 0}, Motion());
    CHECK(none.restGaps.empty());
}

TEST_CASE("a table of no pairs has no spheres and no tests") {
    const Table t = makeTable(spheres(5), spheres(5), {}, {}, Motion());
    CHECK(t.a.empty());
    CHECK(t.b.empty());
    CHECK(t.testCount() == 0);
    CHECK(t.rowOffsets == std::vector<std::uint32_t>{0});
}

TEST_CASE("every pair of a random list is a test of the table, and no other") {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const SphereSet a = spheres(1 + int(random() % 40)), b = spheres(1 + int(random() % 40));
        std::vector<SpherePair> pairs(random() % 60);
        for (SpherePair& p : pairs)
            p = {std::uint32_t(random() % a.size()), std::uint32_t(random() % b.size())};
        std::vector<std::uint32_t> usedA, usedB;
        const Table t = makeTable(a, b, pairs, {}, Motion(), &usedA, &usedB);
        std::vector<SpherePair> back = tests(t);
        for (SpherePair& p : back) p = {usedA[p.a], usedB[p.b]};
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        REQUIRE(back == pairs);
        REQUIRE(t.rowOffsets.size() == t.a.size() + 1);
        for (std::size_t i = 0; i < t.a.size(); ++i) REQUIRE(t.rowOffsets[i] < t.rowOffsets[i + 1]);
    }
}
