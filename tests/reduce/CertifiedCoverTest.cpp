#include "bake/reduce/CertifiedCover.h"
#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/reduce/CoverProof.h"
#include "bake/search/CertifiedSearch.h"
#include "bake/table/Query.h"
#include "tests/search/Scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;

namespace {

/// The worst lag of a table behind the models: largest gap of the table - max(gap of the models, -depth) over
/// the poses where the models' gap is <= margin. Random poses, and near-contact ones from bisected segments.
struct Lag {
    double worst = -1e9;
    int owed = 0;
};

void look(const scenes::Scene& scene, const Table& table, const CoverOptions& o, const std::vector<double>& q,
          Lag& lag) {
    if (!withinLimits(scene.motion, q)) return;
    const double models = queryAllPairs(scene.a, scene.b, pose(scene.motion, q)).gap;
    if (models > o.gapMargin) return;
    ++lag.owed;
    lag.worst = std::max(lag.worst, query(table, q).gap - std::max(models, -o.gapDepth));
}

Lag measure(const scenes::Scene& scene, const CoverOptions& options, const CoverResult& cover, int poses,
            std::uint64_t seed) {
    const Table table = makeTable(scene.a, scene.b, cover.pairs, cover.restGaps, scene.motion);
    scenes::Random random(seed);
    Lag lag;
    std::vector<double> free, hit;
    for (int k = 0; k < poses; ++k) {
        const auto q = scenes::randomPose(random, scene.motion);
        look(scene, table, options, q, lag);
        const bool touches = queryAllPairs(scene.a, scene.b, pose(scene.motion, q)).gap <= 0;
        (touches ? hit : free) = q;
        if (k % 4 || free.empty() || hit.empty()) continue;
        auto from = free, to = hit;
        for (int step = 0; step < 30; ++step) {
            std::vector<double> middle(from.size());
            for (std::size_t i = 0; i < from.size(); ++i) middle[i] = 0.5 * (from[i] + to[i]);
            (queryAllPairs(scene.a, scene.b, pose(scene.motion, middle)).gap <= 0 ? to : from) = middle;
        }
        look(scene, table, options, to, lag);
        look(scene, table, options, from, lag);
    }
    return lag;
}

CoverOptions colliding(double epsilon = 0, double depth = 0, double margin = 0) {
    CoverOptions o;
    o.epsilon = epsilon;
    o.gapDepth = depth;
    o.gapMargin = margin;
    return o;
}

constexpr double rounding = 1e-10;

} // namespace

TEST_CASE("a lossless cover touches at every pose where the models touch") {
    int scenesThatMeet = 0;
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        INFO("seed " << seed);
        const int dofs = 1 + int(seed % 4);
        const auto scene = scenes::randomScene(seed, dofs, dofs < 4 ? 40 : 15, seed % 3 == 0);
        const auto cover = certifiedCover(scene.a, scene.b, nullptr, scene.motion, colliding());
        REQUIRE(cover.complete);
        CHECK(cover.epsilon == 0);
        CHECK(cover.lowerBound <= double(cover.pairs.size()));
        const Lag lag = measure(scene, colliding(), cover, 1500, seed);
        CHECK(lag.worst <= rounding);
        scenesThatMeet += lag.owed > 0;
    }
    CHECK(scenesThatMeet > 12);
}

TEST_CASE(
    "a cover with a tolerance lags by no more than it, and gap-true ones are true throughout their band") {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        INFO("seed " << seed);
        const auto scene = scenes::randomScene(seed, 1 + int(seed % 3), 40, seed % 2);
        for (const CoverOptions& o : {colliding(0.01), colliding(0.005, 0.05), colliding(0.01, 0.1, 0.05),
                                      colliding(0.002, 0, 0.02)}) {
            const auto cover = certifiedCover(scene.a, scene.b, nullptr, scene.motion, o);
            REQUIRE(cover.complete);
            CHECK(measure(scene, o, cover, 600, seed).worst <= o.epsilon + rounding);
        }
    }
}

