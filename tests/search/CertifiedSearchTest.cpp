#include "bake/search/CertifiedSearch.h"
#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/motion/CellTools.h"
#include "bake/search/SampledSearch.h"
#include "bake/search/SphereTree.h"
#include "bake/search/UndecidedCells.h"
#include "bake/table/Query.h"
#include "tests/search/Scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace tss;

namespace {

CertifiedSearchOptions colliding(double tolerance = -1) {
    CertifiedSearchOptions options;
    options.tolerance = tolerance;
    return options;
}

/// Spheres that stick out of their body by nothing.
LevelSpheres levelOf(const SphereSet& spheres) {
    LevelSpheres level{spheres, {}, {}};
    for (const Sphere& sphere : spheres) level.inner.push_back(sphere.radius);
    return level;
}

} // namespace

TEST_CASE("the certified search finds every pair that any sampled pose shows") {
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        INFO("seed " << seed);
        const auto scene = scenes::randomScene(seed, 1 + int(seed % 3), 40, seed % 2);
        const auto certified = searchCertified(scene.a, scene.b, scene.motion, colliding());
        SampledSearchOptions options;
        options.samples = 4000;
        options.seed = seed + 100;
        const auto sampled = searchSampled(scene.a, scene.b, scene.motion, options);
        CHECK(certified.certified);
        CHECK(std::includes(certified.pairs.begin(), certified.pairs.end(), sampled.pairs.begin(),
                            sampled.pairs.end()));
    }
}

TEST_CASE("a hinge is cut also where a point of the other body comes to lie on its axis") {
    // Slides far from 0, in numbers that are 2e-13 apart, bring any point of B's ball onto the axis.
    const double far = 1549, degree = std::numbers::pi / 180;
    for (int direction = 0; direction < 16; ++direction) {
        INFO("direction " << direction);
        scenes::Random random(7);
        SphereSet a;
        for (int k = 0; k < 300; ++k) a.push_back({random.inBox(1.2), random.in(0.002, 0.01)});
        const SphereSet b{{Vec3(-0.4, 0, 0), 0.1}, {Vec3(0.4, 0, 0), 0.1}};
        const double angle = 22.5 * (direction + 0.5) * degree;
        Motion motion;
        motion.base.translation() = Vec3(0.5 * std::cos(angle) - far, 0.5 * std::sin(angle) - far, 0);
        motion.dofs = {joints::turn({0, 0, 0}, {0, 0, 1}, -45 * degree, 45 * degree),
                       joints::slide({1, 0, 0}, far - 0.02, far + 0.02),
                       joints::slide({0, 1, 0}, far - 0.02, far + 0.02)};
        const auto certified = searchCertified(a, b, motion, colliding(0.0005));
        SampledSearchOptions options;
        options.samples = 1000;
        const auto sampled = searchSampled(a, b, motion, options);
        CHECK(certified.certified);
        CHECK(std::includes(certified.pairs.begin(), certified.pairs.end(), sampled.pairs.begin(),
                            sampled.pairs.end()));
    }
}

TEST_CASE("a search ends where no number is left between the limits of a cell") {
    // At a lever of 1e9 two neighbouring angles are 4e-7 apart, a hundred times the tolerance. B comes from
    // the side and all but touches A at the last of them, by less than rounding could make of it and by more.
    const SphereSet a{{Vec3::Zero(), 1}}, b{{Vec3::Zero(), 1}};
    std::size_t touching = 0, clear = 0;
    double last = 3 + 1e-8;
    for (int k = -20; k <= 20; ++k) {
        INFO("gap " << k * 8e-7);
        last = std::nextafter(last, 4); // even and odd in turn: one rounds to the last, one before it
        const Dof turn = joints::turn({0, -1e9, 0}, {0, 0, 1}, 3, last);
        Motion motion;
        motion.dofs = {turn};
        motion.base = dofPose(turn, last).inverse() * Eigen::Translation3d(2 + k * 8e-7, 0, 0);
        CertifiedSearchOptions options;
        options.tolerance = 0;
        const auto found = searchCertified(a, b, motion, options);
        CHECK(found.certified);
        ++(found.pairs.empty() ? clear : touching);
    }
    CHECK(touching > 0);
    CHECK(clear > 0);
}

