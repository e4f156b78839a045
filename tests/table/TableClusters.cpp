#include "bake/table/TableKernels.h"
#include "tests/table/ExactGap.h"
#include "tests/table/RandomTable.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;
using random_table::Random;

namespace {

/// Some thousand tests over four to seven DOFs, so small that many poses are free.
Table clustered(Random& random, std::uint64_t seed) {
    const Motion motion = random_table::motion(random, 4 + int(seed % 4), 1, false);
    Table table = random_table::table(random, motion, 60, 60, 1);
    for (SphereSet* set : {&table.a, &table.b})
        for (Sphere& s : *set) s.radius *= 0.2;
    return table;
}

std::vector<std::uint32_t> under(const PreparedTable& table, const TableFeatures& f, double margin) {
    std::vector<std::uint32_t> tests(table.testRoom());
    tests.resize(table.testsWithin(f, margin, tests.data()));
    std::sort(tests.begin(), tests.end());
    return tests;
}

} // namespace

TEST_CASE("a table in clusters answers as without them, to the bit, and misses no touch") {
    long hits = 0, free = 0, listed = 0;
    for (const KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                      KernelTarget::Avx512, KernelTarget::Neon}) {
        if (!available(target)) continue;
        for (std::uint64_t seed = 1; seed <= 12; ++seed) {
            CAPTURE(name(target), seed);
            Random random(seed);
            const Table table = clustered(random, seed);
            const std::vector<TablePair> pairs = tablePairs(table);
            PrepareOptions whole, apart;
            whole.target = apart.target = target;
            whole.cells = CellUse::Never;
            const PreparedTable with(table, apart), without(table, whole);
            REQUIRE_FALSE(with.kernels().clusters().empty());
            REQUIRE(without.kernels().clusters().empty());
            for (int i = 0; i < 150; ++i) {
                const std::vector<double> q = random_table::values(random, table.motion);
                TableFeatures f, g;
                with.features(q.data(), f);
                without.features(q.data(), g);
                REQUIRE(with.hit(f) == without.hit(g));
                REQUIRE(with.hit(q.data()) == with.hit(f));
                REQUIRE(with.gap(f).gap == without.gap(g).gap);
                const double margin = random_table::between(random, 0, 0.3);
                const std::vector<std::uint32_t> near = under(with, f, margin);
                REQUIRE(near == under(without, g, margin));
                listed += long(near.size());
                if (exact::gap(table.motion, pairs, q) <= 0) REQUIRE(with.hit(f));
                (with.hit(f) ? hits : free) += 1;
            }
        }
    }
    CAPTURE(hits, free, listed);
    CHECK(hits > 100);
    CHECK(free > 100);
    CHECK(listed > 1000);
}

TEST_CASE("a cluster's bound is no farther apart than any of its tests, at any pose") {
    for (std::uint64_t seed = 20; seed < 30; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const Table table = clustered(random, seed);
        const std::vector<TablePair> pairs = tablePairs(table);
        const TableClusters clusters(pairs, 8);
        REQUIRE(clusters.order().size() == pairs.size());
        REQUIRE(clusters.testsEach() % 8 == 0);
        REQUIRE(clusters.count() <= TableClusters::most);
        for (int i = 0; i < 20; ++i) {
            const std::vector<double> q = random_table::values(random, table.motion);
            for (std::size_t place = 0; place < pairs.size(); ++place) {
                const TablePair& bound = clusters.bounds()[place / clusters.testsEach()];
                REQUIRE(exact::gap(table.motion, bound, q) <=
                        exact::gap(table.motion, pairs[clusters.order()[place]], q));
            }
        }
    }
}
