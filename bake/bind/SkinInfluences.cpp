#include "bake/bind/SkinParts.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"

#include <algorithm>
#include <map>

namespace tss {
namespace {

/// Collects the bodies of a frame, its bones or, if it has none, its muscles, and measures distances to them.
FrameInfluence frameInfluence(const SkinAnatomy& anatomy, const std::vector<int>& frames, int frame) {
    const std::size_t count = anatomy.skin.vertices.size();
    FrameInfluence made;
    made.influence.distance.assign(count, infinity);
    made.nearest = anatomy.skin.vertices;
    bool bones = false;
    for (std::size_t m = 0; m < frames.size(); ++m) bones |= frames[m] == frame && anatomy.bodies[m]->rigid();
    for (std::size_t m = 0; m < frames.size(); ++m) {
        if (frames[m] != frame || anatomy.bodies[m]->rigid() != bones) continue;
        made.bodies.push_back(m);
        made.box.extend(bounds(anatomy.bodies[m]->muscle().surface));
        parallelFor(count, [&](std::size_t v) {
            double& distance = made.influence.distance[v];
            const NearestPoint near = anatomy.locators[m].nearest(anatomy.skin.vertices[v], distance);
            if (near.triangle < 0) return;
            distance = near.distance;
            made.nearest[v] = near.point;
        });
    }
    made.extent = made.box.isEmpty() ? 0 : made.box.diagonal().norm();
    made.influence.size = made.extent;
    return made;
}

/// Finds how often each frame moves, and about which joint. Returns the frames that swings move together.
std::vector<MovedGroup> setMotions(const SkinParameters& p, const std::vector<int>& frames,
                                   std::vector<FrameInfluence>& influences) {
    // Normal equations of the fixed point x of a frame's own swings, those that move the fewest frames with
    // it: (R - I)(x - c) = c - (R c + t) for each, c the centre of its bounds.
    struct FixedPoint {
        std::size_t movers = 0; // number of frames that its own swings move
        Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
        Vec3 right = Vec3::Zero();
    };
    std::vector<FixedPoint> fixed(influences.size());
    std::map<std::vector<char>, std::vector<Pose>> groups;
    for (FrameInfluence& frame : influences) frame.moves = p.swings.empty();
    for (const BoneSwing& swing : p.swings) {
        std::map<std::size_t, Pose> moved;
        for (const std::vector<Pose>& station : swing)
            for (std::size_t m = 0; m < station.size(); ++m)
                if (frames[m] >= 0 && station[m].matrix() != Pose::Identity().matrix())
                    moved[static_cast<std::size_t>(frames[m])] = station[m];
        std::vector<char> group(influences.size(), 0);
        for (const auto& [h, pose] : moved) group[h] = 1;
        std::vector<Pose>& ends = groups[group];
        for (const auto& [h, pose] : moved) {
            if (ends.empty() || ends.back().matrix() != pose.matrix()) ends.push_back(pose);
            ++influences[h].moves;
            FixedPoint& own = fixed[h];
            if (own.movers != 0 && own.movers < moved.size()) continue;
            if (own.movers != moved.size()) own = {moved.size()};
            const Eigen::Matrix3d turn = pose.linear() - Eigen::Matrix3d::Identity();
            own.matrix += turn.transpose() * turn;
            own.right -= turn.transpose() * (pose * influences[h].box.center() - influences[h].box.center());
        }
    }
    for (std::size_t h = 0; h < influences.size(); ++h) {
        if (influences[h].box.isEmpty()) continue;
        const Vec3 middle = influences[h].box.center();
        influences[h].joint = middle;
        const double some = 1e-6 * fixed[h].matrix.trace();
        if (!(some > 0)) continue;
        const auto places = (fixed[h].matrix + some * Eigen::Matrix3d::Identity()).eval().ldlt();
        influences[h].joint +=
            places.solve(fixed[h].right); // on an axis of rotation the point nearest to the centre
        const FrameInfluence* parent = parentBone(influences, h);
        const Vec3 from = parent ? Vec3(middle - parent->box.center()) : Vec3::Zero();
        influences[h].twists = some * places.solve(from).norm() > aheadCosine * from.norm();
    }
    std::vector<MovedGroup> made;
    for (auto& [group, ends] : groups) made.push_back({group, std::move(ends)});
    return made;
}

} // namespace

const FrameInfluence* parentBone(const std::vector<FrameInfluence>& influences, std::size_t bone) {
    const Vec3 middle = influences[bone].box.center();
    const FrameInfluence* parent = nullptr;
    for (const FrameInfluence& other : influences) {
        if (other.moves >= influences[bone].moves || other.box.isEmpty()) continue;
        if (!parent || (other.box.center() - middle).norm() < (parent->box.center() - middle).norm())
            parent = &other;
    }
    return parent;
}

std::vector<SkinInfluence> skinInfluences(const SkinAnatomy& anatomy, const SkinParameters& parameters,
                                          const std::vector<int>& frames) {
    std::vector<FrameInfluence> influences;
    const int count = frames.empty() ? 0 : *std::max_element(frames.begin(), frames.end()) + 1;
    for (int f = 0; f < count; ++f) influences.push_back(frameInfluence(anatomy, frames, f));
    std::vector<MovedGroup> groups = setMotions(parameters, frames, influences);
    bool onSkin = false; // some body is in the skin's own frame
    for (std::size_t m = 0; m < frames.size(); ++m)
        onSkin |= frames[m] < 0 && !anatomy.bodies[m]->muscle().surface.empty();
    if (onSkin) {
        influences.push_back(frameInfluence(anatomy, frames, -1));
        influences.back().influence.size = infinity;
    }
    return assignParts(anatomy, std::move(influences), std::move(groups));
}

} // namespace tss
