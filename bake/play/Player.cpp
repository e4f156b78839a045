#include "bake/play/Player.h"
#include "bake/base/Error.h"

#include "bake/base/Stopwatch.h"
#include "bake/model/CheckIndices.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/WholeTurn.h"
#include "bake/play/BelowSkin.h"
#include "bake/play/FreeMuscles.h"
#include "bake/play/JointPlan.h"
#include "bake/play/SkinSetup.h"
#include "bake/respond/SkinCosts.h"
#include "bake/respond/SkinFollowMeasure.h"
#include "bake/respond/SkinResponse.h"
#include "bake/respond/SkinRig.h"
#include "bake/table/Query.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss {

struct Player::State {
    State(const SceneModel& scene, std::vector<std::string>& warnings);

    struct Skin {
        int index = 0; ///< of the scene
        BelowSkin below;
        SkinResponse response;
        std::vector<double> activations;
        std::vector<Pose> poses;        ///< of the muscles' bones since rest; empty: none moves
        std::vector<double> restDepths; ///< one a touched vertex
        SkinFollowMeasure follow;
        DepthMemory depths; ///< of the response's positions
    };

    /// The values asked for, within the limits.
    std::vector<double> clamped(const std::vector<double>& asked) const;

    const SceneModel& scene;
    std::shared_ptr<const JointPlan> plan;
    std::vector<JointWorkspace> buffers;
    std::vector<std::size_t> first;  ///< value of each joint, among all joints' values
    std::vector<int> unserved;       ///< pairs with a table that the plan leaves out
    std::vector<std::size_t> places; ///< of each value of the plan, among all joints' values
    std::vector<double> values;
    std::vector<Skin> skins;
    FreeMuscles freeMuscles;
};

Player::State::State(const SceneModel& scene, std::vector<std::string>& warnings)
    : scene(scene), freeMuscles(scene, warnings) {
    std::vector<std::string> paths;
    for (const Pair& pair : scene.pairs) paths.push_back(pair.path);
    plan = makeJointPlan(scene, paths, &warnings);
    buffers = workspaces(*plan);
    first = firstValues(scene);
    for (int joint : plan->joints)
        for (std::size_t k = 0; k < scene.joints[joint].dofs.size(); ++k) places.push_back(first[joint] + k);
    std::vector<char> served(scene.pairs.size(), 0);
    for (const JointPlan::Group& group : plan->groups)
        for (const int pair : group.pairs) served[pair] = 1;
    for (int k = 0; k < static_cast<int>(scene.pairs.size()); ++k)
        if (scene.pairs[k].table && !served[k]) unserved.push_back(k);
    values = restValues(scene);

    for (std::size_t k = 0; k < scene.skins.size(); ++k) {
        const SkinModel& skin = scene.skins[k];
        const BelowSkin below(skinMuscles(scene, skin), underSkin(scene, skin));
        const auto rig = skinRig(scene, skin);
        const std::vector<double> resting(below.muscles().size(), 0.0);
        skins.push_back({static_cast<int>(k),
                         below,
                         SkinResponse(rig),
                         resting,
                         {},
                         below.at(resting, {}).depths(rig->rest),
                         SkinFollowMeasure(scene.bodies[skin.body].mesh, below.muscles(), *rig),
                         {}});
    }
}

std::vector<double> Player::State::clamped(const std::vector<double>& asked) const {
    if (asked.size() != values.size())
        throw InputError("expected " + std::to_string(values.size()) +
                         " values, one a DOF of all joints, found " + std::to_string(asked.size()));
    std::vector<double> inside;
    std::size_t next = 0;
    for (const Joint& joint : scene.joints) {
        Motion own;
        own.dofs = joint.dofs;
        own.planes = joint.planes;
        std::vector<double> wish(asked.begin() + next, asked.begin() + next + joint.dofs.size());
        for (std::size_t k = 0; k < wish.size(); ++k)
            if (!std::isfinite(wish[k])) wish[k] = values[next + k];
        wrapTurns(own, wish);
        const auto nearest = clampToLimits(own, wish);
        inside.insert(inside.end(), nearest.begin(), nearest.end());
        next += joint.dofs.size();
    }
    return inside;
}

Player::Player(const SceneModel& scene, std::vector<std::string>& warnings)
    : state_((checkIndices(scene), std::make_unique<State>(scene, warnings))) {}
Player::Player(Player&&) noexcept = default;
Player& Player::operator=(Player&&) noexcept = default;
Player::~Player() = default;

