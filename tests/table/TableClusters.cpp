#include "bake/table/LikelyTests.h"
#include "bake/table/TableKernels.h"
#include "tests/Joints.h"
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

std::vector<std::uint32_t> testsWithin(const PreparedTable& table, const TableFeatures& f, double margin) {
    std::vector<std::uint32_t> tests(table.testRoom());
    tests.resize(table.testsWithin(f, margin, tests.data()));
    std::sort(tests.begin(), tests.end());
    return tests;
}

/// The features of each at values at which both are to say the same.
std::pair<TableFeatures, TableFeatures> answersAlike(const PreparedTable& with, const PreparedTable& without,
                                                     const std::vector<double>& q) {
    std::pair<TableFeatures, TableFeatures> features;
    auto& [f, g] = features;
    with.features(q.data(), f);
    without.features(q.data(), g);
    REQUIRE(with.hit(f) == without.hit(g));
    REQUIRE(with.hit(q.data()) == with.hit(f));
    REQUIRE(with.gap(f).gap == without.gap(g).gap);
    return features;
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
            constexpr std::uint32_t count = 150;
            std::vector<double> all;
            for (std::uint32_t i = 0; i < count; ++i)
                for (const double v : random_table::values(random, table.motion)) all.push_back(v);
            InstanceFeatures instances;
            instances.floats = {1}; // of a question before
            with.instanceFeatures(all.data(), count, instances);
            std::vector<std::uint8_t> instanceHits(count);
            with.hits(instances, instanceHits.data());
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::size_t dofs = table.motion.dofCount();
                const std::vector<double> q(all.begin() + i * dofs, all.begin() + (i + 1) * dofs);
                const auto [f, g] = answersAlike(with, without, q);
                const double margin = random_table::between(random, 0, 0.3);
                const std::vector<std::uint32_t> near = testsWithin(with, f, margin);
                REQUIRE(near == testsWithin(without, g, margin));
                listed += long(near.size());
                REQUIRE(bool(instanceHits[i]) == with.hit(f));
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

TEST_CASE("a table of very many tests over few DOFs is in clusters, and answers as without them") {
    Random random(4);
    Motion motion;
    for (int k = 0; k < 3; ++k)
        motion.dofs.push_back(joints::turn(Vec3::Constant(0.1 * k), Vec3::Unit(k), -3, 3));
    Table table = random_table::table(random, motion, 280, 280, 1);
    REQUIRE(tablePairs(table).size() > 1 << 16);
    for (SphereSet* set : {&table.a, &table.b})
        for (Sphere& s : *set) s.radius *= 0.13;
    PrepareOptions whole;
    whole.cells = CellUse::Never;
    const PreparedTable with(table), without(table, whole);
    REQUIRE_FALSE(with.kernels().clusters().empty());
    int hits = 0;
    for (int i = 0; i < 200; ++i) {
        const std::vector<double> q = random_table::values(random, motion);
        const TableFeatures f = answersAlike(with, without, q).first;
        hits += with.hit(f);
    }
    CHECK(hits > 20);
    CHECK(hits < 180);
}

TEST_CASE("poses side by side touch where each of them does, on every kind of kernels") {
    long hits = 0, free = 0;
    for (const KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                      KernelTarget::Avx512, KernelTarget::Neon}) {
        if (!available(target)) continue;
        for (std::uint64_t seed = 40; seed < 48; ++seed) {
            CAPTURE(name(target), seed);
            Random random(seed);
            const Table table = clustered(random, seed);
            PrepareOptions options;
            options.target = target;
            options.poseError = 1e-12;
            const PreparedTable prepared(table, options);
            const TableKernels& kernels = prepared.kernels();
            REQUIRE_FALSE(kernels.likely().empty());
            for (int i = 0; i < 10; ++i) {
                // A stands anywhere.
                BodyLanes a, b;
                PoseLanes poses;
                std::vector<std::vector<double>> q;
                const Pose atA = Pose(Eigen::AngleAxisd(i, random_table::direction(random))) *
                                 Eigen::Translation3d(random_table::inBall(random, 2));
                for (std::uint32_t lane = 0; lane < poseLanes; ++lane) {
                    q.push_back(random_table::values(random, table.motion));
                    const Pose atB = atA * pose(table.motion, q.back());
                    for (int k = 0; k < 12; ++k) {
                        a.numbers[k][lane] = atA(k / 4, k % 4);
                        b.numbers[k][lane] = atB(k / 4, k % 4);
                    }
                }
                kernels.features(a, b, poses);
                const std::uint32_t asked = static_cast<std::uint32_t>(random() % (1u << poseLanes));
                const std::uint32_t found = kernels.hits(poses, asked);
                REQUIRE((found & ~asked) == 0);
                for (std::uint32_t lane = 0; lane < poseLanes; ++lane) {
                    if ((asked >> lane & 1) == 0) continue;
                    const double gap = double(exact::gap(table.motion, tablePairs(table), q[lane]));
                    if (gap <= 0) REQUIRE((found >> lane & 1) == 1);
                    if (gap > prepared.signBand()) REQUIRE((found >> lane & 1) == 0);
                    (gap <= 0 ? hits : free) += 1;
                }
            }
        }
    }
    CAPTURE(hits, free);
    CHECK(hits > 100);
    CHECK(free > 100);
}

