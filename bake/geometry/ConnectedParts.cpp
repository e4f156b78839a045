#include "bake/geometry/ConnectedParts.h"

#include "bake/base/UnionFind.h"
#include "bake/geometry/Import.h"

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

} // namespace tss
