#include "examples/doghead/mesh/Meshing.h"

#include <algorithm>
#include <map>

namespace doghead {

using tss::Tri;
using tss::Vec3;

tss::TriangleMesh trim(const tss::TriangleMesh& mesh, const Field& kept) {
    tss::TriangleMesh cut = mesh;
    std::vector<double> reach(mesh.vertices.size(), 1e300); ///< a third of the shortest edge at a vertex
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const double third = (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm() / 3;
            reach[t[k]] = std::min(reach[t[k]], third);
            reach[t[(k + 1) % 3]] = std::min(reach[t[(k + 1) % 3]], third);
        }
    std::vector<double> side(cut.vertices.size());
    for (std::size_t i = 0; i < side.size(); ++i) {
        side[i] = kept(cut.vertices[i]);
        if (std::abs(side[i]) >= reach[i]) continue;
        cut.vertices[i] -= side[i] * normal(kept, cut.vertices[i]);
        side[i] = 0;
    }

    std::map<std::pair<int, int>, int> crossings;
    const auto crossing = [&](int a, int b) {
        const auto [place, isNew] = crossings.try_emplace(std::minmax(a, b), int(cut.vertices.size()));
        if (isNew) {
            const double t = side[a] / (side[a] - side[b]);
            const Vec3 at = (1 - t) * cut.vertices[a] + t * cut.vertices[b];
            cut.vertices.push_back(at);
        }
        return place->second;
    };
    std::vector<Tri> triangles;
    for (const Tri& t : mesh.triangles) {
        std::vector<int> polygon; // the triangle's part inside, Sutherland and Hodgman
        bool inside = false;
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            inside |= side[a] < 0;
            if (side[a] <= 0) polygon.push_back(a);
            if (side[a] * side[b] < 0) polygon.push_back(crossing(a, b));
        }
        for (std::size_t k = 2; inside && k < polygon.size(); ++k)
            triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
    }

    tss::TriangleMesh result;
    std::vector<int> index(cut.vertices.size(), -1);
    for (Tri& t : triangles)
        for (int k = 0; k < 3; ++k) {
            if (index[t[k]] < 0) {
                index[t[k]] = int(result.vertices.size());
                result.vertices.push_back(cut.vertices[t[k]]);
            }
            t[k] = index[t[k]];
        }
    result.triangles = std::move(triangles);
    return result;
}

} // namespace doghead
