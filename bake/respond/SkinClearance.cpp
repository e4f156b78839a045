#include "bake/respond/SkinContact.h"

#include <algorithm>

namespace tss {
namespace {

/// Share of a gap over which a vertex may come nearer to the skin before they are queried: beside the anchor
/// skin that is stretched may have come the rest of the way.
constexpr float skinShare = 0.5f;

/// Calls until(k, offset) for each start k of a row, until it returns true, and returns whether it did.
/// offset: from the start to the vertex, in the body's frame: from the anchor, or from the middle of the
/// start triangle on the skin. Of a bone, which never moves in that frame, the vertex itself. Its fourth
/// component has no meaning.
template <class Until>
bool eachOffset(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, const Until& until) {
    const SkinScene::Placed& placed = scene.bodies[row.body];
    const auto toBody = [&](const Move& x) -> Move {
        const Eigen::Vector3f y = placed.toBody(x.head<3>());
        return {y[0], y[1], y[2], 0};
    };
    const Move* skin = scene.skin.data();
    const int* starts = rig.starts.data() + row.first;
    if (row.kind == SkinContactKind::SkinOnBody) {
        const SkinBody& body = rig.bodies[row.body];
        const Move x = placed.moved ? toBody(skin[row.vertex]) : skin[row.vertex];
        if (body.bone()) return until(0, x);
        const Move* surface = scene.surface.data() + body.first;
        const Tri& t = body.triangles[starts[0]];
        return until(0, x - (row.weights[0] * surface[t[0]] + row.weights[1] * surface[t[1]] +
                             row.weights[2] * surface[t[2]]));
    }
    const bool onSkin = row.kind == SkinContactKind::SkinOnSkin;
    const Move x = onSkin ? skin[row.vertex] : scene.surface[row.vertex];
    for (std::uint32_t k = 0; k < row.last - row.first; ++k) {
        const Tri& t = rig.triangles[starts[k]];
        Move middle = (skin[t[0]] + skin[t[1]] + skin[t[2]]) * (1 / 3.0f);
        if (!onSkin && placed.moved) middle = toBody(middle);
        if (until(k, x - middle)) return true;
    }
    return false;
}

} // namespace

Eigen::Vector3f vertexPlace(const SkinScene& scene, const SkinRow& row) {
    if (row.kind == SkinContactKind::SkinOnSkin) return scene.skin[row.vertex].head<3>();
    return scene.bodies[row.body].toSkin(scene.surface[row.vertex].head<3>());
}

Eigen::Vector3f anchorOffset(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    Eigen::Vector3f first = Eigen::Vector3f::Zero();
    eachOffset(rig, scene, row, [&](std::uint32_t, const Move& offset) {
        first = offset.head<3>();
        return true;
    });
    return first;
}

std::size_t clearancesAtRest(const SkinRig& rig, const SkinRow& row) {
    const bool onSkin = row.kind == SkinContactKind::SkinOnSkin;
    return row.clearance + (onSkin ? 0 : rig.bodies[row.body].restNode * (row.last - row.first));
}

void measureOffsets(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, Move* starts) {
    eachOffset(rig, scene, row, [&](std::uint32_t k, const Move& offset) {
        starts[k].head<3>() = offset.head<3>();
        return false;
    });
}

bool mayTouch(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    const bool onSkin = row.kind == SkinContactKind::SkinOnSkin;
    const std::uint32_t starts = row.last - row.first;
    const TrackPlace& place = scene.bodies[row.body].at;
    const Move* at = rig.clearances.data() + row.clearance + (onSkin ? 0 : place.node * starts);
    const float gap = at[0][3];
    float free = row.kind == SkinContactKind::SkinOnBody ? gap : skinShare * gap;
    // At rest no constraint is violated, so that a small motion may be ignored; a muscle's activation alone
    // may violate one.
    if (onSkin || rig.bodies[row.body].bone()) free = std::max(free, unseen);
    if (!(free > 0)) return true;
    const float t = onSkin ? 0 : static_cast<float>(place.t);
    return eachOffset(rig, scene, row, [&](std::uint32_t k, const Move& offset) {
        Move expected = at[k];
        if (t != 0) expected += t * (at[starts + k] - expected);
        const Move change = offset - expected;
        return change[0] * change[0] + change[1] * change[1] + change[2] * change[2] >= free * free;
    });
}

} // namespace tss
