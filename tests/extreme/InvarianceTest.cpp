#include "tests/extreme/tool/Invariance.h"

#include <catch2/catch.hpp>

TEST_CASE(
    "other units, places, orientations, order and DOF units give the same spheres, table and verdicts") {
    for (const extreme::Invariance& result : extreme::invariances(2000)) {
        INFO(result.change << ": spheres off by " << result.off << " units, " << result.differ << " of "
                           << result.poses << " verdicts differ");
        if (result.sameTable) {
            CHECK(result.sameCount);
            CHECK(result.sameTests);
            CHECK(result.off < result.band);
        }
        CHECK(result.differ == 0);
        CHECK(result.hits > result.poses / 20);
        CHECK(result.hits < result.poses);
    }
}
