#include "bake/table/Query.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>

using namespace tss;
using random_table::Random;

TEST_CASE("two spheres apart have their gap, contact point and normal") {
    Motion m;
    Dof slide;
    slide.kind = DofKind::Translation;
    slide.axis = Vec3::UnitX();
    slide.lower = 0;
    slide.upper = 20;
    m.dofs = {slide};
    const Table t = makeTable({{Vec3(0, 0, 0), 2.0}}, {{Vec3(0, 0, 0), 1.0}}, {{0, 0}}, {}, m);
    const std::vector<double> apart{5.0}, touching{3.0}, inside{2.0};
    const QueryResult r = query(t, apart);
    CHECK(r.gap == Approx(2));
    CHECK(r.test == 0);
    CHECK(r.normal.isApprox(Vec3::UnitX()));
    CHECK(r.point.isApprox(Vec3(3, 0, 0)));
    CHECK_FALSE(r.hit());
    CHECK(query(t, touching).hit());
    CHECK(query(t, inside).gap == Approx(-1));
    CHECK(query(t, inside).point.isApprox(Vec3(1.5, 0, 0)));
}

TEST_CASE("a test with a rest gap is contact only below it") {
    Motion m;
    Dof slide;
    slide.kind = DofKind::Translation;
    slide.lower = 0;
    slide.upper = 20;
    m.dofs = {slide};
    const Table t = makeTable({{Vec3(0, 0, 0), 2.0}}, {{Vec3(0, 0, 0), 1.0}}, {{0, 0}}, {-1.0}, m);
    const std::vector<double> above{2.5}, below{1.5};
    CHECK(query(t, above).gap == Approx(0.5));
    CHECK_FALSE(query(t, above).hit());
    CHECK(query(t, below).hit());
}

TEST_CASE("tests are asked for contact as the whole table answers") {
    int hits = 0, free = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Table t = random_table::anyTable(random);
        for (int i = 0; i < 20; ++i) {
            const Pose at = pose(t.motion, random_table::values(random, t.motion));
            const bool hit = query(t, at).hit();
            REQUIRE(touches(t, at) == hit);
            ++(hit ? hits : free);
        }
    }
    CHECK(hits > 100);
    CHECK(free > 100);
}

TEST_CASE("an empty table never hits and names no test") {
    const QueryResult r = query(Table(), Pose::Identity());
    CHECK_FALSE(touches(Table(), Pose::Identity()));
    CHECK(r.gap == std::numeric_limits<double>::infinity());
    CHECK(r.test == -1);
    CHECK_FALSE(r.hit());
}

TEST_CASE("concentric spheres give a gap and a unit normal") {
    const Table t = makeTable({{Vec3(1, 2, 3), 2.0}}, {{Vec3(1, 2, 3), 1.0}}, {{0, 0}}, {}, Motion());
    const QueryResult r = query(t, Pose::Identity());
    CHECK(r.gap == Approx(-3));
    CHECK(r.normal.norm() == Approx(1));
    CHECK(r.point.allFinite());
}

TEST_CASE("a table of all pairs answers as all pairs do") {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Table t = random_table::anyTable(random);
        const double size = t.b[0].radius;
        for (int i = 0; i < 20; ++i) {
            const std::vector<double> q = random_table::values(random, t.motion);
            const QueryResult x = query(t, q), y = queryAllPairs(t.a, t.b, pose(t.motion, q));
            REQUIRE(x.gap == y.gap);
            REQUIRE(x.normal == y.normal);
            REQUIRE(x.point == y.point);
            // The contact point lies between the two surfaces, in the frame of A.
            const SpherePair p = tests(t)[x.test];
            REQUIRE((x.point - t.a[p.a].centre).dot(x.normal) - t.a[p.a].radius ==
                    Approx(0.5 * x.gap).margin(1e-9 * size));
        }
    }
}
