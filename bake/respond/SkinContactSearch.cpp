#include "bake/base/Parallel.h"
#include "bake/respond/MovingTriangles.h"
#include "bake/respond/SkinContact.h"
#include "bake/respond/SkinRows.h"

#include <algorithm>
#include <cmath>

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

/// How far a swing moves the corners of the bodies' bounds, at most: the length of its way, run-time lengths.
double wayOf(const SkinRig& rig, const BoneSwing& swing) {
    double longest = 0;
    for (std::size_t m = 0; m < rig.bodies.size(); ++m) {
        Eigen::AlignedBox3f box;
        for (const Move& x : rig.bodies[m].rest) box.extend(x.head<3>());
        for (int c = 0; c < 8 && !box.isEmpty(); ++c) {
            const Vec3 corner = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(c)).cast<double>();
            Vec3 before = corner;
            double way = 0;
            for (const std::vector<Pose>& sample : swing) {
                const Vec3 now = rig.local(sample[m]) * corner;
                way += (now - before).norm();
                before = now;
            }
            longest = std::max(longest, way);
        }
    }
    return longest;
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
    const auto addAll = [&](const std::vector<BoneSwing>& swings, std::size_t most) {
        const double step = 4 * contactReach * static_cast<double>(rig.radius);
        for (const BoneSwing& swing : swings) {
            const double steps = step > 0 ? std::min(std::ceil(wayOf(rig, swing) / step), 1e6) : 0;
            const std::size_t stops = std::min(
                std::clamp(static_cast<std::size_t>(steps), leastStops, std::max(leastStops, swing.size())),
                most);
            for (std::size_t s = 1; s <= stops; ++s)
                result.push_back({rest.activations, swing[(s * swing.size() + stops - 1) / stops - 1], s});
        }
    };
    const std::vector<BoneSwing>& together = rig.parameters.together;
    addAll(rig.parameters.swings, std::numeric_limits<std::size_t>::max());
    addAll(together, std::max<std::size_t>(1, mostTogether / std::max<std::size_t>(1, together.size())));
    return result;
}

void addOnce(int triangle, std::vector<int>& list) {
    if (std::ranges::find(list, triangle) == list.end()) list.push_back(triangle);
}

class Search {
public:
    explicit Search(const SkinRig& rig)
        : rig_(rig), reach_(contactReach * static_cast<double>(rig.radius)),
          depth_(static_cast<double>(enterDepth * rig.radius)), rest_{placesOf(rig.places), rig.triangles},
          wayAtRest_(rest_), skin_(rest_), stickingOut_(rig.bodyVertices, 0) {
        found_.bodies.resize(rig.bodyVertices);
        found_.outside.resize(rig.bodyVertices, 0);
        if (rig.parameters.selfContact) found_.folds.resize(rig.places.size());
    }

    SkinContactSearch run() {
        for (const Station& station : stationsOf(rig_)) visit(station);
        return std::move(found_);
    }

private:
    void visit(const Station& station) {
        placeBodies(rig_, station.activations, station.poses, {}, scene_);
        const std::vector<Vec3> places = placesOf(scene_.carried);
        skin_.moveTo(places, station.stop == 0   ? places
                             : station.stop == 1 ? skin_.rest()
                                                 : std::vector<Vec3>(skin_.now().vertices));
        findBodyContacts();
        if (rig_.parameters.selfContact) findFolds();
        atRest_ = false;
    }

    Vec3 normalOf(const NearestPoint& near) const {
        return skin_.now().areaNormal(static_cast<std::size_t>(near.triangle)).normalized();
    }

    /// What is asked about at a time, of one body or of the skin: mostly neighbours.
    static constexpr std::size_t groupSize = SkinRig::block;
    template <class Each>
    static void eachGroup(std::size_t count, const Each& each) {
        parallelFor((count + groupSize - 1) / groupSize, [&](std::size_t group) {
            each(group * groupSize, std::min(count, (group + 1) * groupSize));
        });
    }