TEST_CASE("a looser tolerance never has a larger lower bound than the lossless table has pairs") {
    const auto scene = scenes::randomScene(5, 2, 60);
    const auto lossless = certifiedCover(scene.a, scene.b, nullptr, scene.motion, colliding());
    const auto loose = certifiedCover(scene.a, scene.b, nullptr, scene.motion, colliding(0.05));
    CHECK(loose.lowerBound <= double(lossless.pairs.size()));
    CHECK(loose.pairs.size() <= lossless.pairs.size());
}

TEST_CASE("a jaw-like pair gets a small lossless table near its lower bound") {
    const auto scene = scenes::jawLike(1158, 812);
    const auto cover = certifiedCover(scene.a, scene.b, nullptr, scene.motion);
    REQUIRE(cover.complete);
    CHECK(cover.pairs.size() < 100);
    CHECK(double(cover.pairs.size()) <= 1.2 * cover.lowerBound);
    CHECK(cover.forced <= 3);
    const auto again = certifiedCover(scene.a, scene.b, nullptr, scene.motion);
    CHECK(again.pairs == cover.pairs);
}

TEST_CASE("the cover is the same with one thread and with two") {
    const auto scene = scenes::jawLike(400, 300);
    for (const CoverOptions& o : {colliding(), colliding(0.05), colliding(0.01, 1, 0.5)}) {
        const auto two = certifiedCover(scene.a, scene.b, nullptr, scene.motion, o);
        const ThreadLimit one(1);
        const auto single = certifiedCover(scene.a, scene.b, nullptr, scene.motion, o);
        CHECK(two.pairs == single.pairs);
        CHECK(two.cells == single.cells);
        CHECK(two.lowerBound == single.lowerBound);
        CHECK(!two.pairs.empty());
    }
}

TEST_CASE("a pair that never meets has an empty cover and a clearance") {
    auto scene = scenes::randomScene(4, 1, 60);
    scene.motion.dofs = {joints::turn({0, 0, 0}, {0, 0, 1}, -3, 3)};
    scene.motion.base.translation() = Vec3(0, 0, 2);
    const auto cover = certifiedCover(scene.a, scene.b, nullptr, scene.motion);
    CHECK(cover.complete);
    CHECK(cover.pairs.empty());
    CHECK(cover.clearance > 0);
}

TEST_CASE("a search cut short says truthfully how far it got") {
    int cutShort = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const auto scene = scenes::randomScene(seed, 3, 50);
        for (std::uint64_t looks : {20'000u, 200'000u, 800'000u}) {
            INFO("seed " << seed << " looks " << looks);
            auto o = colliding();
            o.looks = looks;
            const auto cover = certifiedCover(scene.a, scene.b, nullptr, scene.motion, o);
            cutShort += !cover.complete;
            CHECK(cover.complete == (cover.epsilon == 0));
            if (!cover.pairs.empty())
                CHECK(measure(scene, o, cover, 400, seed).worst <= cover.epsilon + rounding);
            const auto again = certifiedCover(scene.a, scene.b, nullptr, scene.motion, o);
            CHECK(again.pairs == cover.pairs);
            CHECK(again.epsilon == cover.epsilon);
            o.coarser = false;
            const auto whole = certifiedCover(scene.a, scene.b, nullptr, scene.motion, o);
            CHECK((!whole.complete || cover.complete)); // it may give up earlier
            CHECK((std::isinf(whole.epsilon) && whole.pairs.empty()) == !whole.complete);
        }
    }
    CHECK(cutShort > 3);
    const auto scene = scenes::jawLike(100, 100);
    const auto stopped = certifiedCover(scene.a, scene.b, nullptr, scene.motion, {},
                                        [](std::string_view, double) { return false; });
    CHECK_FALSE(stopped.complete);
    CHECK(stopped.epsilon > 0);
}

