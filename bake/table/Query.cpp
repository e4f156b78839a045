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

} // namespace

QueryResult query(const Table& table, const Pose& pose) {
    QueryResult result;
    result.gap = std::numeric_limits<double>::infinity();
    std::uint32_t bestRow = 0;
    for (std::uint32_t i = 0; i + 1 < table.rowOffsets.size(); ++i) {
        const Vec3 centre = pose.inverse(Eigen::Isometry) * table.a[i].centre;
        for (std::uint32_t k = table.rowOffsets[i]; k < table.rowOffsets[i + 1]; ++k) {
            const Sphere& b = table.b[table.columns[k]];
            const double rest = table.restGaps.empty() ? 0 : table.restGaps[k];
            const double gap = (b.centre - centre).norm() - table.a[i].radius - b.radius - rest;
            if (gap < result.gap) {
                result.gap = gap;
                result.test = static_cast<int>(k);
                bestRow = i;
            }
        }
    }
    if (result.test >= 0) {
        const Sphere& b = table.b[table.columns[result.test]];
        contact(table.a[bestRow], pose * b.centre, b.radius, result);
    }
    return result;
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
