#include "bake/play/MuscleWays.h"

#include "bake/model/JointGraph.h"
#include "bake/model/Kinematics.h"
#include "bake/model/UnderSkin.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Samples of a way from rest to limits: so many that joints that turn by less than a whole turn turn by less
/// than half a turn from one sample to the next, which tells the way round.
constexpr int waySamples = 16;
constexpr int kept = 4;                ///< every so many of the samples is returned
constexpr std::size_t mostWays = 64;   ///< combinations of several joints
constexpr double wholeTurnNear = -0.9; ///< cosine of half the angle of a turn of 308 degrees

/// Values of all DOFs of the scene at the end of a way.
using Values = std::vector<double>;

/// The ends that one value at a time goes to, joint by joint of the chain.
std::vector<std::vector<Values>> jointEnds(const SceneModel& scene, const std::vector<int>& chain,
                                           const Values& rest) {
    const std::vector<std::size_t> first = firstValues(scene);
    std::vector<std::vector<Values>> ends;
    for (const int j : chain) {
        ends.emplace_back();
        const std::vector<Dof>& dofs = scene.joints[j].dofs;
        for (std::size_t d = 0; d < dofs.size(); ++d)
            for (const double limit : {dofs[d].lower, dofs[d].upper}) {
                if (!std::isfinite(limit) || limit == dofs[d].rest) continue;
                ends.back().push_back(rest);
                ends.back().back()[first[j] + d] = limit;
            }
    }
    return ends;
}

/// The ends of all ways: one value at a time, then, of two or more joints, one value of each together.
std::vector<Values> waysOver(const std::vector<std::vector<Values>>& ends, const Values& rest) {
    std::vector<Values> single, together{rest};
    for (const std::vector<Values>& joint : ends) {
        single.insert(single.end(), joint.begin(), joint.end());
        if (joint.empty() || together.size() * joint.size() > mostWays) continue;
        std::vector<Values> next;
        for (const Values& before : together)
            for (const Values& end : joint) {
                next.push_back(before);
                for (std::size_t k = 0; k < rest.size(); ++k)
                    if (end[k] != rest[k]) next.back()[k] = end[k];
            }
        together = std::move(next);
    }
    const auto bent = [](const std::vector<Values>& joint) { return !joint.empty(); };
    if (std::count_if(ends.begin(), ends.end(), bent) > 1)
        single.insert(single.end(), together.begin(), together.end());
    return single;
}

/// Of each bone of a chain the quaternion that turns it against the bone before it.
using Steps = std::vector<Eigen::Vector4d>;

/// The motions of a chain's bones with the signs of their steps.
std::vector<DualPose> turnedAs(const ChainMotion& motion, const Steps& steps) {
    std::vector<DualPose> result;
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    for (std::size_t k = 0; k < steps.size(); ++k) {
        turn = turn * Eigen::Quaterniond(steps[k]);
        result.push_back(DualPose(motion[k]).inHemisphereOf(turn.coeffs()));
    }
    return result;
}

} // namespace

ChainMotion muscleMotion(const SceneModel& scene, const MuscleModel& muscle, std::span<const int> chain,
                         std::span<const Pose> placements) {
    const auto moved = [&](int body) {
        return Pose(placements[body] * scene.bodies[body].placement.inverse(Eigen::Isometry));
    };
    const Pose& surface = scene.bodies[muscle.body].placement;
    const Pose origin = moved(muscle.bone);
    ChainMotion motion;
    for (const int body : chain) {
        const Pose bone = moved(body);
        motion.push_back(
            origin.matrix() == bone.matrix()
                ? Pose::Identity()
                : Pose(surface.inverse(Eigen::Isometry) * origin.inverse(Eigen::Isometry) * bone * surface));
    }
    return motion;
}

MuscleWays muscleWays(const SceneModel& scene, const MuscleModel& muscle) {
    MuscleWays ways;
    const std::vector<int> chain = muscleChain(scene, muscle);
    const auto joints = findChain(scene.joints, muscle.bone, muscle.insertionBone);
    if (!joints) return ways;
    const Values rest = restValues(scene);
    const Eigen::Vector4d unturned(0, 0, 0, 1);
    std::vector<Steps> all;
    Steps sum(chain.size(), unturned);
    ways.sides = sum;
    for (const Values& end : waysOver(jointEnds(scene, *joints, rest), rest)) {
        Steps last(chain.size(), unturned);
        for (int s = 1; s <= waySamples; ++s) {
            Values values = rest;
            for (std::size_t k = 0; k < rest.size(); ++k)
                if (end[k] != rest[k]) values[k] += (end[k] - rest[k]) * s / waySamples;
            const ChainMotion motion = muscleMotion(scene, muscle, chain, posedBodies(scene, values));
            const ChainBlend blend(motion, last);
            for (std::size_t k = 0; k < chain.size(); ++k) sum[k] += last[k] = blend.steps()[k].real;
            all.push_back(last);
            if (s % kept == 0) ways.motions.push_back(turnedAs(motion, last));
        }
    }
    Steps mean;
    for (const Eigen::Vector4d& side : sum) mean.push_back(side.normalized());
    for (std::size_t k = 0; k < chain.size(); ++k) {
        const auto fails = [&](const Eigen::Vector4d& side) {
            return std::ranges::any_of(all, [&](const Steps& steps) {
                return side.dot(steps[k]) < -1e-6 || steps[k][3] < wholeTurnNear;
            });
        };
        // Rest tells where nothing turns by more than half a turn.
        if (!fails(ways.sides[k])) continue;
        if (fails(mean[k]))
            ways.unclear = true;
        else
            ways.sides[k] = mean[k];
    }
    return ways;
}

} // namespace tss
