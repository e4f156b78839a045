#include "bake/motion/BoneChain.h"

#include "bake/motion/MuscleSpan.h"
#include "tests/BentEllipsoid.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

constexpr double degree = M_PI / 180;

Pose turned(double at, double degrees) {
    return Eigen::Translation3d(at, 0, 0) * Eigen::AngleAxisd(degrees * degree, Vec3::UnitY()) *
           Eigen::Translation3d(-at, 0, 0);
}

} // namespace

TEST_CASE("a chain's bones have their own motions to the bit, and what is between changes without a jump") {
    const ChainMotion motion{turned(1, 40), turned(1, 40) * turned(2, 100), turned(1, 40) * turned(2, 50)};
    const ChainBlend blend(motion, {});
    CHECK(blend.at(0).matrix() == Pose::Identity().matrix());
    CHECK(blend.at(1).matrix() == motion[2].matrix());
    CHECK((blend.at(1.0 / 3).matrix() - motion[0].matrix()).norm() < 1e-12);
    CHECK((blend.at(2.0 / 3).matrix() - motion[1].matrix()).norm() < 1e-12);
    constexpr double step = 1e-3;
    for (double share = 0; share < 1; share += step)
        CHECK((blend.at(share + step).matrix() - blend.at(share).matrix()).norm() < 20 * step);
    // Half way from the first bone to the second it has half the turn, about the same axis.
    CHECK((blend.at(1.0 / 6).matrix() - turned(1, 20).matrix()).norm() < 1e-12);
}

TEST_CASE("each bone of a chain is seen from the first, and one that moves as that does has not moved") {
    const std::vector<Pose> poses{turned(0, 30), turned(0, 30), turned(0, 30) * turned(1, 20)};
    const std::vector<int> chain{1, 2};
    const ChainMotion motion = chainMotion(poses, 0, chain);
    REQUIRE(motion.size() == 2);
    CHECK(isIdentity(motion[0]));
    CHECK((motion[1].matrix() - turned(1, 20).matrix()).norm() < 1e-12);
    CHECK_FALSE(isAtRest(motion));
    CHECK(isAtRest(chainMotion(poses, 0, std::vector<int>{1})));
    CHECK(isAtRest({}));
}

TEST_CASE("a bone that turns by more than half a turn is reached the way round that its side tells") {
    const Eigen::Vector4d side(0, std::sin(100 * degree), 0, std::cos(100 * degree)); // of 200 degrees
    const ChainMotion motion{turned(1, 20), turned(1, 20) * turned(2, 200)};
    const ChainBlend told(motion, std::vector<Eigen::Vector4d>{{0, 0, 0, 1}, side}), not_(motion, {});
    const auto middle = [&](double degrees) { return turned(1, 20) * turned(2, degrees); };
    CHECK((told.at(0.75).matrix() - middle(100).matrix()).norm() < 1e-9);
    CHECK((not_.at(0.75).matrix() - middle(-80).matrix()).norm() < 1e-9);
}
