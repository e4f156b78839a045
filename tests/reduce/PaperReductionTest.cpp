#include "bake/reduce/Reductions.h"
#include "bake/reduce/SetCover.h"
#include "bake/search/SampledSearch.h"
#include "bake/table/Query.h"
#include "tests/search/Scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace tss;

namespace {

CandidatePairs candidates(std::vector<SpherePair> pairs) {
    CandidatePairs c;
    c.pairs = std::move(pairs);
    std::sort(c.pairs.begin(), c.pairs.end());
    return c;
}

/// The smallest cover by trying every subset.
std::size_t smallestCover(const std::vector<std::vector<std::uint32_t>>& rows, std::uint32_t columns) {
    std::size_t best = columns;
    for (std::uint32_t set = 0; set < (1u << columns); ++set) {
        const bool covers = std::all_of(rows.begin(), rows.end(), [&](const auto& row) {
            return std::any_of(row.begin(), row.end(), [&](auto c) { return set >> c & 1; });
        });
        if (covers) best = std::min<std::size_t>(best, std::size_t(__builtin_popcount(set)));
    }
    return best;
}

} // namespace

TEST_CASE("a sphere that never appears without another is removed") {
    // Sphere 5 of B is always seen with 6; 6 and 7 are also seen alone.
    const auto reduced =
        reduceCooccurrence(candidates({{0, 5}, {0, 6}, {1, 6}, {2, 5}, {2, 6}, {2, 7}, {3, 7}}));
    CHECK(reduced.pairs == std::vector<SpherePair>{{0, 6}, {2, 6}, {2, 7}, {3, 7}});
    // Rows 0 and 1 became one; 6 and 7 of B are left.
}

TEST_CASE("of two spheres that always appear together one stays") {
    const auto reduced = reduceCooccurrence(candidates({{0, 3}, {0, 4}, {1, 3}, {1, 4}, {1, 8}, {2, 8}}));
    CHECK(reduced.pairs == std::vector<SpherePair>{{0, 3}, {1, 3}, {1, 8}, {2, 8}});
}

TEST_CASE("rows that test the same spheres become one, others stay") {
    const auto reduced = reduceCooccurrence(candidates({{4, 1}, {7, 1}, {9, 2}}));
    CHECK(reduced.pairs == std::vector<SpherePair>{{4, 1}, {9, 2}});
    CHECK(reduceCooccurrence({}).pairs.empty());
}

TEST_CASE("rest gaps follow their pairs through the reduction") {
    auto c = candidates({{0, 1}, {1, 2}, {2, 2}});
    c.restGaps = {-0.5, 0, -0.25};
    const auto reduced = reduceCooccurrence(c);
    CHECK(reduced.pairs == std::vector<SpherePair>{{0, 1}, {1, 2}});
    CHECK(reduced.restGaps == std::vector<double>{-0.5, 0});
}

TEST_CASE("the set cover meets every row and lies between its bound and a few above the optimum") {
    scenes::Random random(11);
    for (int round = 0; round < 60; ++round) {
        const std::uint32_t columns = 4 + random.below(9);
        std::vector<std::vector<std::uint32_t>> rows(3 + random.below(25));
        for (auto& row : rows) {
            for (std::uint32_t c = 0; c < columns; ++c)
                if (random.below(4) == 0) row.push_back(c);
            if (row.empty()) row.push_back(random.below(int(columns)));
        }
        const auto cover = coverRows(rows);
        INFO("round " << round);
        for (const auto& row : rows)
            CHECK(std::any_of(row.begin(), row.end(), [&](auto c) {
                return std::binary_search(cover.chosen.begin(), cover.chosen.end(), c);
            }));
        const std::size_t best = smallestCover(rows, columns);
        CHECK(cover.lowerBound <= double(best));
        CHECK(cover.chosen.size() <= best + 1);
        CHECK(cover.lowerBound >= double(best) - 1);
    }
}

TEST_CASE("the minimal subset answers as all spheres do at every explored pose") {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        INFO("seed " << seed);
        const auto scene = scenes::randomScene(seed, 1 + int(seed % 3), 80);
        SampledSearchOptions options;
        options.samples = 400;
        const auto reduced = reduceMinimal(scene.a, scene.b, scene.motion, options);
        const auto table = makeTable(scene.a, scene.b, reduced.pairs, reduced.restGaps, scene.motion);
        std::size_t hits = 0;
        for (const auto& q : exploredPoses(scene.motion, options.samples, options.seed)) {
            const bool hit = queryAllPairs(scene.a, scene.b, pose(scene.motion, q)).hit();
            hits += hit;
            REQUIRE(query(table, q).hit() == hit);
        }
        CHECK(reduced.lowerBound <= double(reduced.pairs.size()));
        CHECK((reduced.lowerBound > 0) == (hits > 0));
    }
}

TEST_CASE("reduction shrinks a jaw-like pair by much") {
    const auto scene = scenes::jawLike(400, 300);
    SampledSearchOptions options;
    options.samples = 1000;
    const auto found = searchSampled(scene.a, scene.b, scene.motion, options);
    const auto paper = reduceCooccurrence(found);
    const auto minimal = reduceMinimal(scene.a, scene.b, scene.motion, options);
    CHECK(!minimal.pairs.empty());
    const auto spheresOfB = [](const std::vector<SpherePair>& pairs) {
        std::set<std::uint32_t> spheres;
        for (const SpherePair& pair : pairs) spheres.insert(pair.b);
        return spheres.size();
    };
    CHECK(spheresOfB(paper.pairs) < spheresOfB(found.pairs));
    CHECK(paper.pairs.size() < found.pairs.size() / 2);
    CHECK(minimal.pairs.size() < paper.pairs.size());
}
