#include "bake/play/MuscleWays.h"

#include "bake/model/JointGraph.h"
#include "bake/model/Kinematics.h"

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

} // namespace

Pose insertionMotion(const SceneModel& scene, const MuscleModel& muscle, std::span<const Pose> placements) {
    const auto moved = [&](int body) {
        return Pose(placements[body] * scene.bodies[body].placement.inverse(Eigen::Isometry));
    };
    const Pose& surface = scene.bodies[muscle.body].placement;
    const Pose origin = moved(muscle.bone), insertion = moved(muscle.insertionBone);
    if (origin.matrix() == insertion.matrix()) return Pose::Identity();
    return surface.inverse(Eigen::Isometry) * origin.inverse(Eigen::Isometry) * insertion * surface;
}

MuscleWays muscleWays(const SceneModel& scene, const MuscleModel& muscle) {
    MuscleWays ways;
    const auto chain = findChain(scene.joints, muscle.bone, muscle.insertionBone);
    if (!chain) return ways;
    const Values rest = restValues(scene);
    std::vector<DualPose> all;
    Eigen::Vector4d sum = ways.side;
    for (const Values& end : waysOver(jointEnds(scene, *chain, rest), rest)) {
        Eigen::Vector4d last(0, 0, 0, 1);
        for (int s = 1; s <= waySamples; ++s) {
            Values values = rest;
            for (std::size_t k = 0; k < rest.size(); ++k)
                if (end[k] != rest[k]) values[k] += (end[k] - rest[k]) * s / waySamples;
            all.push_back(
                DualPose(insertionMotion(scene, muscle, posedBodies(scene, values))).inHemisphereOf(last));
            last = all.back().real;
            sum += last;
            if (s % kept == 0) ways.far.push_back(all.back());
        }
    }
    const auto fails = [&](const Eigen::Vector4d& side) {
        return std::any_of(all.begin(), all.end(), [&](const DualPose& motion) {
            return side.dot(motion.real) < -1e-6 || motion.real[3] < wholeTurnNear;
        });
    };
    // Rest tells where nothing turns by more than half a turn.
    if (!fails(ways.side)) return ways;
    const Eigen::Vector4d mean = sum.normalized();
    ways.unclear = fails(mean);
    if (!ways.unclear) ways.side = mean;
    return ways;
}

} // namespace tss
