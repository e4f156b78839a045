#include "bake/table/FeatureForm.h"

#include "tests/Joints.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;

TEST_CASE("that three turns have too many features to fold is told from few of a hundred thousand pairs") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(-1, 1);
    std::vector<TablePair> pairs(100'000);
    for (TablePair& pair : pairs) {
        pair.a = Vec3(place(random), place(random), place(random));
        pair.b = Vec3(place(random), place(random), place(random));
        pair.contactDistance = 0.1;
    }
    Motion motion;
    motion.dofs = {joints::turn(Vec3(0, 0, 0), Vec3::UnitZ(), -1, 1),
                   joints::turn(Vec3(1, 0, 0), Vec3::UnitX(), -1, 1)};
    std::uint64_t multiplied = 0;
    CHECK(makeFeatureForm(motion, pairs, {}, &multiplied));
    CHECK(multiplied >= pairs.size());
    motion.dofs.push_back(joints::turn(Vec3(0, 1, 0), Vec3::UnitY(), -1, 1));
    multiplied = 0;
    CHECK_FALSE(makeFeatureForm(motion, pairs, {}, &multiplied));
    CHECK(multiplied < pairs.size() / 50);
}
