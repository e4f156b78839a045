#include "Reach.h"

#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/WholeTurn.h"
#include "bake/play/SkinSetup.h"
#include "bake/respond/SkinResponse.h"
#include "bake/respond/SkinRig.h"

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <vector>

namespace osgTSS {

namespace {

/// Where a DOF is at a share, 0 to 1, of the motion: as it is driven at `time`; else at rest, or, where the
/// graph's own animations play, up and down its range, `rounds` times.
double valueAt(const tss::Joint& joint, std::size_t dof, double time, bool animated, double share,
               int rounds) {
    if (tss::isDriven(joint, dof)) return joint.drives[dof].at(time);
    const tss::Dof& range = joint.dofs[dof];
    if (!animated) return range.rest;
    const auto [lower, upper] = tss::limitsAboutRest(range);
    return (lower + upper) / 2 + (upper - lower) / 2 * std::sin(2 * osg::PI * rounds * share);
}

/// How many intervals of the motion are looked at: of one that is driven each time code, as long as that is
/// quick.
int intervals(const tss::SceneModel& model, bool animated) {
    constexpr double least = 200, points = 2e7; // looked at, some tenths of a second
    if (animated) return static_cast<int>(least);
    std::size_t vertices = 1;
    for (const tss::Body& body : model.bodies) vertices += body.mesh.vertices.size();
    const double codes = std::floor(model.endTimeCode - model.startTimeCode);
    return static_cast<int>(std::clamp(codes, 0.0, std::max(least, points / static_cast<double>(vertices))));
}

/// A skin, to be drawn once for each pose of its bones.
struct MovingSkin {
    const tss::SkinModel& skin;
    tss::SkinResponse response;
};

/// By their bodies. One without a table, or whose table does not fit, is drawn as it lies there, as the
/// loader has said.
std::map<std::size_t, MovingSkin> movingSkins(const tss::SceneModel& model) {
    std::map<std::size_t, MovingSkin> skins;
    for (const tss::SkinModel& skin : model.skins) {
        try {
            if (const auto rig = tss::skinRig(model, skin))
                skins.emplace(skin.body, MovingSkin{skin, tss::SkinResponse(rig)});
        } catch (const tss::InputError&) {
            continue;
        }
    }
    return skins;
}

/// Bodies that stand still and dwarf all that moves, as a ground does: with them in sight nothing of that
/// would be seen.
std::vector<bool> scenery(const tss::SceneModel& model) {
    constexpr double dwarfing = 30;
    const std::vector<int> roots = tss::rigidRoots(model);
    const std::vector<bool> soft = tss::softBodies(model);
    std::vector<double> rest;
    for (const tss::Joint& joint : model.joints)
        for (const tss::Dof& dof : joint.dofs) rest.push_back(dof.rest);
    const std::vector<tss::Pose> poses = tss::posedBodies(model, rest);
    const auto stands = [&](std::size_t body) { return roots[body] < 0 && !soft[body]; };
    Eigen::AlignedBox3d moving;
    for (std::size_t body = 0; body < poses.size(); ++body)
        if (!stands(body) && model.bodies[body].visible)
            for (const tss::Vec3& v : model.bodies[body].mesh.vertices) moving.extend(poses[body] * v);
    std::vector<bool> found(poses.size());
    for (std::size_t body = 0; body < poses.size(); ++body)
        found[body] = !moving.isEmpty() && stands(body) &&
                      tss::diagonal(model.bodies[body].mesh) > dwarfing * moving.diagonal().norm();
    return found;
}

} // namespace

void addReach(Framing& framing, const tss::SceneModel& model, bool turned, bool animated, bool still) {
    std::map<std::size_t, MovingSkin> skins = movingSkins(model);
    const std::vector<bool> aside = scenery(model);
    const int count = still ? 0 : intervals(model, animated);
    const double codes = std::floor(model.endTimeCode - model.startTimeCode);
    for (int k = 0; k <= count; ++k) {
        const double share = count ? static_cast<double>(k) / count : 0;
        const double time = model.startTimeCode + codes * share;
        std::vector<double> values;
        for (const tss::Joint& joint : model.joints)
            for (std::size_t dof = 0; dof < joint.dofs.size(); ++dof)
                values.push_back(
                    valueAt(joint, dof, time, animated, share, 1 + static_cast<int>(values.size() % 3)));
        const std::vector<tss::Pose> poses = tss::posedBodies(model, values);
        for (std::size_t body = 0; body < poses.size(); ++body) {
            if (!model.bodies[body].visible || aside[body]) continue;
            std::span<const tss::Vec3> points = model.bodies[body].mesh.vertices;
            if (const auto found = skins.find(body); found != skins.end()) {
                auto& [skin, response] = found->second;
                response.update(tss::skinActivations(model, skin, time), tss::skinPoses(model, skin, poses));
                points = response.positions();
            }
            for (const tss::Vec3& v : points) framing.add(shown(tss::Vec3(poses[body] * v), turned));
        }
    }
}

bool hasScenery(const tss::SceneModel& model) {
    const std::vector<bool> aside = scenery(model);
    return std::ranges::find(aside, true) != aside.end();
}

} // namespace osgTSS
