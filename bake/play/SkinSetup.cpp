#include "bake/play/SkinSetup.h"

#include "bake/base/Error.h"
#include "bake/bind/MuscleShares.h"
#include "bake/model/Kinematics.h"
#include "bake/model/UnderSkin.h"
#include "bake/motion/MuscleDeformer.h"
#include "bake/play/MuscleWays.h"
#include "bake/respond/SkinRig.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace tss {
namespace {

const TriangleMesh& meshOf(const SceneModel& scene, const SkinModel& skin) {
    if (skin.body < 0 || skin.body >= static_cast<int>(scene.bodies.size()))
        throw InputError(Where{"", "", skin.path}, "the skin has no mesh");
    return scene.bodies[skin.body].mesh;
}

constexpr int stations = 16; ///< of a swing, after rest

/// What the bones under a skin do while the joint values go from rest to `end`, all in proportion; empty
/// where that moves none of them.
BoneSwing swingTo(const SceneModel& scene, const SkinModel& skin, const std::vector<double>& end) {
    const std::vector<double> rest = restValues(scene);
    BoneSwing swing;
    for (int s = 1; s <= stations; ++s) {
        std::vector<double> values = end;
        for (std::size_t k = 0; k < rest.size() && s < stations; ++k)
            values[k] = rest[k] + (end[k] - rest[k]) * s / stations;
        swing.push_back(skinPoses(scene, skin, posedBodies(scene, values)));
    }
    if (std::ranges::all_of(swing, isAtRest)) swing.clear();
    return swing;
}

constexpr std::size_t mostColumns = 64; ///< joint values that are combined freely: 128 rows at most

/// Whether an entry of a two-level orthogonal array of strength 3 is the upper level (Hedayat, Sloane,
/// Stufken, "Orthogonal Arrays", 1999): in the 2 * bit_ceil(n) rows of n columns any three columns take all
/// eight combinations equally often.
bool upperIn(std::size_t row, std::size_t column) {
    return std::popcount(row & (1 | (column % mostColumns) << 1)) % 2 == 1;
}

/// Fills the swings: one joint value at a time to either limit, and several together. farTurns: takes the
/// joints that turn by more than half a turn from rest.
void addSwings(const SceneModel& scene, const SkinModel& skin, std::vector<std::string>* farTurns,
               SkinParameters& parameters) {
    const std::vector<double> rest = restValues(scene);
    struct Value {
        std::size_t index;
        std::array<double, 2> ends;
    };
    std::vector<Value> values; // that move bones under the skin
    std::size_t next = 0;
    for (const Joint& joint : scene.joints)
        for (const Dof& dof : joint.dofs) {
            const std::size_t before = parameters.swings.size();
            for (const double limit : swingEnds(dof)) {
                if (limit == dof.rest) continue;
                std::vector<double> end = rest;
                end[next] = limit;
                BoneSwing swing = swingTo(scene, skin, end);
                if (swing.empty()) continue;
                parameters.swings.push_back(std::move(swing));
                if (farTurns && std::abs(limit - dof.rest) > (1 + 1e-6) * std::numbers::pi &&
                    dof.kind == DofKind::Rotation)
                    farTurns->push_back(joint.path);
            }
            if (parameters.swings.size() > before) values.push_back({next, swingEnds(dof)});
            ++next;
        }
    if (values.size() < 2) return;
    for (std::size_t row = 0; row < 2 * std::bit_ceil(std::min(values.size(), mostColumns)); ++row) {
        std::vector<double> end = rest;
        for (std::size_t column = 0; column < values.size(); ++column)
            end[values[column].index] = values[column].ends[upperIn(row, column) ? 1 : 0];
        parameters.together.push_back(swingTo(scene, skin, end));
    }
    std::erase_if(parameters.together, [](const BoneSwing& swing) { return swing.empty(); });
}

/// What each body under a skin moves with: one frame a bone. What only a muscle moves with carries no skin.
std::vector<int> framesOf(const SceneModel& scene, const SkinModel& skin) {
    std::vector<int> bones, frames;
    const std::vector<int>& joints = skin.weights.joints;
    for (const UnderSkin& under : underSkin(scene, skin)) {
        const bool carries = under.body >= 0 || std::ranges::find(joints, under.bone) != joints.end();
        const auto known = std::ranges::find(bones, under.bone);
        frames.push_back(under.bone < 0 || !carries ? -1 : static_cast<int>(known - bones.begin()));
        if (frames.back() >= 0 && known == bones.end()) bones.push_back(under.bone);
    }
    return frames;
}

/// The weights that a skin brings along, as shares of the frames.
std::vector<std::vector<double>> sharesOf(const SceneModel& scene, const SkinModel& skin,
                                          const std::vector<int>& frames) {
    const SkinWeights& weights = skin.weights;
    std::vector<std::vector<double>> shares;
    if (weights.joints.empty()) return shares;
    const std::vector<UnderSkin> under = underSkin(scene, skin);
    std::vector<std::size_t> frameOf;
    for (const int joint : weights.joints) {
        const auto found = std::ranges::find_if(under, [&](const UnderSkin& u) { return u.bone == joint; });
        frameOf.push_back(static_cast<std::size_t>(frames[found - under.begin()]));
    }
    const std::size_t count = meshOf(scene, skin).vertices.size();
    shares.assign(static_cast<std::size_t>(*std::ranges::max_element(frames) + 1),
                  std::vector<double>(count, 0));
    for (std::size_t i = 0; i < weights.indices.size(); ++i) {
        double& share = shares[frameOf.at(weights.indices[i])].at(i / weights.influences);
        share = std::min(share + weights.weights[i], 1.0); // floats may sum to a little more
    }
    return shares;
}

/// A bone and all that moves as one with it, which carries a muscle as it does, in the frame of the muscle's
/// surface.
TriangleMesh carrying(const SceneModel& scene, int bone, int surface) {
    const Pose toSurface = scene.bodies[surface].placement.inverse(Eigen::Isometry);
    TriangleMesh all;
    for (const int k : movingAsOne(scene, bone)) {
        const auto first = static_cast<int>(all.vertices.size());
        const Pose pose = toSurface * scene.bodies[k].placement;
        for (const Vec3& v : scene.bodies[k].mesh.vertices) all.vertices.push_back(pose * v);
        for (const Tri& t : scene.bodies[k].mesh.triangles) all.triangles.push_back(t.array() + first);
    }
    return all;
}

Muscle bone(const TriangleMesh& mesh) {
    Muscle muscle;
    muscle.surface = mesh;
    muscle.maxContraction = 0;
    return muscle;
}

} // namespace

