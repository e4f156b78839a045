#include "bake/geometry/ConnectedParts.h"

#include "bake/base/UnionFind.h"
#include "bake/geometry/Import.h"

#include <algorithm>

namespace tss {

std::vector<TriangleMesh> connectedParts(const TriangleMesh& soup) {
    const TriangleMesh mesh = welded(soup);
    UnionFind together(mesh.vertices.size());
    for (const Tri& t : mesh.triangles)
        for (const int v : {t[1], t[2]}) together.join(t[0], v);
    std::vector<TriangleMesh> parts;
    std::vector<int> partOfRoot(mesh.vertices.size(), -1), placeOf(mesh.vertices.size(), -1);
    for (const Tri& t : mesh.triangles) {
        int& at = partOfRoot[together.root(t[0])];
        if (at < 0) {
            at = static_cast<int>(parts.size());
            parts.emplace_back();
        }
        TriangleMesh& part = parts[at];
        Tri moved;
        for (int k = 0; k < 3; ++k) {
            int& place = placeOf[t[k]];
            if (place < 0) {
                place = static_cast<int>(part.vertices.size());
                part.vertices.push_back(mesh.vertices[t[k]]);
            }
            moved[k] = place;
        }
        part.triangles.push_back(moved);
    }
    return parts;
}

std::vector<std::size_t> farthestOut(const TriangleMesh& mesh) {
    std::vector<std::size_t> found;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                const Vec3 way(x, y, z);
                const auto along = [&](const Vec3& p) { return way.dot(p); };
                if (!way.isZero())
                    found.push_back(std::ranges::max_element(mesh.vertices, {}, along) -
                                    mesh.vertices.begin());
            }
    return found;
}

} // namespace tss
