#include "tests/adversary/scenes/SkinDamage.h"

#include <algorithm>
#include <fmt/format.h>

namespace adversary {

namespace {

using tss::SkinTable;
using tss::Sphere;
using tss::Table;
using tss::Vec3;
using Engine = std::mt19937_64;

std::size_t any(Engine& random, std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

/// Thresholds as one writes them who wants to be believed.
void refresh(Table& table) {
    table.restGaps.assign(table.columns.size(), 0);
    for (std::size_t i = 0; i < table.a.size(); ++i)
        for (std::uint32_t k = table.rowOffsets[i]; k < table.rowOffsets[i + 1]; ++k) {
            const Sphere &a = table.a[i], &b = table.b[table.columns[k]];
            table.restGaps[k] = std::min(0.0, (a.centre - b.centre).norm() - a.radius - b.radius);
        }
}

/// Leaves out tests; rows and spheres stay.
template <class Keep>
void keepTests(Table& table, Keep&& keep) {
    Table left = table;
    left.columns.clear();
    left.restGaps.clear();
    left.rowOffsets.assign(1, 0);
    for (std::size_t i = 0; i < table.a.size(); ++i) {
        for (std::uint32_t k = table.rowOffsets[i]; k < table.rowOffsets[i + 1]; ++k) {
            if (!keep(i, table.columns[k])) continue;
            left.columns.push_back(table.columns[k]);
            if (!table.restGaps.empty()) left.restGaps.push_back(table.restGaps[k]);
        }
        left.rowOffsets.push_back(std::uint32_t(left.columns.size()));
    }
    table = std::move(left);
}

std::vector<SkinDamage> sphereKinds(double length) {
    std::vector<SkinDamage> all;
    for (const double factor : {0.5, 0.9, 0.97, 1.03, 1.5}) {
        const std::string by = fmt::format(" times {}", factor);
        const auto scale = [factor](std::vector<Sphere>& spheres) {
            for (Sphere& s : spheres) s.radius *= factor;
        };
        all.push_back({"radii of the muscles" + by, false, [=](SkinTable& t, Engine&) { scale(t.table.b); }});
        all.push_back({"radii of the muscles, thresholds made anew," + by, false, [=](SkinTable& t, Engine&) {
                           scale(t.table.b);
                           refresh(t.table);
                       }});
        all.push_back({"radii of the skin, thresholds made anew," + by, false, [=](SkinTable& t, Engine&) {
                           scale(t.table.a);
                           refresh(t.table);
                       }});
        all.push_back({"one radius of a muscle" + by, false, [=](SkinTable& t, Engine& r) {
                           t.table.b[any(r, t.table.b.size())].radius *= factor;
                           refresh(t.table);
                       }});
    }
    for (const double by : {0.01, 0.3, 3.0}) {
        const std::string text = fmt::format(" moved by {} lengths", by);
        const Vec3 way = by * length * Vec3(0.6, 0, -0.8);
        all.push_back({"spheres of the muscles" + text, false, [=](SkinTable& t, Engine&) {
                           for (Sphere& s : t.table.b) s.centre += way;
                           refresh(t.table);
                       }});
        all.push_back({"spheres of the skin" + text, false, [=](SkinTable& t, Engine&) {
                           for (Sphere& s : t.table.a) s.centre += way;
                           refresh(t.table);
                       }});
        all.push_back({"a sphere of a muscle" + text, false, [=](SkinTable& t, Engine& r) {
                           t.table.b[any(r, t.table.b.size())].centre += way;
                           refresh(t.table);
                       }});
    }
    return all;
}

std::vector<SkinDamage> testKinds(double length) {
    std::vector<SkinDamage> all;
    for (const double share : {0.02, 0.5, 1.0})
        all.push_back(
            {fmt::format("a share of {} of the tests left out", share), false, [=](SkinTable& t, Engine& r) {
                 std::uniform_real_distribution<> draw(0, 1);
                 keepTests(t.table, [&](std::size_t, std::uint32_t) { return draw(r) >= share; });
             }});
    all.push_back({"a row left out", false, [](SkinTable& t, Engine& r) {
                       const std::size_t row = any(r, t.table.a.size());
                       keepTests(t.table, [=](std::size_t i, std::uint32_t) { return i != row; });
                   }});
    all.push_back({"a sphere of a muscle left out", false, [](SkinTable& t, Engine& r) {
                       const std::size_t out = any(r, t.table.b.size());
                       keepTests(t.table, [=](std::size_t, std::uint32_t j) { return j != out; });
                   }});
    all.push_back({"all of the first muscle left out", false, [](SkinTable& t, Engine&) {
                       keepTests(t.table, [&](std::size_t, std::uint32_t j) { return t.muscleOf[j] != 0; });
                   }});
    all.push_back({"columns turned round", false, [](SkinTable& t, Engine&) {
                       for (std::uint32_t& c : t.table.columns) c = std::uint32_t(t.table.b.size()) - 1 - c;
                       refresh(t.table);
                   }});
    all.push_back({"skin spheres on each other's vertices", false, [](SkinTable& t, Engine&) {
                       std::rotate(t.skinVertices.begin(), t.skinVertices.begin() + 1, t.skinVertices.end());
                   }});
    all.push_back({"two skin spheres on one vertex", false, [](SkinTable& t, Engine&) {
                       t.skinVertices.back() = t.skinVertices.front();
                       t.table.a.back().centre = t.table.a.front().centre;
                       refresh(t.table);
                   }});
    all.push_back({"a sphere given to another muscle", false, [](SkinTable& t, Engine& r) {
                       std::uint32_t& m = t.muscleOf[any(r, t.muscleOf.size())];
                       m = m == 0 ? *std::max_element(t.muscleOf.begin(), t.muscleOf.end()) : 0;
                   }});
    for (const double by : {-1.0, -0.1, 0.1})
        all.push_back({fmt::format("thresholds moved by {} lengths", by), false, [=](SkinTable& t, Engine&) {
                           t.table.restGaps.resize(t.table.testCount(), 0);
                           for (double& gap : t.table.restGaps) gap += by * length;
                       }});
    all.push_back({"thresholds gone", false, [](SkinTable& t, Engine&) { t.table.restGaps.clear(); }});
    all.push_back({"a longer travel said", false, [=](SkinTable& t, Engine&) { t.travel += length; }});
    all.push_back({"a shorter travel said", false, [](SkinTable& t, Engine&) { t.travel = 0; }});
    return all;
}

std::vector<SkinDamage> claimKinds(double length) {
    return {
        {"said to be certified", true, [](SkinTable& t, Engine&) { t.table.certified = true; }},
        {"no misses claimed", true, [](SkinTable& t, Engine&) { t.table.boundMiss = 0; }},
        {"late by a length claimed", true, [=](SkinTable& t, Engine&) { t.table.boundMiss = length; }},
        {"nothing early claimed", true, [](SkinTable& t, Engine&) { t.table.boundEarly = 0; }},
        {"certified with both bounds", true,
         [=](SkinTable& t, Engine&) {
             t.table.certified = true;
             t.table.boundMiss = 0;
             t.table.boundEarly = 9 * length;
         }},
        {"an epsilon claimed", true, [=](SkinTable& t, Engine&) { t.table.epsilon = length; }},
        {"a depth claimed", true, [=](SkinTable& t, Engine&) { t.table.gapDepth = length; }},
        {"a margin claimed", true, [=](SkinTable& t, Engine&) { t.table.gapMargin = length; }},
    };
}

} // namespace

std::vector<SkinDamage> skinDamages(double length) {
    std::vector<SkinDamage> all;
    for (const auto make : {sphereKinds, testKinds, claimKinds})
        for (SkinDamage& damage : make(length)) all.push_back(std::move(damage));
    return all;
}

} // namespace adversary
