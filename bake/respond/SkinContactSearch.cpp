#include "bake/respond/SkinContactSearch.h"

#include "bake/base/Parallel.h"
#include "bake/motion/ClosestPointQuery.h"
#include "bake/respond/SkinContact.h"
#include "bake/respond/SkinRows.h"
#include "bake/respond/SkinScene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tss {
namespace {

/// In radii of the skin: how near to the skin a body's vertex, or another part of the skin, has to come. A
/// body's vertices that only pass it between two steps get no row: teeth would drag the skin of a closed
/// mouth along.
constexpr double contactReach = 3;
constexpr std::size_t leastStops = 4; ///< on a swing, however little it moves
/// Number of stations on all ways of several joints together, so that a skin of fifty bones is loaded in
/// seconds: folds are found up to half a step away, however long it is.
constexpr std::size_t mostTogether = 256;

/// Activations and poses at which contacts are sought.
struct Station {
    std::vector<double> activations;
    std::vector<Pose> poses;
    std::size_t stop = 0; ///< on a swing, from 1 on; 0: elsewhere
};

using Corners = std::array<Vec3, 8>;

/// The corners of the bodies' bounds at rest, run-time lengths.
std::vector<Corners> cornersOf(const SkinRig& rig) {
    std::vector<Corners> result(rig.bodies.size());
    for (std::size_t m = 0; m < result.size(); ++m) {
        Eigen::AlignedBox3f box;
        for (const Move& x : rig.bodies[m].rest) box.extend(x.head<3>());
        for (int c = 0; c < 8; ++c)
            result[m][c] =
                box.isEmpty()
                    ? Vec3(Vec3::Zero())
                    : Vec3(box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(c)).cast<double>());
    }
    return result;
}

/// How far a swing moves bodies, at most: the length of its way, run-time lengths.
double wayOf(const SkinRig& rig, const std::vector<Corners>& corners, const BoneSwing& swing) {
    double longest = 0;
    for (std::size_t m = 0; m < corners.size(); ++m) {
        if (rig.bodies[m].rest.empty()) continue;
        Corners before = corners[m];
        std::array<double, 8> ways{};
        for (const std::vector<Pose>& sample : swing) {
            const Pose pose = rig.local(sample[m]);
            for (std::size_t c = 0; c < 8; ++c) {
                const Vec3 now = pose * corners[m][c];
                ways[c] += (now - before[c]).norm();
                before[c] = now;
            }
        }
        longest = std::max(longest, *std::ranges::max_element(ways));
    }
    return longest;
}

/// Adds stations on a swing whose way is so long, `most` of them at most.
void addStations(const SkinRig& rig, const BoneSwing& swing, double way, const Station& rest,
                 std::size_t most, std::vector<Station>& result) {
    const double step = 4 * contactReach * static_cast<double>(rig.radius);
    const std::size_t needed = step > 0 ? static_cast<std::size_t>(std::min(std::ceil(way / step), 1e6)) : 0;
    const std::size_t stops =
        std::min(std::clamp(needed, leastStops, std::max(leastStops, swing.size())), most);
    for (std::size_t s = 1; s <= stops; ++s)
        result.push_back({rest.activations, swing[(s * swing.size() + stops - 1) / stops - 1], s});
}

std::vector<Station> stationsOf(const SkinRig& rig) {
    const std::size_t bodies = rig.bodies.size();
    const Station rest{std::vector<double>(bodies, 0), std::vector<Pose>(bodies, Pose::Identity())};
    std::vector<Station> result{rest};
    for (std::size_t m = 0; m < bodies; ++m)
        for (const double end : {rig.bodies[m].nodes.front(), rig.bodies[m].nodes.back()}) {
            if (end == 0) continue;
            result.push_back(rest);
            result.back().activations[m] = end;
        }
    const std::vector<Corners> corners = cornersOf(rig);
    const auto addAll = [&](const std::vector<BoneSwing>& swings, std::size_t most) {
        for (const BoneSwing& swing : swings)
            addStations(rig, swing, wayOf(rig, corners, swing), rest, most, result);
    };
    const SkinParameters& parameters = rig.parameters;
    addAll(parameters.swings, std::numeric_limits<std::size_t>::max());
    addAll(parameters.together,
           std::max<std::size_t>(1, mostTogether / std::max<std::size_t>(1, parameters.together.size())));
    return result;
}

class Search {
public:
    explicit Search(const SkinRig& rig)
        : rig_(rig), reach_(contactReach * static_cast<double>(rig.radius)),
          depth_(static_cast<double>(enterDepth * rig.radius)) {
        found_.bodies = SkinContacts(rig.bodyVertices);
        if (rig.parameters.selfContact) found_.folds = SkinContacts(rig.places.size());
    }