TEST_CASE("points of two bodies are near in the lanes in which they are") {
    Random random(3);
    for (const KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                      KernelTarget::Avx512, KernelTarget::Neon}) {
        if (!available(target)) continue;
        CAPTURE(name(target));
        BodyLanes a, b;
        std::vector<Pose> placesA, placesB;
        for (std::uint32_t lane = 0; lane < poseLanes; ++lane)
            for (auto& [lanes, places] : {std::pair(&a, &placesA), std::pair(&b, &placesB)}) {
                places->push_back(Pose(Eigen::AngleAxisd(lane, random_table::direction(random))) *
                                  Eigen::Translation3d(random_table::inBall(random, 1)));
                for (int k = 0; k < 12; ++k) lanes->numbers[k][lane] = places->back()(k / 4, k % 4);
            }
        const Vec3 inA = random_table::inBall(random, 1), inB = random_table::inBall(random, 1);
        const std::uint32_t near = laneKernels(target).near(a, inA, b, inB, 1.5);
        for (std::uint32_t lane = 0; lane < poseLanes; ++lane)
            CHECK((near >> lane & 1) == ((placesB[lane] * inB - placesA[lane] * inA).squaredNorm() <= 1.5));
        CHECK(near != 0);
        CHECK(near != (1u << poseLanes) - 1);
    }
}

TEST_CASE("tests asked first are those that touch at most poses, each where none before it does") {
    Random random(4);
    std::vector<TablePair> pairs;
    for (int i = 0; i < 40; ++i) {
        TablePair pair;
        pair.a = random_table::inBall(random, 1);
        pair.b = random_table::inBall(random, 1);
        pair.contactDistance = 0.4;
        pairs.push_back(pair);
    }
    std::vector<TouchingPose> poses;
    for (int i = 0; i < 200; ++i) {
        TouchingPose at{Pose(Eigen::Translation3d(random_table::inBall(random, 1))), 0};
        double least = 0;
        for (std::uint32_t k = 0; k < pairs.size(); ++k)
            if (const double gap = centreDistance(pairs[k], at.pose) - pairs[k].contactDistance; gap < least)
                least = gap, at.test = k;
        if (least < 0) poses.push_back(at);
    }
    REQUIRE(poses.size() > 50);
    const auto ended = [&](std::span<const std::uint32_t> tests) {
        return std::count_if(poses.begin(), poses.end(), [&](const TouchingPose& at) {
            return std::any_of(tests.begin(), tests.end(), [&](std::uint32_t test) {
                return centreDistance(pairs[test], at.pose) <= pairs[test].contactDistance;
            });
        });
    };
    const std::vector<std::uint32_t> few = likelyTests(pairs, poses, 5);
    REQUIRE(few.size() == 5);
    for (std::uint32_t k = 0; k < pairs.size(); ++k) CHECK(ended({&k, 1}) <= ended({few.data(), 1}));
    for (std::size_t n = 1; n < few.size(); ++n) CHECK(ended({few.data(), n}) < ended({few.data(), n + 1}));
    const std::vector<std::uint32_t> all = likelyTests(pairs, poses, pairs.size());
    CHECK(std::size_t(ended(all)) == poses.size());
    CHECK(all.size() < pairs.size());
    CHECK(likelyTests(pairs, {}, 5).empty());
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
        REQUIRE(clusters.levels().back().size() <= TableClusters::mostAtTop);
        for (int i = 0; i < 20; ++i) {
            const std::vector<double> q = random_table::values(random, table.motion);
            for (std::size_t place = 0; place < pairs.size(); ++place) {
                std::size_t at = place / clusters.testsEach();
                for (const std::vector<TablePair>& level : clusters.levels()) {
                    REQUIRE(exact::gap(table.motion, level[at], q) <=
                            exact::gap(table.motion, pairs[clusters.order()[place]], q));
                    at /= clusters.ofGroup();
                }
            }
        }
    }
}
