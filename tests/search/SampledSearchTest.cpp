#include "bake/search/SampledSearch.h"
#include "bake/base/Parallel.h"
#include "bake/table/Query.h"
#include "tests/search/Scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace tss;

namespace {

std::set<SpherePair> everyCollidingPair(const scenes::Scene& scene,
                                        const std::vector<std::vector<double>>& poses) {
    std::set<SpherePair> found;
    for (const auto& q : poses) {
        const Pose t = pose(scene.motion, q);
        for (std::uint32_t i = 0; i < scene.a.size(); ++i)
            for (std::uint32_t j = 0; j < scene.b.size(); ++j)
                if ((t * scene.b[j].centre - scene.a[i].centre).norm() <=
                    scene.a[i].radius + scene.b[j].radius)
                    found.insert({i, j});
    }
    return found;
}

} // namespace

TEST_CASE("the sampled search records every pair that collides at an explored pose and no other") {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const auto scene = scenes::randomScene(seed, 1 + int(seed % 4), 60, seed % 2);
        INFO("seed " << seed);
        SampledSearchOptions options;
        options.samples = 300;
        const auto found = searchSampled(scene.a, scene.b, scene.motion, options);
        const auto expected = everyCollidingPair(scene, exploredPoses(scene.motion, 300, options.seed));
        CHECK(std::vector<SpherePair>(expected.begin(), expected.end()) == found.pairs);
        CHECK_FALSE(found.certified);
    }
}

TEST_CASE("explored poses include both limits, stay inside the planes and repeat with the seed") {
    auto scene = scenes::randomScene(3, 2, 1);
    scene.motion.planes.push_back({{1, 1}, 0.1});
    const auto poses = exploredPoses(scene.motion, 1000, 7);
    CHECK(poses.size() > 300);
    CHECK(poses == exploredPoses(scene.motion, 1000, 7));
    CHECK(poses != exploredPoses(scene.motion, 1000, 8));
    const auto lowest = std::vector<double>{scene.motion.dofs[0].lower, scene.motion.dofs[1].lower};
    CHECK(std::find(poses.begin(), poses.end(), lowest) != poses.end());
    for (const auto& q : poses) CHECK(withinLimits(scene.motion, q));
}

TEST_CASE("of many values some corners are explored, and no more poses than are asked for") {
    Motion motion;
    for (int k = 0; k < 24; ++k) motion.dofs.push_back(joints::turn({0, 0, 0}, {0, 0, 1}, -0.1 * k, 1));
    const auto poses = exploredPoses(motion, 128, 1);
    CHECK(poses.size() == 128);
    const auto isCorner = [&](const std::vector<double>& q) {
        for (std::size_t k = 0; k < q.size(); ++k)
            if (q[k] != motion.dofs[k].lower && q[k] != 1) return false;
        return true;
    };
    CHECK(std::ranges::count_if(poses, isCorner) == 64);
    for (std::size_t k = 0; k < 24; ++k) { // each value is at either limit
        CHECK(std::ranges::any_of(poses, [&](const auto& q) { return q[k] == motion.dofs[k].lower; }));
        CHECK(std::ranges::any_of(poses, [&](const auto& q) { return q[k] == 1; }));
    }
    motion.dofs.resize(7); // all of their corners are not twice as many
    CHECK(exploredPoses(motion, 128, 1).size() == 192);
}

TEST_CASE("a motion without freedom is explored at its one pose") {
    Motion fixed;
    CHECK(exploredPoses(fixed, 100, 1).size() == 1);
    fixed.dofs.push_back(joints::turn({0, 0, 0}, {0, 0, 1}, 0.3, 0.3));
    CHECK(exploredPoses(fixed, 100, 1) == std::vector<std::vector<double>>{{0.3}});
}

TEST_CASE("the sampled search finds the same pairs with one thread and with two") {
    const auto scene = scenes::jawLike(300, 300);
    SampledSearchOptions options;
    options.samples = 500;
    const auto two = searchSampled(scene.a, scene.b, scene.motion, options);
    const ThreadLimit one(1);
    const auto single = searchSampled(scene.a, scene.b, scene.motion, options);
    CHECK(two.pairs == single.pairs);
    CHECK_FALSE(two.pairs.empty());
}

TEST_CASE("empty sphere sets have no candidates") {
    const auto scene = scenes::randomScene(1, 2, 5);
    CHECK(searchSampled({}, scene.b, scene.motion).pairs.empty());
    CHECK(searchSampled(scene.a, {}, scene.motion).pairs.empty());
}

TEST_CASE("a pair of the region that overlaps at rest counts from its depth there, or not at all, or as any "
          "other") {
    SphereSet a{{{0, 0, 0}, 1}}, b{{{1.5, 0, 0}, 1}};
    Motion slide;
    slide.dofs.push_back(joints::slide({-1, 0, 0}, -3, 1));
    SampledSearchOptions options;
    options.rule = ruleOfSpheres(a, b, slide, AtRest::Offset);
    const auto offset = searchSampled(a, b, slide, options);
    REQUIRE(offset.pairs.size() == 1);
    CHECK(offset.restGaps[0] == Approx(-0.5).margin(1e-5));
    CHECK(offset.restGaps[0] < -0.5);
    options.rule = ruleOfSpheres(a, b, slide, AtRest::Ignore);
    const auto ignored = searchSampled(a, b, slide, options);
    CHECK(ignored.pairs.empty());
    options.rule = ruleOfSpheres(a, b, slide, AtRest::Collide);
    const auto collide = searchSampled(a, b, slide, options);
    CHECK(collide.pairs.size() == 1);
    CHECK(collide.restGaps.empty());
    const auto touchingPoses = [&](AtRest mode) {
        const ContactRule rule = ruleOfSpheres(a, b, slide, mode);
        return std::ranges::count_if(exploredPoses(slide, options.samples, options.seed), [&](const auto& q) {
            const double apart = (pose(slide, q) * b[0].centre - a[0].centre).norm();
            return rule.touches({0, 0}, apart - a[0].radius - b[0].radius);
        });
    };
    CHECK(touchingPoses(AtRest::Offset) < touchingPoses(AtRest::Collide));
}
