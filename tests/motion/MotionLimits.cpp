#include "bake/base/Error.h"
#include "bake/motion/WholeTurn.h"
#include "tests/FloatTraps.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace tss;
using random_table::Random;

namespace {

Motion twoSlides() {
    Motion m;
    for (int k = 0; k < 2; ++k) {
        Dof d;
        d.kind = DofKind::Translation;
        d.axis = Vec3::Unit(k);
        d.lower = -1;
        d.upper = 2;
        m.dofs.push_back(d);
    }
    return m;
}

/// checkMotion's complaint about a motion changed by `spoil`.
template <class Spoil>
bool refused(Spoil spoil) {
    Motion m = twoSlides();
    spoil(m);
    try {
        checkMotion(m);
    } catch (const InputError&) {
        return true;
    }
    return false;
}

} // namespace

TEST_CASE("values within the limits stay, others are clamped to them") {
    const Motion m = twoSlides();
    const std::vector<double> inside{0.5, -0.5}, outside{3, -7};
    CHECK(withinLimits(m, inside));
    CHECK(clampToLimits(m, inside) == inside);
    CHECK_FALSE(withinLimits(m, outside));
    CHECK(clampToLimits(m, outside) == std::vector<double>{2, -1});
    CHECK(withinLimits(m, std::vector<double>{2.05, 0}, 0.1));
}

TEST_CASE("a value that is not a number is not within limits") {
    const FloatTrapsOff traps; // what is not a number is handed over on purpose
    CHECK_FALSE(withinLimits(twoSlides(), std::vector<double>{NAN, 0}));
}

TEST_CASE("limits far from 0 end where they end, but for what rounding does near 0") {
    Motion motion = twoSlides();
    motion.dofs[0].lower = 1.7e9; // as time stamps are
    motion.dofs[0].upper = 1.7e9 + 50;
    CHECK_FALSE(beyondLimits(motion, std::vector{1.7e9 + 50, 0.0}));
    CHECK(beyondLimits(motion, std::vector{1.7e9 + 51, 0.0}));
    CHECK(beyondLimits(motion, std::vector{1.7e9 - 1, 0.0}));
    const double once = 1.1;
    motion.dofs[0].lower = motion.dofs[0].upper = float(once); // one value alone, as files hold it
    CHECK_FALSE(beyondLimits(motion, std::vector{once, double(2 + 1e-7f)}));
    CHECK(beyondLimits(motion, std::vector{once + 1e-5, 0.0}));
}

TEST_CASE("what is no pose of a motion is beyond its limits, and is not posed") {
    const FloatTrapsOff traps;
    const Motion motion = twoSlides();
    const double infinite = std::numeric_limits<double>::infinity();
    CHECK_FALSE(beyondLimits(motion, std::vector{0.5, -0.5}));
    CHECK(beyondLimits(motion, std::vector{0.5, infinite}));
    CHECK(beyondLimits(motion, std::vector{-infinite, 0.0}));
    for (const std::vector<double>& q : {std::vector<double>{}, {0.5}, {0.5, 0.5, 0.5}}) {
        CHECK(beyondLimits(motion, q));
        CHECK_THROWS_AS(pose(motion, q), InputError);
        CHECK_THROWS_AS(clampToLimits(motion, q), InputError);
    }
}

TEST_CASE("planes cut the box and pull values back") {
    Motion m = twoSlides();
    m.planes = {{{1.0, 1.0}, 1.0}};
    CHECK_FALSE(withinLimits(m, std::vector<double>{1, 1}));
    const std::vector<double> q = clampToLimits(m, std::vector<double>{1, 1});
    CHECK(q[0] == Approx(0.5));
    CHECK(q[1] == Approx(0.5));
}

TEST_CASE("clamped values meet the limits and planes of random motions") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        Motion m = random_table::motion(random, 1 + int(random() % 3), 10);
        const std::vector<double> inside = random_table::values(random, m);
        for (int i = 0; i < 2; ++i) {
            LimitPlane plane;
            for (std::size_t k = 0; k < inside.size(); ++k) {
                plane.coefficients.push_back(random_table::between(random, -1, 1));
                plane.bound += plane.coefficients[k] * inside[k];
            }
            plane.bound += 0.05;
            m.planes.push_back(plane);
        }
        std::vector<double> q = inside;
        for (double& v : q) v += random_table::between(random, -20, 20);
        REQUIRE(withinLimits(m, clampToLimits(m, q), 1e-6));
    }
}