TEST_CASE("chains of 1 to 6 DOFs with paths and coupled limits get a proof, or the epsilon that the budget "
          "reached") {
    int complete = 0, cutShort = 0;
    for (int dofs = 1; dofs <= 6; ++dofs)
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            INFO(dofs << " DOFs, seed " << seed);
            auto scene = scenes::randomScene(100 * std::uint64_t(dofs) + seed, dofs, 12, true);
            scenes::Random random(seed);
            scene.motion.dofs[0] = scenes::path(random, 5, 0.15, 0.2);
            if (dofs > 1) {
                LimitPlane plane{std::vector<double>(scene.motion.dofCount(), 0.0), 0.2};
                for (double& c : plane.coefficients) c = random.in(-1, 1);
                scene.motion.planes = {plane};
            }
            auto o = colliding();
            o.looks = 2'000'000;
            CertifiedSearchOptions search;
            search.effort = 300000;
            const CandidatePairs candidates = searchCertified(scene.a, scene.b, scene.motion, search);
            CHECK((candidates.certified || dofs > 2));
            const auto cover = certifiedCover(scene.a, scene.b, nullptr, scene.motion, o);
            (cover.complete ? complete : cutShort) += 1;
            CHECK(cover.complete == (cover.epsilon == 0));
            for (const SpherePair& pair : candidates.certified ? cover.pairs : std::vector<SpherePair>{})
                CHECK(std::binary_search(candidates.pairs.begin(), candidates.pairs.end(), pair));
            if (std::isfinite(cover.epsilon) && !cover.pairs.empty())
                CHECK(measure(scene, o, cover, 400, seed).worst <= cover.epsilon + rounding);
        }
    CHECK(complete >= 6);
    CHECK(cutShort >= 3);
}

TEST_CASE("only poses inside the limit planes are owed an answer") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        INFO("seed " << seed);
        auto scene = scenes::randomScene(seed, 2, 60);
        const auto whole = certifiedCover(scene.a, scene.b, nullptr, scene.motion, colliding());
        scene.motion.planes = {{{1, 0.7}, 0.05}, {{-1, 0.3}, 0.2}};
        const auto cut = certifiedCover(scene.a, scene.b, nullptr, scene.motion, colliding());
        REQUIRE(cut.complete);
        CHECK(cut.pairs.size() <= whole.pairs.size());
        CHECK(measure(scene, colliding(), cut, 1500, seed).worst <= rounding);
    }
}

TEST_CASE("spheres that coincide or lie inside others need no pairs of their own") {
    const auto scene = scenes::randomScene(8, 2, 40);
    const auto plain = certifiedCover(scene.a, scene.b, nullptr, scene.motion, colliding());
    auto doubled = scene;
    for (const Sphere& s : scene.a) {
        doubled.a.push_back(s);
        doubled.a.push_back({s.centre + Vec3(0.001, 0, 0), 0.5 * s.radius});
    }
    doubled.b.insert(doubled.b.end(), scene.b.begin(), scene.b.end());
    const auto cover = certifiedCover(doubled.a, doubled.b, nullptr, doubled.motion, colliding());
    REQUIRE(cover.complete);
    CHECK(cover.pairs.size() <= plain.pairs.size() + 2);
    CHECK(cover.forced <= plain.forced);
    CHECK(measure(doubled, colliding(), cover, 1000, 8).worst <= rounding);
}

TEST_CASE("degenerate covers: no spheres, no freedom, limits of zero width, points") {
    const auto scene = scenes::randomScene(1, 2, 30);
    CHECK(certifiedCover({}, scene.b, nullptr, scene.motion).complete);
    CHECK(certifiedCover(scene.a, {}, nullptr, scene.motion).pairs.empty());

    auto still = scene;
    still.motion.dofs.clear();
    still.motion.base.translation() = Vec3(0.3, 0, 0);
    auto cover = certifiedCover(still.a, still.b, nullptr, still.motion, colliding());
    REQUIRE(cover.complete);
    CHECK(cover.pairs.size() == 1);
    still.motion.dofs = {joints::turn({1, 0, 0}, {0, 0, 1}, 0, 0), joints::slide({1, 0, 0}, 0.1, 0.1)};
    cover = certifiedCover(still.a, still.b, nullptr, still.motion, colliding());
    CHECK(cover.pairs.size() == 1);

    auto points = scene;
    for (auto* set : {&points.a, &points.b})
        for (Sphere& s : *set) s.radius = 0;
    CHECK(certifiedCover(points.a, points.b, nullptr, points.motion, colliding()).complete);
    auto options = colliding();
    options.epsilon = -1;
    CHECK_THROWS_AS(certifiedCover(scene.a, scene.b, nullptr, scene.motion, options), InputError);
}

