#include "bake/table/Query.h"
#include "bake/table/TablePairs.h"
#include "tests/extreme/Served.h"

#include <numbers>

using namespace extreme;
using tss::Table;

TEST_CASE("a joint of one pose knows whether it is in contact there") {
    CHECK(tss::query(tableOf("limit_zero_width"), std::vector<double>{0}).gap <= 0);
    CHECK(served("limit_zero_width_apart").scene.pairs.at(0).proof);
}

TEST_CASE("over limits of 360 degrees a pose and the same pose a turn later have one verdict") {
    const Table& table = tableOf("limit_360");
    const double band = served("limit_360").pairs[0].kernel->band;
    int hits = 0;
    for (int degrees = -360; degrees <= 0; ++degrees) {
        const double q = degrees * std::numbers::pi / 180, later = q + 2 * std::numbers::pi;
        const double here = tss::query(table, std::vector<double>{q}).gap;
        const double there = tss::query(table, std::vector<double>{later}).gap;
        hits += here <= 0;
        if (std::abs(here) > band) CHECK((here <= 0) == (there <= 0));
    }
    CHECK(hits > 0);
    CHECK(hits < 361);
}

TEST_CASE("a DOF of zero width among others changes nothing") {
    const Table& table = tableOf("limit_zero_width_among");
    REQUIRE(table.motion.dofCount() == 3);
    for (const auto& q : tss::latticePoses(table.motion, 100)) CHECK(q[1] == 0);
    for (const auto& [status, steps] : served("limit_zero_width_among").pairs[0].statuses) {
        INFO(status << " " << steps);
        CHECK((status == "free" || status == "slid" || status == "blocked"));
    }
}
