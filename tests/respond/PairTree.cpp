#include "bake/respond/PairTree.h"

#include "bake/table/TablePairs.h"
#include "tests/respond/Walk.h"

#include <catch2/catch.hpp>
#include <set>

using namespace tss;
using random_table::between;
using random_table::Random;

namespace {

SphereSet scattered(Random& random, std::size_t count) {
    SphereSet spheres;
    for (std::size_t i = 0; i < count; ++i)
        spheres.push_back(
            {Vec3{between(random, 2, 4), between(random, -0.2, 0.2), between(random, -0.3, 0.1)},
             between(random, 0.001, 0.08)});
    return spheres;
}

Pose posed(Random& random) {
    Pose pose = Pose::Identity();
    const Vec3 axis{between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)};
    pose.linear() = Eigen::AngleAxisd(between(random, -3, 3), axis.normalized()).toRotationMatrix();
    const Vec3 middle(3, 0, -0.1);
    const Vec3 off{between(random, -0.5, 0.5), between(random, -0.5, 0.5), between(random, -0.5, 0.5)};
    pose.translation() = middle + off - pose.linear() * middle;
    return pose;
}

} // namespace

TEST_CASE(
    "a tree of pairs finds every test within a margin, no pair that is no test, and hardly any beyond") {
    Random random(3);
    std::size_t asked = 0, near = 0, beyond = 0;
    for (const auto& [countA, countB, share] :
         {std::tuple{1, 1, 1.0}, {3, 700, 0.5}, {90, 64, 1.0}, {600, 65, 0.02}}) {
        CAPTURE(countA, countB, share);
        const SphereSet a = scattered(random, countA), b = scattered(random, countB);
        std::vector<SpherePair> pairs;
        for (std::uint32_t i = 0; i < a.size(); ++i)
            for (std::uint32_t j = 0; j < b.size(); ++j)
                if (between(random, 0, 1) < share) pairs.push_back({i, j});
        std::vector<double> rest;
        if (share == 0.5) rest.assign(pairs.size(), -0.01);
        const Table table = makeTable(a, b, pairs, rest, Motion{});
        const std::vector<TablePair> tests = tablePairs(table);
        for (const KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                          KernelTarget::Avx512, KernelTarget::Neon}) {
            if (!available(target)) continue;
            const PairTree tree(table, target);
            std::vector<std::uint32_t> found(tests.size() + 1);
            for (int i = 0; i < 60; ++i) {
                const Pose pose = posed(random);
                const double margin = between(random, 0, 0.1);
                const std::uint32_t count = tree.testsWithin(pose, margin, ~0u, found.data());
                const std::set<std::uint32_t> unique(found.begin(), found.begin() + count);
                REQUIRE(unique.size() == count);
                for (std::uint32_t k = 0; k < tests.size(); ++k) {
                    const double gap = centreDistance(tests[k], pose) - tests[k].contactDistance;
                    if (gap <= margin) REQUIRE(unique.contains(k));
                    near += gap <= margin;
                    beyond += unique.contains(k) && gap > margin + 1e-4 + (rest.empty() ? 0 : 0.01);
                }
                asked += tests.size();
                if (count > 20) {
                    const std::uint32_t few = tree.testsWithin(pose, margin, 10, found.data());
                    REQUIRE(few > 10);
                    REQUIRE(few <= count);
                }
            }
        }
    }
    CAPTURE(asked, near);
    CHECK(near > 2000);
    CHECK(beyond == 0);
}