TEST_CASE("with a list of candidates the answer is about those pairs alone") {
    const auto scene = scenes::randomScene(2, 2, 60);
    CandidatePairs some;
    for (std::uint32_t i = 0; i < 30; ++i)
        for (std::uint32_t j = 0; j < 60; ++j) some.pairs.push_back({i, j});
    const auto cover = certifiedCover(scene.a, scene.b, &some, scene.motion, colliding());
    auto half = scene;
    half.a.resize(30);
    CHECK(measure(half, colliding(), cover, 1000, 3).worst <= rounding);
    for (const SpherePair& p : cover.pairs) CHECK(p.a < 30);
}

TEST_CASE("pairs that overlap at rest are answered from their gap at rest on") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        INFO("seed " << seed);
        auto scene = scenes::randomScene(seed, 2, 25);
        scene.motion.base.translation() *= 0.75; // they overlap at rest
        CoverOptions options;
        const ContactRule rule = ruleOfSpheres(scene.a, scene.b, scene.motion, AtRest::Offset);
        options.rule = rule;
        const auto cover = certifiedCover(scene.a, scene.b, nullptr, scene.motion, options);
        REQUIRE(cover.complete);
        const Table table = makeTable(scene.a, scene.b, cover.pairs, cover.restGaps, scene.motion);
        CHECK_FALSE(query(table, restValues(scene.motion)).hit());
        scenes::Random random(seed);
        for (int k = 0; k < 1500; ++k) {
            const auto q = scenes::randomPose(random, scene.motion);
            const Pose t = pose(scene.motion, q);
            bool touches = false;
            for (std::uint32_t i = 0; i < scene.a.size(); ++i)
                for (std::uint32_t j = 0; j < scene.b.size(); ++j)
                    touches |= rule.touches({i, j}, (t * scene.b[j].centre - scene.a[i].centre).norm() -
                                                        scene.a[i].radius - scene.b[j].radius);
            if (touches) CHECK(query(table, q).gap <= rounding);
        }
    }
}

TEST_CASE("a search that is to come to its end stops from a tenth on where it would not at this rate") {
    CoverBudget budget;
    budget.looks = 1000;
    CHECK_FALSE(budget.spent(999, 0));
    CHECK(budget.spent(1000, 0.99));
    budget.toTheEnd = true;
    CHECK_FALSE(budget.spent(99, 0));
    CHECK(budget.spent(100, 0.05));
    CHECK_FALSE(budget.spent(100, 0.2));
    CHECK(budget.spent(500, 0.4));
    CoverBudget none;
    none.toTheEnd = true;
    CHECK_FALSE(none.spent(1'000'000'000'000, 0));

    CoverBudget timed;
    timed.toTheEnd = true;
    const auto pass = [&](double seconds) {
        while (timed.watch.seconds() < seconds) {
        }
    };
    timed.seconds = 1000;
    CHECK_FALSE(timed.spent(1, 0));
    timed.seconds = 0.1;
    pass(0.03);
    CHECK(timed.spent(1, 0.1));
    timed.seconds = 10;
    CHECK_FALSE(timed.spent(1, 0.1));
    timed.seconds = 0.01;
    CHECK(timed.spent(1, 0.99));
    timed.toTheEnd = false;
    CHECK(timed.spent(1, 0.99));
}

TEST_CASE("a cover that is all or nothing gives up long before its seconds are over") {
    const auto scene = scenes::randomScene(1, 6, 60);
    CoverOptions options;
    options.coarser = false;
    options.seconds = 8;
    const Stopwatch watch;
    const auto cover = certifiedCover(scene.a, scene.b, nullptr, scene.motion, options);
    CHECK_FALSE(cover.complete);
    CHECK(watch.seconds() < 0.5 * 0.6 * options.seconds);
}
