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

    /// What triangles a vertex may meet: those that face so, within reach of it or of its way.
    struct Asked {
        Vec3 x, facing;
        bool onlyChanged = false;   ///< it has not moved since rest: it meets nothing new but what has
        const Vec3* move = nullptr; ///< null: where it is alone
    };

    /// Calls find(v, askedOf(v)) for those of `count` vertices that may find something, many at a time:
    /// mostly neighbours.
    template <class AskedOf, class Find>
    void eachNear(std::size_t count, const AskedOf& askedOf, const Find& find) {
        constexpr std::size_t most = SkinRig::block;
        parallelFor((count + most - 1) / most, [&](std::size_t g) {
            MovingTriangles::Group group;
            if (atRest_) group.facings.extend(Vec3(0, 0, 0));
            bool onlyChanged = true;
            std::vector<Asked> asked;
            for (std::size_t v = g * most; v < std::min(count, (g + 1) * most); ++v) {
                const Asked& one = asked.emplace_back(askedOf(v));
                group.places.extend(one.x);
                group.facings.extend(one.facing);
                if (one.move) group.moves.extend(*one.move);
                onlyChanged = onlyChanged && one.onlyChanged;
            }
            if (!skin_.mayMeet(group, reach_, onlyChanged)) return;
            for (std::size_t k = 0; k < asked.size(); ++k) find(g * most + k, asked[k]);
        });
    }

    /// Body vertices that come near to the skin above them.
    void findBodyContacts() {
        for (std::size_t m = 0; m < rig_.bodies.size(); ++m) {
            const SkinBody& body = rig_.bodies[m];
            const SkinScene::Placed& now = scene_.bodies[m];
            const bool still = !atRest_ && now.activation == 0 && !now.moved && isAtRest(now.bones);
            const auto askedOf = [&](std::size_t k) {
                const Move &x = scene_.surface[body.first + k], &normal = scene_.normals[body.first + k];
                return Asked{now.toSkin(x.head<3>()).cast<double>(),
                             now.turned(normal.head<3>()).cast<double>(), still};
            };
            eachNear(body.count, askedOf, [&](std::size_t k, const Asked& asked) {
                findBodyContact(body, body.first + k, asked);
            });
        }
    }

    void findBodyContact(const SkinBody& body, std::size_t v, const Asked& asked) {
        const Vec3& x = asked.x;
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
        if (asked.facing.isZero(0)) return;
        const NearestPoint near = skin_.nearest(x, asked.facing, reach_, asked.onlyChanged);
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
        const auto askedOf = [&](std::size_t v) {
            return Asked{skin_.now().vertices[v], -scene_.normalOf(v).cast<double>(),
                         !atRest_ && !skin_.changed(v), &skin_.moveOf(v)};
        };
        eachNear(rig_.places.size(), askedOf, [&](std::size_t v, const Asked& a) { findFold(v, a); });
    }

    void findFold(std::size_t v, const Asked& asked) {
        if (asked.facing.isZero(0)) return;
        const Vec3& x = asked.x;
        const auto near = skin_.nearest(x, asked.facing, reach_, asked.onlyChanged, asked.move);
        if (near.triangle < 0 || (rig_.triangles[near.triangle].array() == static_cast<int>(v)).any()) return;
        // In front of the triangle, and the triangle in front of the vertex: not the back of its own
        // layer.
        if (normalOf(near).dot(x - near.point) < -depth_ - near.half ||
            asked.facing.dot(x - near.point) < -depth_ - near.half)
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
