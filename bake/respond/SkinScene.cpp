#include "bake/respond/SkinScene.h"

namespace tss {
namespace {

bool isIdentity(const Pose& pose) {
    return pose.matrix() == Pose::Identity().matrix();
}

/// The far end goes with the insertion's bone, and what muscles move by swells with the belly.
void placeFar(const SkinBody& body, const Pose& far, SkinScene::Placed& placed, SkinScene& scene) {
    std::vector<Vec3> places(body.count), normals(body.count);
    for (std::uint32_t v = 0; v < body.count; ++v) {
        places[v] = scene.surface[body.first + v].head<3>().cast<double>();
        normals[v] = scene.normals[body.first + v].head<3>().cast<double>();
    }
    const double swell = body.span->carry(far, places, normals);
    for (std::uint32_t v = 0; v < body.count; ++v) {
        scene.surface[body.first + v].head<3>() = places[v].cast<float>();
        scene.normals[body.first + v].head<3>() = normals[v].cast<float>();
        scene.moves[body.first + v].head<3>() += (swell * body.span->swelling()[v]).cast<float>();
    }
    placed.strain = std::max(placed.strain, body.strainOf(scene.surface.data() + body.first));
}

/// far: of the insertion's bone against the origin's, run-time lengths.
void placeSurface(const SkinBody& body, double activation, const Pose& far, SkinScene::Placed& placed,
                  SkinScene& scene) {
    if (placed.activation == activation && placed.far.matrix() == far.matrix()) return;
    placed.activation = activation;
    placed.far = far;
    const TrackPlace at = locate(body.nodes, activation);
    const float t = static_cast<float>(at.t);
    const std::size_t from = at.node * body.count, to = at.t == 0 ? from : from + body.count;
    for (std::uint32_t v = 0; v < body.count; ++v) {
        const Move place = body.places[from + v] + t * (body.places[to + v] - body.places[from + v]);
        scene.surface[body.first + v] = place;
        scene.normals[body.first + v] =
            body.normals[from + v] + t * (body.normals[to + v] - body.normals[from + v]);
        scene.moves[body.first + v] = place - body.rest[v];
    }
    placed.strain = body.strain[at.node];
    if (at.t != 0) placed.strain = std::max(placed.strain, body.strain[at.node + 1]);
    if (!isIdentity(far)) placeFar(body, far, placed, scene);
}

/// Turns what muscles have displaced, and the normals, by the frames' shares.
void turnSkin(const SkinRig& rig, SkinScene& scene) {
    scene.skinNormals = rig.placeNormals;
    for (std::size_t v = 0; v < rig.places.size(); ++v) {
        const SkinFrameShare* share = rig.frameShares.data() + rig.frameStart[v];
        const SkinFrameShare* end = rig.frameShares.data() + rig.frameStart[v + 1];
        PoseBlend blend;
        bool moves = false;
        for (; share != end; ++share)
            if (!scene.still[share->frame]) {
                blend.add(static_cast<double>(share->share), scene.frames[share->frame]);
                moves = true;
            }
        if (!moves) continue;
        const Pose pose = blend.pose();
        const Vec3 rest = rig.places[v].head<3>().cast<double>();
        const Vec3 now = pose * (rest + scene.base[v].head<3>().cast<double>());
        scene.base[v].head<3>() = (now - rest).cast<float>();
        scene.skinNormals[v].head<3>() =
            (pose.linear() * rig.placeNormals[v].head<3>().cast<double>()).cast<float>();
    }
}

} // namespace

void placeBodies(const SkinRig& rig, std::span<const double> activations, std::span<const Pose> poses,
                 std::span<const Vec3> shift, SkinScene& scene) {
    if (scene.bodies.size() != rig.bodies.size()) {
        scene.bodies.resize(rig.bodies.size());
        scene.surface.assign(rig.bodyVertices, Move::Zero());
        scene.normals = scene.moves = scene.surface;
        scene.base.resize(rig.places.size());
        scene.skin = scene.base;
    }
    scene.frames.resize(rig.frames);
    scene.still.assign(rig.frames, true);
    bool turned = false;
    for (std::size_t m = 0; m < rig.bodies.size(); ++m) {
        const SkinBody& body = rig.bodies[m];
        SkinScene::Placed& placed = scene.bodies[m];
        const Pose far = body.insertion < 0 ? Pose::Identity()
                                            : between(rig.local(poses[m]), rig.local(poses[body.insertion]));
        placeSurface(body, activations[m], far, placed, scene);
        placed.moved = !isIdentity(poses[m]);
        if (!placed.moved) continue;
        const Pose local = rig.local(poses[m]);
        placed.turn = local.linear().cast<float>();
        placed.shift = local.translation().cast<float>();
        if (body.frame < 0 || !scene.still[body.frame]) continue;
        scene.frames[body.frame] = DualPose(local);
        scene.still[body.frame] = false;
        turned = true;
    }
    const SkinPull* pull = rig.pulls.data();
    for (std::size_t v = 0; v < rig.places.size(); ++v) {
        Move sum = Move::Zero();
        for (const SkinPull* end = rig.pulls.data() + rig.pullStart[v + 1]; pull != end; ++pull)
            sum += pull->share * scene.moves[pull->from];
        if (!shift.empty()) sum.head<3>() += (shift[v] / rig.size).cast<float>();
        scene.base[v] = sum;
    }
    scene.skinNormals.clear();
    if (turned) turnSkin(rig, scene);
    for (std::size_t v = 0; v < rig.places.size(); ++v) scene.skin[v] = rig.places[v] + scene.base[v];
}

} // namespace tss