std::array<double, 2> swingEnds(const Dof& dof) {
    const double unlimited = dof.kind == DofKind::Rotation ? std::numbers::pi : 0;
    const auto end = [&](double limit, double side) {
        return std::isinf(limit) ? dof.rest + side * unlimited : limit;
    };
    return {end(dof.lower, -1), end(dof.upper, 1)};
}

Muscle muscleOf(const SceneModel& scene, const MuscleModel& model) {
    Muscle muscle = model.muscle;
    muscle.spans = model.insertionBone >= 0;
    if (!muscle.spans || model.bone < 0) return muscle;
    const MuscleWays ways = muscleWays(scene, model);
    muscle.sides = ways.sides;
    std::vector<TriangleMesh> bones{carrying(scene, model.bone, model.body)};
    for (const int bone : muscleChain(scene, model)) bones.push_back(carrying(scene, bone, model.body));
    muscle.chainShares = chainShares(muscle.surface, bones, muscle.form, ways.motions);
    return muscle;
}

std::vector<std::shared_ptr<const MuscleDeformer>> skinMuscles(const SceneModel& scene,
                                                               const SkinModel& skin) {
    meshOf(scene, skin);
    std::vector<std::shared_ptr<const MuscleDeformer>> result;
    const Pose toSkin = scene.bodies[skin.body].placement.inverse();
    for (const UnderSkin& under : underSkin(scene, skin)) {
        const TriangleMesh empty;
        Muscle muscle = under.muscle >= 0 ? muscleOf(scene, scene.muscles[under.muscle])
                                          : bone(under.body >= 0 ? scene.bodies[under.body].mesh : empty);
        const Pose pose = under.body >= 0 ? Pose(toSkin * scene.bodies[under.body].placement) : toSkin;
        // A muscle modelled in the skin's own frame keeps its bits.
        if (!isIdentity(pose)) {
            for (Vec3& v : muscle.surface.vertices) v = pose * v;
            for (Vec3& v : muscle.fibre) v = pose * v;
            for (Eigen::Vector4d& side : muscle.sides) side.head<3>() = pose.linear() * side.head<3>();
        }
        try {
            result.push_back(std::make_shared<const MuscleDeformer>(std::move(muscle)));
        } catch (const InputError& error) {
            throw InputError(Where{error.where.file, error.where.pointer, pathOf(scene, under)},
                             error.message);
        }
    }
    return result;
}

SkinParameters skinParameters(const SceneModel& scene, const SkinModel& skin,
                              std::vector<std::string>* farTurns) {
    meshOf(scene, skin);
    SkinParameters parameters;
    parameters.stretchCompliance = skin.stretchCompliance;
    parameters.bendCompliance = skin.bendCompliance;
    parameters.selfContact = skin.selfContact;
    parameters.frames = framesOf(scene, skin);
    for (const UnderSkin& under : underSkin(scene, skin)) parameters.chains.push_back(under.chain);
    parameters.shares = sharesOf(scene, skin, parameters.frames);
    addSwings(scene, skin, farTurns, parameters);
    parameters.tether = skin.tether;
    parameters.attach = skin.attach;
    return parameters;
}

std::shared_ptr<const SkinRig> skinRig(const SceneModel& scene, const SkinModel& skin) {
    SkinTable none;
    none.table.rowOffsets = {0};
    try {
        return makeSkinRig(meshOf(scene, skin), skinMuscles(scene, skin), skin.table ? *skin.table : none,
                           skinParameters(scene, skin));
    } catch (const InputError& error) {
        if (!error.where.path.empty()) throw;
        throw InputError(Where{"", "", skin.path}, error.message);
    }
}

std::vector<double> skinActivations(const SceneModel& scene, const SkinModel& skin, double timeCode) {
    std::vector<double> activations;
    for (const UnderSkin& under : underSkin(scene, skin))
        activations.push_back(under.muscle < 0 ? 0 : scene.muscles[under.muscle].activation.at(timeCode));
    return activations;
}

std::vector<Pose> skinPoses(const SceneModel& scene, const SkinModel& skin,
                            std::span<const Pose> placements) {
    std::vector<Pose> poses;
    bool any = false;
    const Pose& skinRest = scene.bodies.at(static_cast<std::size_t>(skin.body)).placement;
    const Pose& skinNow = placements[skin.body];
    for (const UnderSkin& under : underSkin(scene, skin)) {
        const int bone = under.bone;
        poses.push_back(Pose::Identity());
        if (bone < 0) continue;
        any = true;
        const Pose& boneRest = scene.bodies[bone].placement;
        const Pose& boneNow = placements[bone];
        const bool still = boneNow.matrix() == boneRest.matrix() && skinNow.matrix() == skinRest.matrix();
        if (!still) poses.back() = skinNow.inverse() * boneNow * boneRest.inverse() * skinRest;
    }
    if (!any) poses.clear();
    return poses;
}

} // namespace tss
