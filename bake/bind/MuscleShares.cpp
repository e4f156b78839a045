#include "bake/bind/MuscleShares.h"

#include "bake/bind/SkinShares.h"
#include "bake/geometry/MeshQuery.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// #bones of #V: how much of its motion each vertex has from each bone.
using BoneShares = std::vector<std::vector<double>>;

/// The power of the distances in a muscle's shares: a place as far from one bone as from the other goes half
/// with either, one at half that distance to 94 %. With squares what lies thick on a bone would turn beside
/// the joint.
double fourthPower(double x) {
    return x * x * x * x;
}

/// The place of each vertex along the bones that it has shares of.
std::vector<double> alongBones(const BoneShares& shares) {
    std::vector<double> along(shares[0].size(), 0);
    const auto last = static_cast<double>(shares.size() - 1);
    for (std::size_t k = 1; k < shares.size(); ++k)
        for (std::size_t v = 0; v < along.size(); ++v)
            along[v] += static_cast<double>(k) / last * shares[k][v];
    for (double& share : along) share = std::min(share, 1.0); // sums are rounded
    return along;
}

/// The shares of a ring, by claims along the surface: its parts lie on other bones than those that they
/// belong to, as a closed upper lip on the lower teeth.
BoneShares claimedAround(const TriangleMesh& surface, std::span<const TriangleMesh> bones,
                         const ShareOptions& options) {
    std::vector<SkinInfluence> influences;
    for (const TriangleMesh& bone : bones) {
        const MeshQuery query(bone);
        // What counts as near is a share of a bone's size, here of twice the ring's at most: a short ring
        // between long bones would be near to both everywhere.
        influences.push_back({{}, std::min(diagonal(bone), 2 * diagonal(surface)), {}, {}});
        for (const Vec3& v : surface.vertices) influences.back().distance.push_back(query.distance(v));
    }
    return claimedShares(surface, skinGraph(surface), influences, options);
}

/// Where a vertex goes along the bones, by its distances from them.
double nearest(const std::vector<double>& distances) {
    const double least = *std::ranges::min_element(distances);
    double sum = 0, along = 0;
    for (std::size_t k = 0; k < distances.size(); ++k) {
        const double weight = distances[k] > least ? fourthPower(least / distances[k]) : 1;
        sum += weight;
        along += static_cast<double>(k) * weight;
    }
    return along / sum;
}

/// The shares of a muscle with two ends: of the two bones beside the place that is nearest.
BoneShares nearerBones(const TriangleMesh& surface, std::span<const TriangleMesh> bones,
                       const ShareOptions& options) {
    std::vector<MeshQuery> queries;
    for (const TriangleMesh& bone : bones) queries.emplace_back(bone);
    BoneShares shares(bones.size(), std::vector<double>(surface.vertices.size(), 0));
    std::vector<double> distances(bones.size());
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        for (std::size_t k = 0; k < bones.size(); ++k)
            distances[k] = queries[k].distance(surface.vertices[v]);
        const double along = nearest(distances), before = std::min(std::floor(along), bones.size() - 2.0);
        const auto k = static_cast<std::size_t>(before);
        shares[k][v] = 1 - (along - before);
        shares[k + 1][v] = along - before;
    }
    const SkinGraph graph = skinGraph(surface);
    unfoldShares(surface, graph, graph.meanEdge, options, shares);
    return shares;
}

} // namespace

std::vector<double> chainShares(const TriangleMesh& surface, std::span<const TriangleMesh> bones,
                                MuscleForm form, std::span<const std::vector<DualPose>> motions) {
    const auto empty = [](const TriangleMesh& mesh) { return mesh.empty(); };
    if (surface.empty() || bones.size() < 2 || std::ranges::any_of(bones, empty)) return {};
    ShareOptions options{{}, {}, true, 60}; // more rounds than skin has: all of a muscle may become stiff
    for (const std::vector<DualPose>& motion : motions) {
        options.motions.push_back({DualPose()});
        options.motions.back().insert(options.motions.back().end(), motion.begin(), motion.end());
    }
    return alongBones((form == MuscleForm::Ring ? claimedAround : nearerBones)(surface, bones, options));
}

} // namespace tss