TEST_CASE("no pair is listed whose gap stays above margin and tolerance") {
    // One DOF, so that a fine grid knows every pair's smallest gap.
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        INFO("seed " << seed);
        const auto scene = scenes::randomScene(seed, 1, 30, true);
        auto options = colliding(0.002);
        options.margin = 0.01;
        const auto found = searchCertified(scene.a, scene.b, scene.motion, options);
        const Dof& dof = scene.motion.dofs[0];
        std::vector<Pose> poses;
        for (int k = 0; k <= 4000; ++k) {
            const double q = dof.lower + (dof.upper - dof.lower) * k / 4000.0;
            poses.push_back(pose(scene.motion, std::vector<double>{q}));
        }
        for (std::uint32_t i = 0; i < scene.a.size(); ++i)
            for (std::uint32_t j = 0; j < scene.b.size(); ++j) {
                double smallest = 1e9;
                for (const Pose& t : poses)
                    smallest = std::min(smallest, (t * scene.b[j].centre - scene.a[i].centre).norm() -
                                                      scene.a[i].radius - scene.b[j].radius);
                const bool listed =
                    std::binary_search(found.pairs.begin(), found.pairs.end(), SpherePair{i, j});
                if (smallest <= 0.01) CHECK(listed);
                if (smallest > 0.012 + 0.001)
                    CHECK_FALSE(listed); // the grid's own step moves less than 0.001
            }
    }
}

TEST_CASE("a hinge pair that never meets gets a proof with a clearance that holds") {
    auto scene = scenes::randomScene(4, 1, 60);
    scene.motion.dofs = {joints::turn({0, 0, 0}, {0, 0, 1}, -3, 3)};
    scene.motion.base.translation() = Vec3(0, 0, 2);
    const auto proof = searchCertified(scene.a, scene.b, scene.motion, colliding());
    REQUIRE(proof.certified);
    CHECK(proof.pairs.empty());
    CHECK(proof.clearance > 0);
    CHECK(proof.explored > 0);
    double smallest = 1e9;
    scenes::Random random(9);
    for (int k = 0; k < 500; ++k)
        smallest =
            std::min(smallest, queryAllPairs(scene.a, scene.b,
                                             pose(scene.motion, scenes::randomPose(random, scene.motion)))
                                   .gap);
    CHECK(proof.clearance <= smallest);
    CHECK(proof.clearance > 0.5 * smallest);
}

TEST_CASE("poses beyond a limit plane do not count") {
    // B slides towards A along x and would meet it at x + y > 1 only.
    const SphereSet a{{{0, 0, 0}, 0.5}}, b{{{-2, 0, 0}, 0.5}};
    Motion motion;
    motion.dofs = {joints::slide({1, 0, 0}, 0, 2), joints::slide({1, 0, 0}, 0, 2)};
    motion.planes = {{{1, 1}, 0.9}};
    CHECK(searchCertified(a, b, motion, colliding()).pairs.empty());
    motion.planes[0].bound = 1.1;
    CHECK(searchCertified(a, b, motion, colliding()).pairs.size() == 1);
}

TEST_CASE("a cell is shrunk to what the planes leave of it") {
    Motion motion;
    motion.dofs = {joints::slide({1, 0, 0}, 0, 1), joints::slide({0, 1, 0}, 0, 1)};
    motion.planes = {{{1, 2}, 0.5}};
    Cell cell = wholeBox(motion);
    REQUIRE(shrinkToPlanes(motion, cell));
    CHECK(cell.upper[0] == Approx(0.5));
    CHECK(cell.upper[1] == Approx(0.25));
    cell.lower = {0.4, 0.2};
    cell.upper = {1, 1};
    CHECK_FALSE(shrinkToPlanes(motion, cell));
}

TEST_CASE("the certified search is the same with one thread and with two") {
    const auto scene = scenes::jawLike(250, 250);
    const auto two = searchCertified(scene.a, scene.b, scene.motion);
    const ThreadLimit one(1);
    const auto single = searchCertified(scene.a, scene.b, scene.motion);
    CHECK(two.pairs == single.pairs);
    CHECK(two.explored == single.explored);
    CHECK(!two.pairs.empty());
}

TEST_CASE("a search that is stopped is not certified") {
    const auto scene = scenes::jawLike(100, 100);
    const auto stopped =
        searchCertified(scene.a, scene.b, scene.motion, {}, [](std::string_view, double) { return false; });
    CHECK_FALSE(stopped.certified);
}

TEST_CASE("searches of many spheres stop while their trees are built") {
    const auto scene = scenes::jawLike(3000, 3000);
    int nodes = 0;
    CHECK(SphereTree(scene.a, [&] { return ++nodes == 2000; }).empty());
    CHECK(nodes == 2000);
    const auto no = [](std::string_view, double) { return false; };
    const CandidatePairs certified = searchCertified(scene.a, scene.b, scene.motion, {}, no);
    CHECK_FALSE(certified.certified);
    CHECK(certified.pairs.empty());
    const CandidatePairs sampled = searchSampled(scene.a, scene.b, scene.motion, {}, no);
    CHECK(sampled.explored == 0);
    CHECK(sampled.pairs.empty());
    CHECK(provenClearance(scene.a, scene.b, scene.motion, nullptr, no) == 0);
    UndecidedOptions options;
    options.resolution = 0.1;
    const CellTree all = wholeQ(scene.motion);
    const Undecided undecided =
        undecidedCells(levelOf(scene.a), levelOf(scene.b), scene.motion, all, options, no);
    REQUIRE(undecided.cells);
    CHECK(undecided.cells->leaves() == all.leaves());
}

