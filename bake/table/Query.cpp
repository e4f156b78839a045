#include "bake/table/Query.h"

#include "bake/base/Error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss {

namespace {

/// Contact point and normal of two spheres given in one frame.
void contact(const Sphere& a, const Vec3& centreB, double radiusB, QueryResult& result) {
    const Vec3 between = centreB - a.centre;
    const double distance = between.norm();
    result.normal = distance > 0 ? Vec3(between / distance) : Vec3::UnitX();
    result.point = a.centre + result.normal * (0.5 * (a.radius + distance - radiusB));
}

/// The nearest of `count` tests, the first of equally near ones. numberOf: of each.
template <class NumberOf>
QueryResult nearestOf(const TableTests& tests, const Pose& pose, std::size_t count,
                      const NumberOf& numberOf) {
    QueryResult result;
    result.gap = std::numeric_limits<double>::infinity();
    const Pose inverse = pose.inverse(Eigen::Isometry);
    for (std::size_t i = 0; i < count; ++i) {
        const auto test = static_cast<std::uint32_t>(numberOf(i));
        const double gap = queryGap(tests, test, inverse);
        const int number = static_cast<int>(test);
        if (!(gap < result.gap || (gap == result.gap && number < result.test))) continue;
        result.gap = gap;
        result.test = number;
    }
    if (result.test >= 0) {
        const TablePair pair = tests[static_cast<std::size_t>(result.test)];
        contact({pair.a, pair.radiusA}, pose * pair.b, pair.radiusB, result);
    }
    return result;
}

/// Calls visit(row, test, gap) for every test, until it returns false.
template <class Visit>
void eachGap(const Table& table, const Pose& pose, const Visit& visit) {
    for (std::uint32_t i = 0; i + 1 < table.rowOffsets.size(); ++i) {
        const Vec3 centre = pose.inverse(Eigen::Isometry) * table.a[i].centre;
        for (std::uint32_t k = table.rowOffsets[i]; k < table.rowOffsets[i + 1]; ++k) {
            const Sphere& b = table.b[table.columns[k]];
            const double rest = table.restGaps.empty() ? 0 : table.restGaps[k];
            if (!visit(i, k, (b.centre - centre).norm() - table.a[i].radius - b.radius - rest)) return;
        }
    }
}

} // namespace

double queryGap(const TableTests& tests, std::uint32_t test, const Pose& inverse) {
    const TablePair pair = tests[test];
    const Vec3 centre = inverse * pair.a;
    return (pair.b - centre).norm() - pair.radiusA - pair.radiusB - tests.restGap(test);
}

QueryResult query(const TableTests& tests, const Pose& pose) {
    return nearestOf(tests, pose, tests.size(), [](std::size_t i) { return i; });
}

QueryResult query(const TableTests& tests, const Pose& pose, std::span<const std::uint32_t> some) {
    return nearestOf(tests, pose, some.size(), [&](std::size_t i) { return some[i]; });
}

QueryResult query(const Table& table, const Pose& pose) {
    QueryResult result;
    result.gap = std::numeric_limits<double>::infinity();
    std::uint32_t bestRow = 0;
    eachGap(table, pose, [&](std::uint32_t row, std::uint32_t test, double gap) {
        if (!(gap < result.gap)) return true;
        result.gap = gap;
        result.test = static_cast<int>(test);
        bestRow = row;
        return true;
    });
    if (result.test >= 0) {
        const Sphere& b = table.b[table.columns[result.test]];
        contact(table.a[bestRow], pose * b.centre, b.radius, result);
    }
    return result;
}

bool touches(const Table& table, const Pose& pose) {
    bool any = false;
    eachGap(table, pose, [&](std::uint32_t, std::uint32_t, double gap) { return !(any = gap <= 0); });
    return any;
}

QueryResult query(const Table& table, std::span<const double> q) {
    if (!std::ranges::all_of(q, [](double value) { return std::isfinite(value); }))
        throw InputError("expected values that are finite numbers");
    return query(table, pose(table.motion, q));
}

QueryResult queryAllPairs(const SphereSet& a, const SphereSet& b, const Pose& pose) {
    QueryResult result;
    result.gap = std::numeric_limits<double>::infinity();
    const Pose inverse = pose.inverse(Eigen::Isometry);
    std::size_t bestA = 0, bestB = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Vec3 centre = inverse * a[i].centre;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const double gap = (b[j].centre - centre).norm() - a[i].radius - b[j].radius;
            if (gap < result.gap) {
                result.gap = gap;
                bestA = i;
                bestB = j;
            }
        }
    }
    if (!a.empty() && !b.empty()) {
        result.test = static_cast<int>(bestA * b.size() + bestB);
        contact(a[bestA], pose * b[bestB].centre, b[bestB].radius, result);
    }
    return result;
}

} // namespace tss
