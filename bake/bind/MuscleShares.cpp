#include "bake/bind/MuscleShares.h"

#include "bake/bind/SkinShares.h"
#include "bake/geometry/MeshQuery.h"

#include <algorithm>

namespace tss {
namespace {

/// The power of the distances in a muscle's shares: a place as far from one bone as from the other goes half
/// with either, one at half that distance to 94 %. With squares what lies thick on a bone would turn beside
/// the joint.
double fourthPower(double x) {
    return x * x * x * x;
}

/// The shares of a ring, by claims along the surface: its parts lie on other bones than those that they
/// belong to, as a closed upper lip on the lower teeth.
std::vector<double> claimedAround(const TriangleMesh& surface, const TriangleMesh& origin,
                                  const TriangleMesh& insertion, const ShareOptions& options) {
    std::vector<SkinInfluence> influences;
    for (const TriangleMesh* bone : {&origin, &insertion}) {
        const MeshQuery query(*bone);
        // What counts as near is a share of a bone's size, here of twice the ring's at most: a short ring
        // between long bones would be near to both everywhere.
        influences.push_back({{}, std::min(diagonal(*bone), 2 * diagonal(surface)), {}, {}});
        for (const Vec3& v : surface.vertices) influences.back().distance.push_back(query.distance(v));
    }
    return claimedShares(surface, skinGraph(surface), influences, options)[1];
}

/// The shares of a muscle with two ends: by how much nearer a vertex is to the one bone than to the other.
std::vector<double> nearerBone(const TriangleMesh& surface, const TriangleMesh& origin,
                               const TriangleMesh& insertion, const ShareOptions& options) {
    const SkinGraph graph = skinGraph(surface);
    const MeshQuery toOrigin(origin), toInsertion(insertion);
    std::vector<std::vector<double>> shares(2);
    for (const Vec3& v : surface.vertices) {
        const double here = toOrigin.distance(v), there = toInsertion.distance(v), both = here + there;
        const double a = both > 0 ? fourthPower(here / both) : 0.5;
        const double b = both > 0 ? fourthPower(there / both) : 0.5;
        shares[0].push_back(b / (a + b));
        shares[1].push_back(a / (a + b));
    }
    unfoldShares(surface, graph, graph.meanEdge, options, shares);
    return shares[1];
}

} // namespace

std::vector<double> insertionShares(const TriangleMesh& surface, const TriangleMesh& origin,
                                    const TriangleMesh& insertion, MuscleForm form,
                                    std::span<const DualPose> far) {
    if (surface.empty() || origin.empty() || insertion.empty()) return {};
    ShareOptions options{{}, {}, true, 60}; // more rounds than skin has: all of a muscle may become stiff
    for (const DualPose& motion : far) options.motions.push_back({DualPose(), motion});
    return (form == MuscleForm::Ring ? claimedAround : nearerBone)(surface, origin, insertion, options);
}

} // namespace tss
