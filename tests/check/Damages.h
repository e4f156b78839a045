#pragma once
#include "bake/table/Table.h"

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

/// Ways to damage a baked table so that a file still reads.
namespace damages {

using tss::Sphere;
using tss::Table;

struct Damage {
    std::string name;
    std::function<void(Table&, std::mt19937_64&)> apply;
};

inline std::size_t any(std::mt19937_64& random, std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

/// The table with some of its tests, in any order of spheres.
inline Table withTests(const Table& table, const std::vector<tss::SpherePair>& pairs,
                       const std::vector<double>& restGaps) {
    Table made =
        tss::makeTable(table.a, table.b, pairs, restGaps, table.motion, nullptr, nullptr, tss::Keep::All);
    Table out = table;
    out.a = made.a;
    out.b = made.b;
    out.rowOffsets = made.rowOffsets;
    out.columns = made.columns;
    out.restGaps = made.restGaps;
    return out;
}

inline void dropTests(Table& table, std::mt19937_64& random, double share) {
    std::vector<tss::SpherePair> kept;
    std::vector<double> gaps;
    const std::vector<tss::SpherePair> all = tss::tests(table);
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (std::uniform_real_distribution<>(0, 1)(random) < share) continue;
        kept.push_back(all[k]);
        if (!table.restGaps.empty()) gaps.push_back(table.restGaps[k]);
    }
    table = withTests(table, kept, gaps);
}

inline void scaleRadii(std::vector<Sphere>& spheres, double factor) {
    for (Sphere& s : spheres) s.radius *= factor;
}

inline void shift(std::vector<Sphere>& spheres, const tss::Vec3& by) {
    for (Sphere& s : spheres) s.centre += by;
}

inline void addThreshold(Table& table, double by) {
    table.restGaps.resize(table.testCount(), 0);
    for (double& gap : table.restGaps) gap += by;
}

using AddDamage = std::function<void(std::string name, std::function<void(Table&, std::mt19937_64&)> apply)>;

/// Of spheres and thresholds.
inline void addSizes(double length, const AddDamage& add) {
    using R = std::mt19937_64;
    for (const double factor : {0.5, 0.9, 0.97, 0.99, 1.01, 1.1}) {
        const std::string by = " times " + std::to_string(factor);
        add("radii of A" + by, [=](Table& t, R&) { scaleRadii(t.a, factor); });
        add("radii of B" + by, [=](Table& t, R&) { scaleRadii(t.b, factor); });
        add("all radii, counts and figures" + by, [=](Table& t, R&) {
            scaleRadii(t.a, factor), scaleRadii(t.b, factor);
            t.record.spheresA = t.a.size(), t.record.spheresB = t.b.size();
            t.record.fitA.coverage = t.record.fitB.coverage = 0;
        });
        add("one radius" + by, [=](Table& t, R& r) { t.a[any(r, t.a.size())].radius *= factor; });
    }
    for (const double by : {-1.0, -0.3, 0.3, 1.0}) {
        const std::string text = " moved by " + std::to_string(by) + " lengths";
        add("spheres of A" + text, [=](Table& t, R&) { shift(t.a, {by * length, 0, 0}); });
        add("spheres of B" + text, [=](Table& t, R&) { shift(t.b, {0, by * length, 0}); });
        add("thresholds" + text, [=](Table& t, R&) { addThreshold(t, by * length); });
        add("one threshold" + text, [=](Table& t, R& r) {
            t.restGaps.resize(t.testCount(), 0);
            t.restGaps[any(r, t.testCount())] += by * length;
        });
    }
}

/// Of tests, bounds and limits.
inline void addClaims(double length, const AddDamage& add) {
    using R = std::mt19937_64;
    add("one test dropped", [](Table& t, R& r) {
        std::vector<tss::SpherePair> pairs = tss::tests(t);
        std::vector<double> gaps = t.restGaps;
        const auto k = std::ptrdiff_t(any(r, pairs.size()));
        pairs.erase(pairs.begin() + k);
        if (!gaps.empty()) gaps.erase(gaps.begin() + k);
        t = withTests(t, pairs, gaps);
    });
    for (const double share : {0.1, 0.5, 0.9, 1.0})
        add("a share of " + std::to_string(share) + " of the tests dropped",
            [=](Table& t, R& r) { dropTests(t, r, share); });
    add("columns turned round", [](Table& t, R&) {
        for (std::uint32_t& c : t.columns) c = std::uint32_t(t.b.size()) - 1 - c;
    });
    add("two spheres of A swapped",
        [](Table& t, R& r) { std::swap(t.a[any(r, t.a.size())], t.a[any(r, t.a.size())]); });
    add("two spheres of B swapped",
        [](Table& t, R& r) { std::swap(t.b[any(r, t.b.size())], t.b[any(r, t.b.size())]); });
    add("boundMiss 0", [](Table& t, R&) { t.boundMiss = 0; });
    add("boundMiss 0 and figures 0", [](Table& t, R&) {
        t.boundMiss = 0;
        t.record.fitA.coverage = t.record.fitB.coverage = 0;
    });
    add("boundEarly 0", [](Table& t, R&) { t.boundEarly = 0; });
    add("boundEarly a half", [](Table& t, R&) { *t.boundEarly *= 0.5; });
    add("all bounds 0", [](Table& t, R&) { t.boundEarly = t.boundMiss = 0, t.epsilon = 0; });
    add("epsilon 0", [](Table& t, R&) { t.epsilon = 0; });
    add("epsilon twice", [](Table& t, R&) { t.epsilon *= 2; });
    add("depth 0", [](Table& t, R&) { t.gapDepth = 0; });
    add("thresholds gone", [](Table& t, R&) { t.restGaps.clear(); });
    add("limits of the table narrower", [](Table& t, R&) { t.motion.dofs[0].upper -= 0.1; });
    add("the table's axis moved", [=](Table& t, R&) {
        t.motion.dofs[0].origin.x() += length;
        t.motion.dofs[0].axis = -t.motion.dofs[0].axis;
    });
    add("the table's placement moved", [=](Table& t, R&) { t.motion.base.translation().x() += length; });
    add("an exempt triangle of each where nothing meets at rest", [](Table& t, R& r) {
        t.restRegion.a = {{std::uint32_t(any(r, 8)), 1}};
        t.restRegion.b = {{std::uint32_t(any(r, 8)), 1}};
    });
    add("an exempt part of B alone", [](Table& t, R& r) {
        t.restRegion.b = {{std::uint32_t(any(r, 8)), 2}};
    });
}

/// About fifty kinds. `length`: how large a change counts, about the tolerance of the spheres.
inline std::vector<Damage> kinds(double length) {
    std::vector<Damage> all;
    const AddDamage add = [&](std::string name, std::function<void(Table&, std::mt19937_64&)> apply) {
        all.push_back({std::move(name), std::move(apply)});
    };
    addSizes(length, add);
    addClaims(length, add);
    return all;
}

} // namespace damages
