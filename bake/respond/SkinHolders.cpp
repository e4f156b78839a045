#include "bake/respond/SkinParts.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace tss {
namespace {

/// The surfaces that stand for a frame: its bones, or its muscles where it has none.
FrameHolder holderOf(const SkinGround& ground, const std::vector<int>& frames, int frame) {
    const std::size_t count = ground.skin.vertices.size();
    FrameHolder made;
    made.holder.distance.assign(count, infinity);
    made.nearest = ground.skin.vertices;
    bool bones = false;
    for (std::size_t m = 0; m < frames.size(); ++m) bones |= frames[m] == frame && ground.bodies[m]->rigid();
    for (std::size_t m = 0; m < frames.size(); ++m) {
        if (frames[m] != frame || ground.bodies[m]->rigid() != bones) continue;
        made.bodies.push_back(m);
        made.box.extend(bounds(ground.bodies[m]->muscle().surface));
        parallelFor(count, [&](std::size_t v) {
            double& distance = made.holder.distance[v];
            const NearestPoint near = ground.locators[m].nearest(ground.skin.vertices[v], distance);
            if (near.triangle < 0) return;
            distance = near.distance;
            made.nearest[v] = near.point;
        });
    }
    made.extent = made.box.isEmpty() ? 0 : made.box.diagonal().norm();
    made.holder.size = made.extent;
    return made;
}

/// How often frames move, and about what. Returns which frames move in each swing: #swings of #holders,
/// those alike once.
std::set<std::vector<char>> setMotions(const SkinParameters& p, const std::vector<int>& frames,
                                       std::vector<FrameHolder>& holders) {
    struct Least {
        std::size_t movers = 0; ///< frames that move in its own swings, the fewest
        Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
        Vec3 right = Vec3::Zero();
    };
    std::vector<Least> least(holders.size());
    std::set<std::vector<char>> groups;
    for (FrameHolder& holder : holders) holder.moves = p.swings.empty();
    for (const BoneSwing& swing : p.swings) {
        std::map<std::size_t, Pose> moved;
        for (const std::vector<Pose>& station : swing)
            for (std::size_t m = 0; m < station.size(); ++m)
                if (frames[m] >= 0 && station[m].matrix() != Pose::Identity().matrix())
                    moved[static_cast<std::size_t>(frames[m])] = station[m];
        std::vector<char> group(holders.size(), 0);
        for (const auto& [h, pose] : moved) group[h] = 1;
        groups.insert(group);
        for (const auto& [h, pose] : moved) {
            ++holders[h].moves;
            Least& own = least[h];
            if (own.movers != 0 && own.movers < moved.size()) continue;
            if (own.movers != moved.size()) own = {moved.size()};
            const Eigen::Matrix3d turn = pose.linear() - Eigen::Matrix3d::Identity();
            own.matrix += turn.transpose() * turn;
            own.right -= turn.transpose() * (pose * holders[h].box.center() - holders[h].box.center());
        }
    }
    for (std::size_t h = 0; h < holders.size(); ++h) {
        if (holders[h].box.isEmpty()) continue;
        const Vec3 middle = holders[h].box.center();
        holders[h].joint = middle;
        const double some = 1e-6 * least[h].matrix.trace();
        if (!(some > 0)) continue;
        const auto places = (least[h].matrix + some * Eigen::Matrix3d::Identity()).eval().ldlt();
        holders[h].joint += places.solve(least[h].right); // along an axis the place beside the middle
        const FrameHolder* before = boneBefore(holders, h);
        const Vec3 from = before ? Vec3(middle - before->box.center()) : Vec3::Zero();
        holders[h].twists = some * places.solve(from).norm() > aheadCosine * from.norm();
    }
    return groups;
}

} // namespace

const FrameHolder* boneBefore(const std::vector<FrameHolder>& holders, std::size_t bone) {
    const Vec3 middle = holders[bone].box.center();
    const FrameHolder* before = nullptr;
    for (const FrameHolder& other : holders) {
        if (other.moves >= holders[bone].moves || other.box.isEmpty()) continue;
        if (!before || (other.box.center() - middle).norm() < (before->box.center() - middle).norm())
            before = &other;
    }
    return before;
}

std::vector<SkinHolder> skinHolders(const SkinGround& ground, const SkinParameters& parameters,
                                    const std::vector<int>& frames) {
    std::vector<FrameHolder> holders;
    const int count = frames.empty() ? 0 : *std::max_element(frames.begin(), frames.end()) + 1;
    for (int f = 0; f < count; ++f) holders.push_back(holderOf(ground, frames, f));
    const std::set<std::vector<char>> groups = setMotions(parameters, frames, holders);
    bool onSkin = false; // something moves with the skin itself
    for (std::size_t m = 0; m < frames.size(); ++m)
        onSkin |= frames[m] < 0 && !ground.bodies[m]->muscle().surface.empty();
    if (onSkin) {
        holders.push_back(holderOf(ground, frames, -1));
        holders.back().holder.size = infinity;
    }
    return holdParts(ground, std::move(holders), {groups.begin(), groups.end()});
}

} // namespace tss