Player::Step Player::step(const std::vector<double>& asked, double timeCode) {
    Step result;
    const std::vector<double> goal = state_->clamped(asked);
    std::vector<double> last, wanted;
    for (std::size_t place : state_->places) {
        last.push_back(state_->values[place]);
        wanted.push_back(goal[place]);
    }
    const double began = threadSeconds();
    const std::vector<GroupAnswer> answers = resolve(*state_->plan, last, wanted, state_->buffers);
    result.jointSeconds = threadSeconds() - began;
    state_->values = goal;
    for (std::size_t k = 0; k < state_->places.size(); ++k) state_->values[state_->places[k]] = wanted[k];
    for (const JointAnswer& answer : answers) result.status = std::max(result.status, answer.status);

    result.values = state_->values;
    result.gap = std::numeric_limits<double>::infinity();
    for (std::size_t g = 0; g < state_->plan->groups.size(); ++g)
        for (std::size_t k = 0; k < state_->plan->groups[g].pairs.size(); ++k)
            result.gap = std::min(result.gap, nearest(*state_->plan, g, k, wanted, state_->buffers).gap);
    for (const int unserved : state_->unserved) {
        const Pair& pair = state_->scene.pairs[unserved];
        std::vector<double> q;
        for (const JointDof& dof : pairDofs(state_->scene, pair))
            q.push_back(state_->values[state_->first[dof.joint] + dof.dof]);
        result.gap = std::min(result.gap, query(*pair.table, pose(pair.table->motion, q)).gap);
    }

    state_->freeMuscles.activate(timeCode);
    const std::vector<Pose> placements = posedBodies(state_->scene, state_->values);
    for (State::Skin& skin : state_->skins) {
        const SkinModel& model = state_->scene.skins[skin.index];
        skin.activations = skinActivations(state_->scene, model, timeCode);
        skin.poses = skinPoses(state_->scene, model, placements);
        const double skinBegan = threadSeconds();
        result.pushed.push_back(skin.response.update(skin.activations, skin.poses).pushed);
        result.skinSeconds.push_back(threadSeconds() - skinBegan);
        const std::vector<double> now = skin.below.at(skin.activations, skin.poses, skin.depths)
                                            .depths(skin.response.positions(), &skin.depths);
        double worst = 0;
        for (std::size_t i = 0; i < now.size(); ++i) worst = std::max(worst, now[i] - skin.restDepths[i]);
        result.residualDepths.push_back(worst);
    }
    return result;
}

void Player::charge(std::vector<SkinCosts>& costs) {
    for (std::size_t k = 0; k < state_->skins.size(); ++k) state_->skins[k].response.charge(&costs[k]);
}

std::vector<SkinFollowing> Player::following() const {
    std::vector<SkinFollowing> result;
    for (const State::Skin& skin : state_->skins)
        result.push_back(skin.follow.at(skin.response.positions(), skin.poses));
    return result;
}

std::vector<TriangleMesh> Player::worldMeshes() const {
    std::vector<Pose> placements = posedBodies(state_->scene, state_->values);
    std::vector<TriangleMesh> meshes;
    for (const Body& body : state_->scene.bodies) meshes.push_back(body.mesh);
    state_->freeMuscles.pose(meshes, placements);
    for (const State::Skin& skin : state_->skins) {
        const SkinModel& model = state_->scene.skins[skin.index];
        const auto positions = skin.response.positions();
        for (std::size_t k = 0; k < positions.size(); ++k)
            meshes[model.body].vertices[skin.response.vertices()[k]] = positions[k];
        for (std::size_t m = 0; m < model.muscles.size(); ++m) {
            const MuscleModel& muscle = state_->scene.muscles[model.muscles[m]];
            const Pose toBody = state_->scene.bodies[muscle.body].placement.inverse(Eigen::Isometry) *
                                state_->scene.bodies[model.body].placement;
            if (!skin.below.muscles()[m]->rigid()) {
                std::vector<Vec3>& vertices = meshes[muscle.body].vertices;
                vertices = skin.below.vertices(m, skin.activations, skin.poses);
                for (Vec3& v : vertices) v = toBody * v;
            }
            if (muscle.bone >= 0 && !skin.poses.empty()) // it goes with that, whatever its own prim does
                placements[muscle.body] =
                    placements[model.body] * skin.poses[m] * toBody.inverse(Eigen::Isometry);
        }
    }
    for (std::size_t k = 0; k < meshes.size(); ++k)
        for (Vec3& v : meshes[k].vertices) v = placements[k] * v;
    return meshes;
}

} // namespace tss
