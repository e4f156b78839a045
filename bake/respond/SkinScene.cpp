#include "bake/respond/SkinScene.h"

#include <algorithm>

namespace tss {
namespace {

/// Deforms a muscle over several bones by their motions; `moves` include its swelling.
void spanMuscle(const SkinBody& body, SkinScene::Placed& placed, SkinScene& scene) {
    std::vector<Vec3> places(body.count), normals(body.count);
    for (std::uint32_t v = 0; v < body.count; ++v) {
        places[v] = scene.surface[body.first + v].head<3>().cast<double>();
        normals[v] = scene.normals[body.first + v].head<3>().cast<double>();
    }
    const double swell = body.span->carry(placed.bones, places, normals);
    for (std::uint32_t v = 0; v < body.count; ++v) {
        scene.surface[body.first + v].head<3>() = places[v].cast<float>();
        scene.normals[body.first + v].head<3>() = normals[v].cast<float>();
        scene.moves[body.first + v].head<3>() += (swell * body.span->swelling()[v]).cast<float>();
    }
}

/// Interpolates the surface at an activation. bones: of a muscle over several, their motions.
void placeSurface(const SkinBody& body, double activation, ChainMotion bones, SkinScene::Placed& placed,
                  SkinScene& scene) {
    const auto same = [](const Pose& a, const Pose& b) { return a.matrix() == b.matrix(); };
    if (placed.activation == activation && std::ranges::equal(placed.bones, bones, same)) return;
    placed.activation = activation;
    placed.bones = std::move(bones);
    const TrackPlace at = placed.at = locate(body.nodes, activation);
    const float t = static_cast<float>(at.t);
    const std::size_t from = at.node * body.count, to = at.t == 0 ? from : from + body.count;
    const auto mix = [t](const Move* a, const Move* b, std::uint32_t v) -> Move {
        return a[v] + t * (b[v] - a[v]);
    };
    const Move *places = body.places.data(), *normals = body.normals.data(), *rest = body.rest.data();
    Move *surface = scene.surface.data() + body.first, *moves = scene.moves.data() + body.first,
         *surfaceNormals = scene.normals.data() + body.first;
    for (std::uint32_t v = 0; v < body.count; ++v) {
        surface[v] = mix(places + from, places + to, v);
        surfaceNormals[v] = mix(normals + from, normals + to, v);
        moves[v] = surface[v] - rest[v];
    }
    if (!isAtRest(placed.bones)) spanMuscle(body, placed, scene);
}

/// The mean motion of the frames that a vertex has shares in; none where all of these are at rest.
std::optional<Pose> blendedPose(const SkinRig& rig, const SkinScene& scene, std::size_t v) {
    PoseBlend blend;
    bool moves = false;
    for (const auto& [frame, share] : rig.frameShares[v])
        if (const std::optional<DualPose>& pose = scene.frames[frame]) {
            blend.add(static_cast<double>(share), *pose);
            moves = true;
        }
    return moves ? std::optional(blend.pose()) : std::nullopt;
}

/// Turns a vertex that muscles have displaced, and its normal, by dual quaternion skinning.
void turn(const SkinRig& rig, SkinScene& scene, std::size_t v) {
    const std::optional<Pose> pose = blendedPose(rig, scene, v);
    scene.skinNormals[v] = rig.placeNormals[v];
    if (!pose) return;
    Move &place = scene.carried[v], &normal = scene.skinNormals[v];
    place.head<3>() = (*pose * place.head<3>().cast<double>()).cast<float>();
    normal.head<3>() = (pose->linear() * normal.head<3>().cast<double>()).cast<float>();
}

/// turns: whether bones turn skin, or have at the last update.
void placeBlock(const SkinRig& rig, std::size_t block, bool turns, std::span<const Vec3> shift,
                SkinScene& scene) {
    const auto [first, last] = rig.verticesOf(block);
    // Plain pointers let the compiler assume that writing positions changes no size or pointer.
    const Move *rest = rig.places.data(), *moves = scene.moves.data();
    Move* carried = scene.carried.data();
    for (std::size_t v = first; v < last; ++v) {
        Move sum = Move::Zero();
        for (const auto& [from, share] : rig.pulls[v]) sum += share * moves[from];
        carried[v] = rest[v] + sum;
    }
    for (std::size_t v = first; v < last && !shift.empty(); ++v)
        carried[v].head<3>() += (shift[v] / rig.size).cast<float>();
    for (std::size_t v = first; v < last && turns; ++v) turn(rig, scene, v);
    std::copy(carried + first, carried + last, scene.skin.data() + first);
}

void prepareScene(const SkinRig& rig, SkinScene& scene) {
    scene.bodies.resize(rig.bodies.size());
    scene.surface.assign(rig.bodyVertices, Move::Zero());
    scene.normals = scene.moves = scene.surface;
    scene.live.assign(rig.blocks(), 0);
    scene.carried = scene.skin = rig.places;
    scene.skin.insert(scene.skin.end(), rig.borderPlaces.begin(), rig.borderPlaces.end());
    scene.skin.push_back(Move::Zero()); // SkinNormalKernel
    scene.skinNormals = rig.placeNormals;
}

} // namespace

void placeBodies(const SkinRig& rig, std::span<const double> activations, std::span<const Pose> poses,
                 std::span<const Vec3> shift, SkinScene& scene) {
    if (scene.bodies.size() != rig.bodies.size()) prepareScene(rig, scene);
    scene.frames.assign(rig.frames, std::nullopt);
    // Bits of `live` in here: 1, the block was live at the last update; 2, it is now.
    const auto wake = [&](const std::vector<std::uint32_t>& blocks) {
        for (const std::uint32_t b : blocks) scene.live[b] |= 2;
    };
    scene.local.clear();
    for (const Pose& pose : poses) scene.local.push_back(rig.local(pose));
    for (std::size_t m = 0; m < rig.bodies.size(); ++m) {
        const SkinBody& body = rig.bodies[m];
        SkinScene::Placed& placed = scene.bodies[m];
        placeSurface(body, activations[m], chainMotion(scene.local, m, body.chain), placed, scene);
        if (activations[m] != 0 || !isAtRest(placed.bones)) wake(body.blocks);
        placed.moved = !isIdentity(poses[m]);
        if (!placed.moved) continue;
        placed.turn = scene.local[m].linear().cast<float>();
        placed.shift = scene.local[m].translation().cast<float>();
        if (body.frame < 0 || scene.frames[body.frame]) continue;
        scene.frames[body.frame] = DualPose(scene.local[m]);
        wake(rig.frameBlocks[body.frame]);
    }
    const bool turns = std::ranges::any_of(scene.frames, [](const auto& pose) { return pose.has_value(); });
    for (std::size_t b = 0; b < scene.live.size(); ++b) {
        if (!shift.empty()) scene.live[b] |= 2;
        if (scene.live[b] != 0) placeBlock(rig, b, turns || scene.turned, shift, scene);
        scene.live[b] = (scene.live[b] & 2) / 2;
    }
    scene.turned = turns;
}

Eigen::Matrix3f turnOf(const SkinRig& rig, const SkinScene& scene, std::size_t v) {
    return blendedPose(rig, scene, v).value_or(Pose::Identity()).linear().cast<float>();
}

} // namespace tss
