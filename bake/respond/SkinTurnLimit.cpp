#include "bake/respond/SkinTurnLimit.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Of its area as carried, seen along the skin's normal, a triangle keeps this share at least.
constexpr float leastShare = 0.02f;
/// Making some displacements smaller may turn over a triangle beside them: most times that this is done.
constexpr int mostRounds = 16;

struct Edges {
    Eigen::Vector3f first, second;
};

Edges edgesOf(std::span<const Move> places, const Tri& t) {
    return {(places[t[1]] - places[t[0]]).head<3>(), (places[t[2]] - places[t[0]]).head<3>()};
}

/// The part of a displacement at which the area of a triangle, seen along a normal, is down to `least`. It is
/// more than that without displacement, and less with all of it.
float partLeft(const Edges& carried, const Edges& now, const Eigen::Vector3f& normal, float area,
               float least) {
    const Eigen::Vector3f u = now.first - carried.first, v = now.second - carried.second;
    const float above = area - least, square = normal.dot(u.cross(v)),
                slope = normal.dot(carried.first.cross(v) + u.cross(carried.second));
    const float root = std::sqrt(std::max(slope * slope - 4 * square * above, 0.0f));
    return std::clamp(2 * above / std::max(root - slope, std::numeric_limits<float>::min()), 0.0f, 1.0f);
}

} // namespace

SkinTurnLimit::SkinTurnLimit(const SkinRig& rig) : rig_(rig), factors_(rig.foundation.nodes, 1) {}

void SkinTurnLimit::findTriangles(const SkinScene& scene, std::span<const char> blocks) {
    beside_.clear();
    const auto displaced = [&](int corner) { return blocks[corner / SkinRig::block] != 0; };
    for (const Tri& corners : rig_.triangles) {
        if (std::ranges::none_of(corners, displaced)) continue;
        const Edges edges = edgesOf(scene.carried, corners);
        Eigen::Vector3f outwards = Eigen::Vector3f::Zero();
        for (const int corner : corners) outwards += scene.normalOf(static_cast<std::size_t>(corner));
        const Eigen::Vector3f normal = outwards.normalized();
        const float area = normal.dot(edges.first.cross(edges.second));
        if (area > 0) beside_.push_back({corners, normal, area});
    }
}

/// Finds by how much displacements of nodes have to become smaller. Returns whether any has to.
bool SkinTurnLimit::findFactors(const SkinScene& scene) {
    bool any = false;
    for (const Beside& beside : beside_) {
        const Edges now = edgesOf(scene.skin, beside.corners);
        const float least = leastShare * beside.area;
        if (!(beside.normal.dot(now.first.cross(now.second)) < least)) continue;
        any = true;
        // Half as much again, so that neither rounding nor the triangles beside ask for it once more.
        const float part =
            partLeft(edgesOf(scene.carried, beside.corners), now, beside.normal, beside.area, 1.5f * least);
        for (const int corner : beside.corners)
            for (const auto& [node, weight] : rig_.foundation.weights[static_cast<std::size_t>(corner)])
                if (weight != 0) factors_[node] = std::min(factors_[node], part);
    }
    return any;
}

bool SkinTurnLimit::limit(SkinScene& scene, SkinPushes& pushes, std::span<char> blocks) {
    findTriangles(scene, blocks);
    int round = 0;
    for (; round < mostRounds && findFactors(scene); ++round) {
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            if (blocks[b] == 0) continue;
            const std::size_t last = std::min((b + 1) * SkinRig::block, scene.carried.size());
            for (std::size_t v = b * SkinRig::block; v < last; ++v) scene.skin[v] = scene.carried[v];
        }
        pushes.scale(factors_);
        pushes.displace(scene.skin, blocks);
        std::fill(factors_.begin(), factors_.end(), 1.0f);
    }
    return round > 0;
}

} // namespace tss
