#include "bake/respond/MuscleShares.h"

#include "bake/geometry/MeshQuery.h"
#include "bake/respond/SkinShares.h"

#include <algorithm>

namespace tss {

std::vector<double> insertionShares(const TriangleMesh& surface, const TriangleMesh& origin,
                                    const TriangleMesh& insertion, std::span<const DualPose> far) {
    if (surface.empty() || origin.empty() || insertion.empty()) return {};
    std::vector<SkinHolder> holders;
    for (const TriangleMesh* bone : {&origin, &insertion}) {
        const MeshQuery query(*bone);
        // What is near is so by the muscle's size where that is much less: a short muscle between long bones
        // would lie near both all over.
        holders.push_back({{}, std::min(diagonal(*bone), 2 * diagonal(surface)), {}, {}});
        for (const Vec3& v : surface.vertices) holders.back().distance.push_back(query.distance(v));
    }
    // A muscle has its whole length for what its bones turn by, all of it may get stiff; but its ends stay on
    // their bones to a hundredth of what these move.
    SkinStrokes strokes{{}, {}, true, 60, 1.2, 0.99};
    for (const DualPose& motion : far) strokes.motions.push_back({DualPose(), motion});
    return claimedShares(surface, skinGraph(surface), holders, strokes)[1];
}

} // namespace tss
