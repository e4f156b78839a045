#pragma once
#include "SkinShapes.h"

#include "bake/geometry/MeshQuery.h"

#include <algorithm>

/// What is measured on a skin, for tests that print it beside the goals.
namespace skins {

struct Depths {
    double p95 = 0;        ///< of the vertices that could be inside: those that are, now or at rest
    double worst = 0;      ///< beyond the depth at rest, scene units
    std::size_t count = 0; ///< vertices inside
};

/// How deep each point is inside a closed mesh, 0 outside.
inline std::vector<double> depths(const std::vector<tss::Vec3>& points, const tss::TriangleMesh& solid) {
    const tss::MeshQuery query(solid);
    const Eigen::AlignedBox3d box = bounds(solid);
    std::vector<double> result(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (box.contains(points[i]) && query.inside(points[i])) result[i] = query.distance(points[i]);
    return result;
}

/// How far each point that starts under an open sheet has come through it, 0 for the others.
inline std::vector<double> poking(const std::vector<tss::Vec3>& points, const tss::TriangleMesh& sheet,
                                  double range) {
    const tss::ClosestPointQuery locator(sheet);
    const std::vector<tss::Vec3> normals = tss::vertexNormals(sheet);
    std::vector<double> result(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const tss::NearestPoint near = locator.nearest(points[i], range);
        if (near.triangle < 0) continue;
        tss::Vec3 normal = tss::Vec3::Zero();
        for (int k = 0; k < 3; ++k) normal += near.weights[k] * normals[sheet.triangles[near.triangle][k]];
        if ((points[i] - near.point).dot(normal) > 0) result[i] = near.distance;
    }
    return result;
}

inline Depths beyond(const std::vector<double>& now, const std::vector<double>& rest) {
    std::vector<double> excess;
    for (std::size_t i = 0; i < now.size(); ++i)
        if (now[i] > 0 || rest[i] > 0) excess.push_back(std::max(0.0, now[i] - rest[i]));
    std::sort(excess.begin(), excess.end());
    if (excess.empty()) return {};
    return {excess[excess.size() * 95 / 100], excess.back(), excess.size()};
}

struct Strain {
    double shortest = 1, longest = 1; ///< of an edge, in rest lengths
    int flipped = 0;                  ///< triangles turned over
    double area = 0;                  ///< of the touched skin, change as a share of it at rest
    double volume = 0;                ///< below the touched skin, change in units of the scene
};

inline Strain strain(const tss::SkinResponse& response) {
    Strain result;
    const auto& rest = response.rig().rest;
    const auto now = response.positions();
    double areaBefore = 0, areaNow = 0;
    for (const tss::Tri& t : response.rig().triangles) {
        for (int k = 0; k < 3; ++k) {
            const int i = t[k], j = t[(k + 1) % 3];
            const double ratio = (now[i] - now[j]).norm() / (rest[i] - rest[j]).norm();
            result.shortest = std::min(result.shortest, ratio);
            result.longest = std::max(result.longest, ratio);
        }
        const tss::Vec3 before = (rest[t[1]] - rest[t[0]]).cross(rest[t[2]] - rest[t[0]]);
        const tss::Vec3 after = (now[t[1]] - now[t[0]]).cross(now[t[2]] - now[t[0]]);
        result.flipped += before.dot(after) <= 0;
        areaBefore += before.norm() / 2;
        areaNow += after.norm() / 2;
        // The rim stays, so that what the sheet has swept does not depend on the origin.
        result.volume +=
            (now[t[0]].dot(now[t[1]].cross(now[t[2]])) - rest[t[0]].dot(rest[t[1]].cross(rest[t[2]]))) / 6;
    }
    result.area = areaBefore > 0 ? areaNow / areaBefore - 1 : 0;
    return result;
}

/// All vertices of the skin as they stand.
inline std::vector<tss::Vec3> places(const Couple& couple, const tss::SkinResponse& response) {
    std::vector<tss::Vec3> result = couple.skin.vertices;
    for (std::size_t i = 0; i < response.positions().size(); ++i)
        result[response.rig().vertices[i]] = response.positions()[i];
    return result;
}

/// Largest distance between two states of one skin.
inline double distance(const tss::SkinResponse& a, const tss::SkinResponse& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.positions().size(); ++i)
        most = std::max(most, (a.positions()[i] - b.positions()[i]).norm());
    return most;
}

inline double largestMove(const tss::SkinResponse& response) {
    double most = 0;
    for (std::size_t i = 0; i < response.positions().size(); ++i)
        most = std::max(most, (response.positions()[i] - response.rig().rest[i]).norm());
    return most;
}

} // namespace skins
