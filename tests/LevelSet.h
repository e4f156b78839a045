#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <vector>

namespace tss::test {

/// The surface where a function of the place is 0, negative inside, as a closed mesh by marching tetrahedra:
/// edges of about `step`, and slivers among its triangles, as in meshes that programs make.
inline TriangleMesh levelSet(const std::function<double(const Vec3&)>& f, const Vec3& low, const Vec3& high,
                             double step) {
    const Eigen::Array3i count = ((high - low) / step).array().ceil().cast<int>() + 1;
    std::vector<Vec3> places;
    std::vector<double> values;
    for (int i = 0; i < count[0]; ++i)
        for (int j = 0; j < count[1]; ++j)
            for (int k = 0; k < count[2]; ++k) {
                places.push_back(low + step * Vec3(i, j, k));
                values.push_back(f(places.back()));
            }
    TriangleMesh mesh;
    std::map<std::pair<int, int>, int> made;
    const auto cut = [&](int a, int b) {
        if (a > b) std::swap(a, b);
        const auto [at, isNew] = made.emplace(std::pair(a, b), int(mesh.vertices.size()));
        if (isNew) {
            const double share = std::clamp(values[a] / (values[a] - values[b]), 0.03, 0.97);
            mesh.vertices.push_back(places[a] + share * (places[b] - places[a]));
        }
        return at->second;
    };
    const auto add = [&](int a, int b, int c, const Vec3& outwards) {
        const Vec3 normal = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
        mesh.triangles.push_back(normal.dot(outwards) > 0 ? Tri(a, b, c) : Tri(a, c, b));
    };
    const auto tetrahedron = [&](const std::array<int, 4>& corners) {
        std::vector<int> in, out;
        for (const int c : corners) (values[c] < 0 ? in : out).push_back(c);
        if (in.empty() || out.empty()) return;
        Vec3 outwards = Vec3::Zero();
        for (const int c : out) outwards += places[c] / double(out.size());
        for (const int c : in) outwards -= places[c] / double(in.size());
        if (in.size() == 2) {
            const int a = cut(in[0], out[0]), b = cut(in[0], out[1]), c = cut(in[1], out[1]),
                      d = cut(in[1], out[0]);
            add(a, b, c, outwards);
            add(a, c, d, outwards);
        } else {
            const auto& [one, three] = in.size() == 1 ? std::pair(in, out) : std::pair(out, in);
            add(cut(one[0], three[0]), cut(one[0], three[1]), cut(one[0], three[2]), outwards);
        }
    };
    const int right = count[1] * count[2], back = count[2];
    for (int i = 0; i + 1 < count[0]; ++i)
        for (int j = 0; j + 1 < count[1]; ++j)
            for (int k = 0; k + 1 < count[2]; ++k) {
                const int first = i * right + j * back + k, last = first + right + back + 1;
                const std::array<int, 6> around{1, back + 1, back, right + back, right, right + 1};
                for (int side = 0; side < 6; ++side)
                    tetrahedron({first, first + around[side], first + around[(side + 1) % 6], last});
            }
    return mesh;
}

/// How far a place is from the segment from a to b.
inline double fromSegment(const Vec3& x, const Vec3& a, const Vec3& b) {
    const double along = (x - a).dot(b - a) / (b - a).squaredNorm();
    return (x - a - std::clamp(along, 0.0, 1.0) * (b - a)).norm();
}

} // namespace tss::test