    SkinContactSearch run() {
        for (const Station& station : stationsOf(rig_)) visit(station);
        return std::move(found_);
    }

private:
    void visit(const Station& station) {
        if (station.stop > 0) before_ = station.stop == 1 ? rest_ : scene_.carried;
        placeBodies(rig_, station.activations, station.poses, {}, scene_);
        skin_ = meshOf(scene_.carried, rig_.triangles);
        atRest_ = rest_.empty();
        if (atRest_) rest_ = scene_.carried;
        if (station.stop == 0) before_ = scene_.carried;
        longestMove_ = 0;
        for (int v = 0; v < static_cast<int>(skin_.vertices.size()); ++v)
            longestMove_ = std::max(longestMove_, moveOf(v).norm());
        std::vector<Eigen::AlignedBox3d> boxes, changed(skin_.triangles.size());
        for (std::size_t t = 0; t < skin_.triangles.size(); ++t) {
            boxes.push_back(bounds(skin_, t));
            const Tri& corners = skin_.triangles[t];
            if (moved(corners[0]) || moved(corners[1]) || moved(corners[2])) changed[t] = boxes[t];
        }
        if (atRest_) {
            tree_ = buildBvh(boxes, 1);
            changed = boxes;
        }
        refit(tree_, changed);
        const ClosestPointQuery toChanged(skin_, tree_);
        refit(tree_, boxes);
        const ClosestPointQuery toAll(skin_, tree_);
        findBodyContacts(toAll, toChanged);
        if (rig_.parameters.selfContact) findFolds(toAll, toChanged);
    }

    bool moved(int v) const { return scene_.carried[v] != rest_[v]; }

    /// How far a vertex of the skin has come since the last station.
    Vec3 moveOf(int v) const { return (scene_.carried[v] - before_[v]).head<3>().cast<double>(); }

    /// Half of how far a vertex that has come by `move` and the point of the skin near it have come against
    /// one another since the last station: by so much they may have been nearer between the two.
    double halfStep(const Vec3& move, const NearestPoint& near) const {
        Vec3 relative = move;
        for (int k = 0; k < 3; ++k) relative -= near.weights[k] * moveOf(rig_.triangles[near.triangle][k]);
        return relative.norm() / 2;
    }

    Vec3 normalOf(const NearestPoint& near) const {
        return skin_.areaNormal(static_cast<std::size_t>(near.triangle)).normalized();
    }

    /// Body vertices that come near to the skin above them. What has not moved since rest meets nothing new
    /// but skin that has.
    void findBodyContacts(const ClosestPointQuery& toAll, const ClosestPointQuery& toChanged) {
        const Eigen::AlignedBox3d box = bounds(skin_);
        for (std::size_t m = 0; m < rig_.bodies.size(); ++m) {
            const SkinBody& body = rig_.bodies[m];
            const SkinScene::Placed& now = scene_.bodies[m];
            const bool still = now.activation == 0 && !now.moved && isIdentity(now.far);
            parallelFor(body.count, [&](std::size_t k) {
                findBodyContact(still ? toChanged : toAll, box, m,
                                body.first + static_cast<std::uint32_t>(k));
            });
        }
    }

    void findBodyContact(const ClosestPointQuery& locator, const Eigen::AlignedBox3d& box, std::size_t m,
                         std::uint32_t v) {
        SkinContacts& found = found_.bodies;
        if (found.outside[v] || found.stickingOut[v]) return;
        const SkinScene::Placed& now = scene_.bodies[m];
        const Vec3 x = now.toSkin(scene_.surface[v].head<3>()).cast<double>();
        if (box.squaredExteriorDistance(x) > reach_ * reach_) return;
        if (atRest_ && !rig_.bodies[m].bone()) {
            const NearestPoint any = locator.nearest(x, reach_);
            if (any.triangle >= 0 && normalOf(any).dot(x - any.point) > 0) {
                found.outside[v] = 1;
                found.add(v, any.triangle);
                return;
            }
        }
        const Vec3 own = (now.turn * scene_.normals[v].head<3>()).cast<double>();
        const NearestPoint near = locator.nearestFacing(x, reach_, own);
        if (near.triangle < 0) return;
        if (normalOf(near).dot(near.point - x) >= -depth_)
            found.add(v, near.triangle);
        else if (atRest_)
            found.stickingOut[v] = 1;
    }

    /// Skin vertices that come near to another part of the skin.
    void findFolds(const ClosestPointQuery& toAll, const ClosestPointQuery& toChanged) {
        parallelFor(skin_.vertices.size(), [&](std::size_t v) {
            const Vec3 own = scene_.normalOf(v).cast<double>(), move = moveOf(static_cast<int>(v));
            const Vec3& x = skin_.vertices[v];
            const double range = reach_ + (move.norm() + longestMove_) / 2;
            const ClosestPointQuery& locator = moved(static_cast<int>(v)) ? toAll : toChanged;
            const NearestPoint near = locator.nearestFacing(x, range, -own);
            if (near.triangle < 0 || (skin_.triangles[near.triangle].array() == static_cast<int>(v)).any())
                return;
            const double half = halfStep(move, near);
            if (near.distance > reach_ + half) return;
            // In front of the triangle, and the triangle in front of the vertex: not the back of its own
            // layer.
            if (normalOf(near).dot(x - near.point) < -depth_ - half ||
                own.dot(near.point - x) < -depth_ - half)
                return;
            found_.folds.add(v, near.triangle);
        });
    }

    const SkinRig& rig_;
    const double reach_, depth_; ///< run-time lengths
    SkinContactSearch found_;
    SkinScene scene_;
    std::vector<Move> rest_, before_; ///< SkinScene::carried at rest and at the last station of the swing
    TriangleMesh skin_;
    bool atRest_ = true;
    double longestMove_ = 0; ///< of a vertex of the skin since the last station
    Bvh tree_;               ///< over the triangles of the skin
};

} // namespace

void SkinContacts::add(std::size_t vertex, int triangle) {
    std::vector<int>& list = triangles[vertex];
    if (std::find(list.begin(), list.end(), triangle) == list.end()) list.push_back(triangle);
}

SkinContactSearch searchContacts(const SkinRig& rig) {
    return Search(rig).run();
}

} // namespace tss
