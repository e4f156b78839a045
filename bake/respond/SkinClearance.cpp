#include "bake/respond/SkinClearance.h"

#include <algorithm>

namespace tss {
namespace {

using Vec3f = Eigen::Vector3f;

/// Share of a gap over which a vertex may come nearer to the skin before they are queried: beside the anchor
/// skin that is stretched may have come the rest of the way.
constexpr float skinShare = 0.5f;

/// anchorOffset() as a vector of four with a 0 at the end, for vector instructions.
inline Move anchorOffset4(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    const SkinScene::Placed& placed = scene.bodies[row.body];
    const auto anchor = [&](const Move* surface) -> Move {
        return row.weights[0] * surface[row.corners[0]] + row.weights[1] * surface[row.corners[1]] +
               row.weights[2] * surface[row.corners[2]];
    };
    const auto toBody = [&](const Move& x) -> Move {
        if (!placed.moved) return x;
        const Vec3f y = placed.toBody(x.head<3>());
        return {y[0], y[1], y[2], 0};
    };
    const Move* skin = scene.skin.data();
    if (row.kind == SkinContactKind::BodyOnSkin) return scene.surface[row.vertex] - toBody(anchor(skin));
    if (row.kind == SkinContactKind::SkinOnSkin) return skin[row.vertex] - anchor(skin);
    const SkinBody& body = rig.bodies[row.body];
    const Move x = toBody(skin[row.vertex]);
    return body.bone() ? x : Move(x - anchor(scene.surface.data() + body.first));
}

/// Whether a vertex that is tested against the skin has moved so far against any start triangle but the
/// first, which is its anchor: parts of the skin that turn meet it elsewhere.
bool movedAgainstStarts(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float far) {
    if (row.last - row.first < 2) return false;
    const bool onSkin = row.kind == SkinContactKind::SkinOnSkin;
    const SkinBody& body = rig.bodies[row.body];
    const SkinScene::Placed& placed = scene.bodies[row.body];
    const Vec3f place =
        onSkin ? rig.places[row.vertex].head<3>() : body.rest[row.vertex - body.first].head<3>();
    const Vec3f now = onSkin ? scene.skin[row.vertex].head<3>() : scene.surface[row.vertex].head<3>();
    const auto middle = [](const std::vector<Move>& skin, const Tri& t) -> Vec3f {
        return (skin[t[0]] + skin[t[1]] + skin[t[2]]).head<3>() / 3;
    };
    for (std::uint32_t k = row.first + 1; k < row.last; ++k) {
        const Tri& t = rig.triangles[rig.starts[k]];
        const Vec3f at = middle(scene.skin, t), before = place - middle(rig.places, t);
        if ((now - (onSkin || !placed.moved ? at : placed.toBody(at)) - before).squaredNorm() >= far * far)
            return true;
    }
    return false;
}

} // namespace

Vec3f anchorOffset(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    return anchorOffset4(rig, scene, row).head<3>();
}

Vec3f vertexPlace(const SkinScene& scene, const SkinRow& row) {
    if (row.kind == SkinContactKind::SkinOnSkin) return scene.skin[row.vertex].head<3>();
    return scene.bodies[row.body].toSkin(scene.surface[row.vertex].head<3>());
}

float heightOverStarts(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    const Vec3f x = vertexPlace(scene, row);
    float least = std::numeric_limits<float>::max();
    for (std::uint32_t k = row.first; k < row.last; ++k) {
        const Tri& t = rig.triangles[rig.starts[k]];
        const auto edge = [&](int c) -> Vec3f { return (scene.skin[t[c]] - scene.skin[t[0]]).head<3>(); };
        const Vec3f normal = edge(1).cross(edge(2)).normalized();
        least = std::min(least, std::abs(normal.dot(x - scene.skin[t[0]].head<3>())));
    }
    return least;
}

bool mayTouch(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    const bool onSkin = row.kind == SkinContactKind::SkinOnSkin;
    const SkinScene::Placed& placed = scene.bodies[row.body];
    const SkinClearance* at = rig.clearances.data() + row.clearance + (onSkin ? 0 : placed.at.node);
    float free = row.kind == SkinContactKind::SkinOnBody ? at->gap() : skinShare * at->gap();
    // At rest no constraint is violated, so that a small motion may be ignored; a muscle's activation alone
    // may violate one.
    if (onSkin || rig.bodies[row.body].bone()) free = std::max(free, unseen);
    if (!(free > 0)) return true;
    Move expected = at->offsetAndGap;
    if (!onSkin && placed.at.t != 0)
        expected += static_cast<float>(placed.at.t) * (at[1].offsetAndGap - expected);
    const Move change = anchorOffset4(rig, scene, row) - expected; // the fourth component has no meaning
    if (change[0] * change[0] + change[1] * change[1] + change[2] * change[2] >= free * free) return true;
    return row.kind != SkinContactKind::SkinOnBody && movedAgainstStarts(rig, scene, row, free);
}

} // namespace tss
