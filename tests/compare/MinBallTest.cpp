#include "bake/compare/MinBall.h"
#include "bake/compare/EnclosingTree.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;
using namespace tss::compare;

namespace {

SphereSet randomBalls(std::mt19937_64& random, std::size_t count, double radius) {
    std::uniform_real_distribution<double> any(-1, 1), size(0, radius);
    SphereSet balls;
    for (std::size_t k = 0; k < count; ++k)
        balls.push_back({Vec3(any(random), 2 * any(random), 0.5 * any(random)), size(random)});
    return balls;
}

bool contains(const Sphere& big, const Sphere& small) {
    return (big.centre - small.centre).norm() + small.radius <= big.radius * (1 + 1e-12);
}

} // namespace

TEST_CASE("every enclosing ball contains its balls, and the minimal one is the smallest") {
    const std::uint64_t seed = 21;
    INFO("seed " << seed);
    std::mt19937_64 random(seed);
    for (int round = 0; round < 100; ++round) {
        const SphereSet balls = randomBalls(random, 2 + static_cast<std::size_t>(round), 0.5);
        const Sphere least = enclosingBall(balls, Enclosure::Balls);
        for (const Enclosure how :
             {Enclosure::Box, Enclosure::Points, Enclosure::Balls, Enclosure::CoreSet}) {
            const Sphere ball = enclosingBall(balls, how);
            CHECK(least.radius <= ball.radius * (1 + 1e-9));
            for (const Sphere& small : balls) CHECK(contains(ball, small));
        }
        CHECK(coreSetBall(balls, 0.1).radius <= 1.1 * least.radius);
    }
}

TEST_CASE(
    "enclosing balls of degenerate sets: one ball, equal balls, balls within balls, on a line, on a sphere") {
    const Sphere one{Vec3(1, 2, 3), 0.5};
    std::vector<SphereSet> sets{{one}, {one, one, one}, {one, {Vec3(1, 2, 3.1), 0.1}, {Vec3(1, 2, 2.9), 0}}};
    SphereSet line, cube;
    for (int k = 0; k < 10; ++k) line.push_back({Vec3(k, 0, 0), 0});
    for (int k = 0; k < 8; ++k) cube.push_back({Vec3(k & 1 ? 1 : 0, k & 2 ? 1 : 0, k & 4 ? 1 : 0), 0});
    sets.push_back(line);
    sets.push_back(cube);
    for (const SphereSet& balls : sets)
        for (const Enclosure how :
             {Enclosure::Box, Enclosure::Points, Enclosure::Balls, Enclosure::CoreSet}) {
            const Sphere ball = enclosingBall(balls, how);
            CHECK(ball.centre.allFinite());
            for (const Sphere& small : balls) CHECK(contains(ball, small));
        }
    CHECK(enclosingBall(cube, Enclosure::Points).radius == Approx(std::sqrt(0.75)));
    CHECK(enclosingBall(line, Enclosure::Balls).radius == Approx(4.5));
}

TEST_CASE("a ball tree holds each sphere once and each ball holds all spheres below it") {
    std::mt19937_64 random(5);
    const SphereSet spheres = randomBalls(random, 333, 0.1);
    for (const int arity : {2, 4, 8}) {
        const EnclosingTree tree = buildEnclosingTree(spheres, arity, Enclosure::Balls);
        std::vector<std::uint32_t> parent(tree.nodes.size(), 0);
        std::size_t leaves = 0;
        for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
            const EnclosingTree::Node& node = tree.nodes[i];
            CHECK(node.count <= static_cast<std::uint32_t>(arity));
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k) parent[k] = i;
            if (node.count > 0) continue;
            ++leaves;
            for (std::uint32_t up = i; up != 0;) {
                up = parent[up];
                CHECK(contains({tree.nodes[up].centre, tree.nodes[up].radius}, {node.centre, node.radius}));
            }
        }
        CHECK(leaves == spheres.size());
    }
}
