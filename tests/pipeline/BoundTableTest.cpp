#include "bake/pipeline/SelectTests.h"

#include <catch2/catch.hpp>

using namespace tss;

TEST_CASE("spheres of a contact zone prove no more distance than the zone reaches") {
    const Motion motion;
    const BakeOptions options;
    PairSpheres spheres;
    spheres.a.coverage = 0.25;
    spheres.b.coverage = 0.5;
    const auto bounded = [&] {
        Selection selection;
        selection.proof = NeverCollides{6, 1, {}, {}, {}};
        boundProof(selection, {spheres, motion, options, {}, 0});
        return selection;
    };
    CHECK(bounded().proof->clearance == 5.25); // all over both surfaces
    spheres.zoneA.emplace();
    spheres.zoneMargin = 2;
    CHECK(bounded().proof->clearance == 2);
    spheres.zoneMargin = 9;
    CHECK(bounded().proof->clearance == 5.25);
    spheres.zoneMargin = 0; // that nothing meets is known, and no distance
    CHECK_FALSE(bounded().proof);
    CHECK(bounded().certified);
}
