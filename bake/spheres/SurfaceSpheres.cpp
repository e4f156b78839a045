// The surface spheres of "Object Interaction Using Tabulated Spheres Subsets".
#include "bake/spheres/SphereMethods.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// What the triangles at a vertex say about edge lengths. Edges inside the mesh are met twice, which leaves
/// the mean as it is on a closed mesh.
struct Incident {
    double sum = 0;
    int count = 0;
    double longest = 0; // of all edges of the triangles at the vertex
};

} // namespace

SphereSet surfaceSpheres(const TriangleMesh& mesh, bool conservative) {
    std::vector<Incident> incident(mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        double length[3]; // of the edge that begins at the corner
        for (int k = 0; k < 3; ++k) length[k] = (mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k)).norm();
        for (int k = 0; k < 3; ++k) {
            Incident& v = incident[mesh.triangles[t][k]];
            v.sum += length[k] + length[(k + 2) % 3];
            v.count += 2;
            v.longest = std::max({v.longest, length[0], length[1], length[2]});
        }
    }
    SphereSet spheres;
    for (std::size_t v = 0; v < incident.size(); ++v) {
        if (incident[v].count == 0) continue;
        double radius = 0.5 * incident[v].sum / incident[v].count;
        if (conservative) radius = std::max(radius, (1 + 1e-9) * incident[v].longest / std::sqrt(3.0));
        spheres.push_back({mesh.vertices[v], radius});
    }
    return spheres;
}

} // namespace tss
