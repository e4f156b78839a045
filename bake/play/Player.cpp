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

class Player::State {
public:
    State(const SceneModel& scene, std::vector<std::string>& warnings);
    std::vector<SkinFollowing> following() const;
    void charge(std::vector<SkinCosts>& costs);
    Step step(const std::vector<double>& asked, double timeCode);
    std::vector<TriangleMesh> worldMeshes() const;

private:
    struct Skin {
        int index = 0; ///< of the scene
        BelowSkin below;
        SkinResponse response;
        std::vector<double> activations;
        std::vector<Pose> poses;        ///< of the muscles' bones since rest; empty: none moves
        std::vector<double> restDepths; ///< one a touched vertex
        SkinFollowMeasure follow;
    };

    std::vector<double> clamped(const std::vector<double>& asked) const;

    const SceneModel& scene_;
    std::shared_ptr<const JointPlan> plan_;
    std::vector<JointWorkspace> workspaces_;
    std::vector<std::size_t> first_;  ///< value of each joint, among all joints' values
    std::vector<int> unserved_;       ///< pairs with a table that the plan leaves out
    std::vector<std::size_t> places_; ///< of each value of the plan, among all joints' values
    std::vector<double> values_;
    std::vector<Skin> skins_;
    FreeMuscles freeMuscles_;
};

Player::State::State(const SceneModel& scene, std::vector<std::string>& warnings)
    : scene_(scene), freeMuscles_(scene, warnings) {
    std::vector<std::string> paths;
    for (const Pair& pair : scene.pairs) paths.push_back(pair.path);
    plan_ = makeJointPlan(scene, paths, &warnings);
    workspaces_ = workspaces(*plan_);
    first_ = firstValues(scene);
    for (int joint : plan_->joints)
        for (std::size_t k = 0; k < scene.joints[joint].dofs.size(); ++k)
            places_.push_back(first_[joint] + k);
    std::vector<char> served(scene.pairs.size(), 0);
    for (const JointPlan::Group& group : plan_->groups)
        for (const int pair : group.pairs) served[pair] = 1;
    for (int k = 0; k < static_cast<int>(scene.pairs.size()); ++k)
        if (scene.pairs[k].table && !served[k]) unserved_.push_back(k);
    values_ = restValues(scene);

    for (std::size_t k = 0; k < scene.skins.size(); ++k) {
        const SkinModel& skin = scene.skins[k];
        const BelowSkin below(skinMuscles(scene, skin), underSkin(scene, skin));
        const auto rig = skinRig(scene, skin);
        const std::vector<double> resting(below.muscles().size(), 0.0);
        skins_.push_back({static_cast<int>(k),
                          below,
                          SkinResponse(rig),
                          resting,
                          {},
                          below.at(resting, {}).depths(rig->rest),
                          SkinFollowMeasure(scene.bodies[skin.body].mesh, below.muscles(), *rig)});
    }
}

std::vector<double> Player::State::clamped(const std::vector<double>& asked) const {
    if (asked.size() != values_.size())
        throw InputError("expected " + std::to_string(values_.size()) +
                         " values, one a DOF of all joints, found " + std::to_string(asked.size()));
    std::vector<double> values;
    std::size_t next = 0;
    for (const Joint& joint : scene_.joints) {
        Motion own;
        own.dofs = joint.dofs;
        own.planes = joint.planes;
        std::vector<double> wish(asked.begin() + next, asked.begin() + next + joint.dofs.size());
        for (std::size_t k = 0; k < wish.size(); ++k)
            if (!std::isfinite(wish[k])) wish[k] = values_[next + k];
        wrapTurns(own, wish);
        const auto inside = clampToLimits(own, wish);
        values.insert(values.end(), inside.begin(), inside.end());
        next += joint.dofs.size();
    }
    return values;
}

