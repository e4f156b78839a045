#include "bake/respond/MuscleShares.h"

#include "bake/geometry/MeshQuery.h"
#include "bake/respond/SkinShares.h"

namespace tss {

std::vector<double> insertionShares(const TriangleMesh& surface, const TriangleMesh& origin,
                                    const TriangleMesh& insertion) {
    if (surface.empty() || origin.empty() || insertion.empty()) return {};
    std::vector<SkinHolder> holders;
    for (const TriangleMesh* bone : {&origin, &insertion}) {
        const MeshQuery query(*bone);
        holders.push_back({{}, diagonal(*bone), {}, {}});
        for (const Vec3& v : surface.vertices) holders.back().distance.push_back(query.distance(v));
    }
    return claimedShares(surface, skinGraph(surface), holders)[1];
}

} // namespace tss
