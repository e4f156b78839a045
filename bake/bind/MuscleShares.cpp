#include "bake/bind/MuscleShares.h"

#include "bake/bind/SkinShares.h"
#include "bake/geometry/MeshQuery.h"

#include <algorithm>

namespace tss {

std::vector<double> insertionShares(const TriangleMesh& surface, const TriangleMesh& origin,
                                    const TriangleMesh& insertion, std::span<const DualPose> far) {
    if (surface.empty() || origin.empty() || insertion.empty()) return {};
    std::vector<SkinInfluence> influences;
    for (const TriangleMesh* bone : {&origin, &insertion}) {
        const MeshQuery query(*bone);
        // The size sets what counts as near. It is limited by the muscle's, or a short muscle between long
        // bones would count as near to both everywhere.
        influences.push_back({{}, std::min(diagonal(*bone), 2 * diagonal(surface)), {}, {}});
        for (const Vec3& v : surface.vertices) influences.back().distance.push_back(query.distance(v));
    }
    // More rounds than skin has, since all of a muscle may become stiff; but its ends keep 99 % of their
    // bones' motion.
    ShareOptions options{{}, {}, true, 60, 1.2, 0.99};
    for (const DualPose& motion : far) options.motions.push_back({DualPose(), motion});
    return claimedShares(surface, skinGraph(surface), influences, options)[1];
}

} // namespace tss