    /// Body vertices that come near to the skin above them. What has not moved since rest meets nothing new
    /// but skin that has.
    void findBodyContacts() {
        for (std::size_t m = 0; m < rig_.bodies.size(); ++m) {
            const SkinBody& body = rig_.bodies[m];
            const SkinScene::Placed& now = scene_.bodies[m];
            const bool still = !atRest_ && now.activation == 0 && !now.moved && isAtRest(now.bones);
            eachGroup(body.count, [&](std::size_t first, std::size_t last) {
                MovingTriangles::Group group;
                if (atRest_) group.facings.extend(Vec3(0, 0, 0));
                for (std::size_t v = body.first + first; v < body.first + last; ++v) {
                    group.places.extend(placeOf(now, v));
                    group.facings.extend(facingOf(now, v));
                }
                if (!skin_.mayMeet(group, reach_, still)) return;
                for (std::size_t v = body.first + first; v < body.first + last; ++v)
                    findBodyContact(body, still, v, placeOf(now, v), facingOf(now, v));
            });
        }
    }

    Vec3 placeOf(const SkinScene::Placed& body, std::size_t v) const {
        return body.toSkin(scene_.surface[v].head<3>()).cast<double>();
    }
    Vec3 facingOf(const SkinScene::Placed& body, std::size_t v) const {
        return (body.turn * scene_.normals[v].head<3>()).cast<double>();
    }

    void findBodyContact(const SkinBody& body, bool still, std::size_t v, const Vec3& x, const Vec3& own) {
        std::vector<int>& found = found_.bodies[v];
        if (found_.outside[v] || stickingOut_[v]) return;
        if (atRest_ && !body.bone()) {
            const NearestPoint any = skin_.nearest(x, Vec3::Zero(), reach_, false);
            if (any.triangle >= 0 && normalOf(any).dot(x - any.point) > 0) {
                found_.outside[v] = 1;
                found.push_back(any.triangle);
                return;
            }
        }
        if (own.isZero(0)) return;
        const NearestPoint near = skin_.nearest(x, own, reach_, still);
        if (near.triangle < 0) return;
        if (normalOf(near).dot(near.point - x) < -depth_) {
            if (atRest_) stickingOut_[v] = 1;
        } else if (under(body.rest[v - body.first].head<3>().cast<double>(), near.triangle)) {
            addOnce(near.triangle, found);
        }
    }

    /// At rest the straight way from a body's vertex to a triangle does not leave the skin: what it covers is
    /// no other limb, whose skin is met from outside.
    bool under(const Vec3& vertex, int triangle) const {
        Vec3 middle = Vec3::Zero();
        for (const int corner : rig_.triangles[triangle]) middle += skin_.rest()[corner] / 3;
        constexpr double before = 1e-3; // of the way, where it ends
        return wayAtRest_.entered(middle + before * (vertex - middle), vertex) < 0;
    }

    /// Skin vertices that come near to another part of the skin.
    void findFolds() {
        eachGroup(rig_.places.size(), [&](std::size_t first, std::size_t last) {
            MovingTriangles::Group group;
            bool still = !atRest_;
            for (std::size_t v = first; v < last; ++v) {
                group.places.extend(skin_.now().vertices[v]);
                group.facings.extend(Vec3(-scene_.normalOf(v).cast<double>()));
                group.moves.extend(skin_.moveOf(v));
                still = still && !skin_.changed(v);
            }
            if (!skin_.mayMeet(group, reach_, still)) return;
            for (std::size_t v = first; v < last; ++v) findFold(v);
        });
    }

    void findFold(std::size_t v) {
        const Vec3 own = scene_.normalOf(v).cast<double>();
        const Vec3& x = skin_.now().vertices[v];
        if (own.isZero(0)) return;
        const bool still = !atRest_ && !skin_.changed(v);
        const auto near = skin_.nearest(x, -own, reach_, still, &skin_.moveOf(v));
        if (near.triangle < 0 || (rig_.triangles[near.triangle].array() == static_cast<int>(v)).any()) return;
        // In front of the triangle, and the triangle in front of the vertex: not the back of its own
        // layer.
        if (normalOf(near).dot(x - near.point) < -depth_ - near.half ||
            own.dot(near.point - x) < -depth_ - near.half)
            return;
        addOnce(near.triangle, found_.folds[v]);
    }

    const SkinRig& rig_;
    const double reach_, depth_; ///< run-time lengths
    SkinContactSearch found_;
    SkinScene scene_;
    const TriangleMesh rest_;
    const ClosestPointQuery wayAtRest_;
    MovingTriangles skin_;          ///< as bodies carry it
    std::vector<char> stickingOut_; ///< per vertex of all bodies: a bone's, such as a tooth's, that is above
                                    ///< the skin at rest
    bool atRest_ = true;
};

} // namespace

SkinContactSearch searchContacts(const SkinRig& rig) {
    return Search(rig).run();
}

} // namespace tss