TEST_CASE("degenerate input: no spheres, no freedom, limits of zero width, too many DOFs") {
    auto scene = scenes::randomScene(1, 2, 20);
    CHECK(searchCertified({}, scene.b, scene.motion).certified);
    CHECK(searchCertified(scene.a, {}, scene.motion).pairs.empty());

    Motion fixed;
    fixed.base.translation() = Vec3(0.3, 0, 0);
    const auto still = searchCertified(scene.a, scene.b, fixed, colliding());
    std::size_t expected = 0;
    for (const Sphere& s : scene.a)
        for (const Sphere& t : scene.b)
            expected += (fixed.base * t.centre - s.centre).norm() <= s.radius + t.radius;
    CHECK(still.pairs.size() == expected);

    for (Dof& dof : fixed.dofs) dof.upper = dof.lower;
    fixed.dofs.push_back(joints::turn({0, 0, 0}, {0, 0, 1}, 0, 0));
    CHECK(searchCertified(scene.a, scene.b, fixed, colliding()).pairs.size() == expected);

    Motion endless;
    while (endless.dofs.size() <= maxDofs) endless.dofs.push_back(joints::slide({1, 0, 0}, 0, 1));
    CHECK_THROWS_AS(searchCertified(scene.a, scene.b, endless), InputError);
}

TEST_CASE("what touches at a limit by less than rounding makes of it is found, about axes far away too") {
    // B's sphere comes straight at A's and is 1e-12 deep in it at the upper limit; its place there rounds by
    // more. The truth is calculated with 64 bits.
    using Long = Eigen::Matrix<long double, 3, 1>;
    int shown = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        INFO("seed " << seed);
        scenes::Random random(seed);
        const double far = std::pow(10.0, random.in(3, 6)), way = random.in(0, 2 * std::numbers::pi);
        const double upper = random.in(0.001, 1) / far;
        const Vec3 origin(far * std::cos(way), far * std::sin(way), random.in(-1, 1));
        const SphereSet b{{random.inBox(1), random.in(0.1, 1)}};
        const Long from = b[0].centre.cast<long double>() - origin.cast<long double>();
        const long double c = std::cos((long double)upper), s = std::sin((long double)upper);
        const Long turned(c * from.x() - s * from.y(), s * from.x() + c * from.y(), from.z());
        const Long x = turned + origin.cast<long double>();
        const Long ahead = Long(-turned.y(), turned.x(), 0).normalized();
        const double radius = random.in(0.1, 1);
        const Long touching = x + ahead * ((long double)radius + b[0].radius - 1e-12L);
        const SphereSet a{{touching.cast<double>(), radius}};
        const long double depth =
            (long double)radius + b[0].radius - (a[0].centre.cast<long double>() - x).norm();
        REQUIRE(depth > 0);
        Motion motion;
        motion.dofs = {joints::turn(origin, Vec3::UnitZ(), 0, upper)};
        const double seen = (pose(motion, std::vector<double>{upper}) * b[0].centre - a[0].centre).norm() -
                            radius - b[0].radius;
        shown += seen > 0;
        const auto certified = searchCertified(a, b, motion, colliding());
        CHECK(certified.pairs.size() == 1);
    }
    CHECK(shown > 10); // calculated in double, these do not touch
}

TEST_CASE(
    "that spheres never meet is shown where they do not, and where one pair does so at one pose it is not") {
    // Two columns of spheres; one of B's swings in by a turn about its foot.
    SphereSet a, b;
    for (int i = 0; i < 40; ++i) {
        a.push_back({{0, 0, 0.1 * i}, 0.08});
        b.push_back({{1, 0, 0.1 * i}, 0.08});
    }
    const auto swung = [](double by) {
        Motion motion;
        motion.dofs = {joints::turn({1, 0, 0}, Vec3::UnitY(), -by, 0.1),
                       joints::turn({1, 0, 0}, Vec3::UnitX(), -0.1, 0.1)};
        return motion;
    };
    const double meets = std::asin((1 - 0.16) / 3.9); // about where the tops come together
    CHECK(neverCollide(a, b, swung(meets - 0.01), {}, 0));
    CHECK_FALSE(neverCollide(a, b, swung(meets + 0.01), {}, 0));
    CHECK_FALSE(neverCollide(a, b, swung(meets - 0.01), {}, 0.1));
    // Not where the only pair that meets is exempt.
    std::vector<char> last(40, 0);
    for (int i = 30; i < 40; ++i) last[i] = 1;
    CHECK(neverCollide(a, b, swung(meets + 0.01), {last, last, 1}, 0));
    CHECK(neverCollide({}, b, swung(1), {}, 0));
}
