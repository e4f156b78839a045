#include "bake/respond/SkinTurnLimit.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Of its area as carried, seen along its normal at rest as bones turn it, a triangle keeps this share at
/// least.
constexpr float leastShare = 0.02f;
/// Changing some displacements may turn over a triangle beside them: most times that this is done, first by
/// gathering, then by making them smaller.
constexpr int mostGathering = 64, mostLowering = 16;

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

void SkinTurnLimit::findTriangles(const SkinScene& scene, const SkinPushes& pushes) {
    beside_.clear();
    for (const Tri& corners : rig_.triangles) {
        if (std::ranges::none_of(corners, [&](int v) { return pushes.displaced(v); })) continue;
        const Edges edges = edgesOf(scene.carried, corners), rest = edgesOf(rig_.places, corners);
        const Eigen::Vector3f normal = turnOf(rig_, scene, static_cast<std::size_t>(corners[0])) *
                                       rest.first.cross(rest.second).normalized();
        const float area = normal.dot(edges.first.cross(edges.second));
        if (area > 0) beside_.push_back({corners, normal, area});
    }
}

/// What the nodes of triangles that are turned over have to do. gathers: to come nearer to the displacements
/// beside them, the larger the more; else to none.
void SkinTurnLimit::findWishes(const SkinScene& scene, const SkinPushes& pushes, bool gathers) {
    for (const Beside& beside : beside_) {
        const Edges now = edgesOf(scene.skin, beside.corners);
        const float least = leastShare * beside.area;
        if (!(beside.normal.dot(now.first.cross(now.second)) < least)) continue;
        // Half as much again, so that neither rounding nor the triangles beside ask for it once more.
        const float part =
            partLeft(edgesOf(scene.carried, beside.corners), now, beside.normal, beside.area, 1.5f * least);
        const auto eachNode = [&](const auto& what) {
            for (const int corner : beside.corners)
                for (const auto& [node, weight] : rig_.foundation.weights[static_cast<std::size_t>(corner)])
                    if (weight != 0) what(node, std::abs(weight));
        };
        Move to = Move::Zero();
        float sum = 0;
        eachNode([&](std::uint32_t node, float weight) {
            const Move move = pushes.nodeMove(node);
            to += weight * move.squaredNorm() * move;
            sum += weight * move.squaredNorm();
        });
        to *= gathers && sum > 0 ? 1 / sum : 0;
        eachNode([&](std::uint32_t node, float) {
            Wish& wish = wishes_[node];
            wish.to += (1 - part) * to;
            wish.sum += 1 - part;
            wish.part = std::min(wish.part, part);
        });
    }
}

bool SkinTurnLimit::limit(SkinScene& scene, SkinPushes& pushes) {
    for (int round = 0; round < mostGathering + mostLowering; ++round) {
        if (round <= mostGathering) findTriangles(scene, pushes); // gathering displaces more of them
        findWishes(scene, pushes, round < mostGathering);
        if (wishes_.places().empty()) return round > 0;
        wishes_.take([&](std::uint32_t node, const Wish& wish) {
            const Move to = wish.sum > 0 ? Move(wish.to / wish.sum) : wish.to, now = pushes.nodeMove(node);
            pushes.moveNode(node, to + wish.part * (now - to));
        });
        pushes.displace(scene);
    }
    return true;
}

} // namespace tss