Player::Step Player::State::step(const std::vector<double>& asked, double timeCode) {
    Step result;
    const std::vector<double> goal = clamped(asked);
    std::vector<double> last, wanted;
    for (std::size_t place : places_) {
        last.push_back(values_[place]);
        wanted.push_back(goal[place]);
    }
    const double began = threadSeconds();
    const std::vector<GroupAnswer> answers = resolve(*plan_, last, wanted, workspaces_);
    result.jointSeconds = threadSeconds() - began;
    values_ = goal;
    for (std::size_t k = 0; k < places_.size(); ++k) values_[places_[k]] = wanted[k];
    for (const JointAnswer& answer : answers) result.status = std::max(result.status, answer.status);

    result.values = values_;
    result.gap = std::numeric_limits<double>::infinity();
    for (std::size_t g = 0; g < plan_->groups.size(); ++g)
        for (std::size_t k = 0; k < plan_->groups[g].pairs.size(); ++k)
            result.gap = std::min(result.gap, nearest(*plan_, g, k, wanted, workspaces_).gap);
    for (const int unserved : unserved_) {
        const Pair& pair = scene_.pairs[unserved];
        std::vector<double> q;
        for (const JointDof& dof : pairDofs(scene_, pair)) q.push_back(values_[first_[dof.joint] + dof.dof]);
        result.gap = std::min(result.gap, query(*pair.table, pose(pair.table->motion, q)).gap);
    }

    freeMuscles_.activate(timeCode);
    const std::vector<Pose> placements = posedBodies(scene_, values_);
    for (Skin& skin : skins_) {
        const SkinModel& model = scene_.skins[skin.index];
        skin.activations = skinActivations(scene_, model, timeCode);
        skin.poses = skinPoses(scene_, model, placements);
        const double skinBegan = threadSeconds();
        result.pushed.push_back(skin.response.update(skin.activations, skin.poses).pushed);
        result.skinSeconds.push_back(threadSeconds() - skinBegan);
        const std::vector<double> now =
            skin.below.at(skin.activations, skin.poses).depths(skin.response.positions());
        double worst = 0;
        for (std::size_t i = 0; i < now.size(); ++i) worst = std::max(worst, now[i] - skin.restDepths[i]);
        result.residualDepths.push_back(worst);
    }
    return result;
}

void Player::State::charge(std::vector<SkinCosts>& costs) {
    for (std::size_t k = 0; k < skins_.size(); ++k) skins_[k].response.charge(&costs[k]);
}

std::vector<SkinFollowing> Player::State::following() const {
    std::vector<SkinFollowing> result;
    for (const Skin& skin : skins_) result.push_back(skin.follow.at(skin.response.positions(), skin.poses));
    return result;
}

std::vector<TriangleMesh> Player::State::worldMeshes() const {
    std::vector<Pose> placements = posedBodies(scene_, values_);
    std::vector<TriangleMesh> meshes;
    for (const Body& body : scene_.bodies) meshes.push_back(body.mesh);
    freeMuscles_.pose(meshes, placements);
    for (const Skin& skin : skins_) {
        const SkinModel& model = scene_.skins[skin.index];
        const auto positions = skin.response.positions();
        for (std::size_t k = 0; k < positions.size(); ++k)
            meshes[model.body].vertices[skin.response.vertices()[k]] = positions[k];
        for (std::size_t m = 0; m < model.muscles.size(); ++m) {
            const MuscleModel& muscle = scene_.muscles[model.muscles[m]];
            const Pose toBody = scene_.bodies[muscle.body].placement.inverse(Eigen::Isometry) *
                                scene_.bodies[model.body].placement;
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

Player::Player(const SceneModel& scene, std::vector<std::string>& warnings)
    : state_((checkIndices(scene), std::make_unique<State>(scene, warnings))) {}
Player::Player(Player&&) noexcept = default;
Player& Player::operator=(Player&&) noexcept = default;
Player::~Player() = default;

void Player::charge(std::vector<SkinCosts>& costs) {
    state_->charge(costs);
}

std::vector<SkinFollowing> Player::following() const {
    return state_->following();
}

Player::Step Player::step(const std::vector<double>& asked, double timeCode) {
    return state_->step(asked, timeCode);
}

std::vector<TriangleMesh> Player::worldMeshes() const {
    return state_->worldMeshes();
}

} // namespace tss