TEST_CASE("a motion that cannot be served is refused") {
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK_FALSE(refused([](Motion&) {}));
    CHECK(refused([](Motion& m) { std::swap(m.dofs[0].lower, m.dofs[0].upper); }));
    CHECK(refused([&](Motion& m) { m.dofs[0].upper = infinity; }));
    CHECK(refused([](Motion& m) { m.dofs[1].lower = NAN; }));
    CHECK(refused([](Motion& m) { m.dofs[1].rest = NAN; }));
    CHECK(refused([](Motion& m) { m.dofs[0].axis.setZero(); }));
    CHECK(refused([](Motion& m) {
        m.dofs[0].kind = DofKind::Rotation;
        m.dofs[0].axis = Vec3(0, 0, 2);
    }));
    CHECK(refused([](Motion& m) { m.base.translation().x() = NAN; }));
    CHECK(refused([](Motion& m) { m.planes = {{{1.0}, 1.0}}; }));
    CHECK(refused([](Motion& m) { m.planes = {{{0.0, 0.0}, 1.0}}; }));
    CHECK(refused([](Motion& m) { m.dofs[0].kind = DofKind::Path; }));
    CHECK(refused([](Motion& m) {
        m.dofs[0].kind = DofKind::Path;
        m.dofs[0].path.resize(3);
        m.dofs[0].path[0].value = m.dofs[0].path[1].value = -1;
        m.dofs[0].path[2].value = 2;
    }));
    CHECK(refused([](Motion& m) {
        m.dofs[0].kind = DofKind::Path;
        m.dofs[0].path = {{0, Vec3::Zero(), Eigen::Quaterniond::Identity()},
                          {1, Vec3::Zero(), Eigen::Quaterniond::Identity()}};
    }));
    const auto path = [](Motion& m) {
        m.dofs[0].kind = DofKind::Path;
        m.dofs[0].path = {{-1, Vec3::Zero(), Eigen::Quaterniond::Identity()},
                          {2, Vec3::Zero(), Eigen::Quaterniond::Identity()}};
    };
    CHECK_FALSE(refused(path));
    CHECK(refused([&](Motion& m) {
        path(m);
        m.dofs[0].path[1].rotation.coeffs() *= 2;
    }));
    CHECK(refused([&](Motion& m) {
        path(m);
        m.dofs[0].path.insert(m.dofs[0].path.begin() + 1, m.dofs[0].path[0]);
        m.dofs[0].path[1].value += 1e-15;
    }));
    CHECK(refused([&](Motion& m) {
        path(m);
        m.dofs[0].frame.translation().x() = NAN;
    }));
    CHECK(refused([](Motion& m) { m.base.linear() *= 3; }));
    CHECK(refused([](Motion& m) {
        m.dofs[0].kind = DofKind::Rotation;
        m.dofs[0].upper = 1e6;
    }));
    // Limits of zero width are a joint that is held, not an error.
    CHECK_FALSE(refused([](Motion& m) { m.dofs[0].rest = m.dofs[0].upper = m.dofs[0].lower; }));
}

TEST_CASE("turns of more than once round go once round about where they rest, and all else stays") {
    constexpr double turn = 2 * std::numbers::pi;
    Motion motion;
    for (const auto& [lower, upper, rest] : {std::array{-turn, turn, 0.1}, std::array{-turn, turn, -6.0},
                                             std::array{0.0, 7.0, 6.9}, std::array{-1.0, 1.0, 0.0}}) {
        Dof dof;
        dof.lower = lower;
        dof.upper = upper;
        dof.rest = rest;
        motion.dofs.push_back(dof);
    }
    motion.dofs.push_back(motion.dofs[0]);
    motion.dofs.back().kind = DofKind::Translation;
    const Motion once = onceRound(motion);
    for (std::size_t k = 0; k < 3; ++k) {
        const Dof &all = motion.dofs[k], &one = once.dofs[k];
        CHECK(one.lower >= all.lower);
        CHECK(one.upper <= all.upper);
        CHECK(one.upper - one.lower > turn);
        CHECK(one.upper - one.lower < turn * (1 + 1e-8));
        CHECK(one.lower <= one.rest);
        CHECK(one.rest <= one.upper);
    }
    for (std::size_t k = 3; k < 5; ++k) CHECK(once.dofs[k].upper == motion.dofs[k].upper);
    motion.planes = {{{1, 1, 0, 0, 0}, 3}}; // may tell a turn from the next
    CHECK(onceRound(motion).dofs[0].upper == motion.dofs[0].upper);
}

TEST_CASE("planes of any size pull a value back inside") {
    for (const double size : {1e-300, 1e-200, 1e-20, 1., 1e20, 1e200}) {
        CAPTURE(size);
        Motion m = twoSlides();
        m.planes = {{{size, size}, size}, {{0, size}, 0.5 * size}};
        const std::vector<double> q = clampToLimits(m, std::vector<double>{2, 2});
        CHECK(std::isfinite(q[0]));
        CHECK(q[0] + q[1] <= 1 + 1e-12);
        CHECK(q[0] + q[1] > 0.999);
        CHECK(q[1] <= 0.5 + 1e-12);
    }
}

TEST_CASE("planes at a very sharp angle pull a value back inside") {
    Motion m = twoSlides();
    for (const double slope : {1e-3, 1e-6, 1e-9}) {
        CAPTURE(slope);
        m.planes = {{{slope, 1}, 0}, {{slope, -1}, 0}}; // a wedge that ends at the rest
        const std::vector<double> q = clampToLimits(m, std::vector<double>{2, 0.5});
        CHECK(withinLimits(m, q, 1e-12));
    }
}
