#include "bake/respond/SkinRows.h"

#include "bake/base/Parallel.h"
#include "bake/respond/SkinContact.h"

#include <algorithm>
#include <set>

namespace tss {
namespace {

using Vec3f = Eigen::Vector3f;

/// In radii of the skin: how far from the skin a body's vertex, or another part of the skin, is seen.
constexpr double seenReach = 3;
constexpr std::size_t swingStops = 4; ///< of each swing, at which meetings are looked for

/// Activations and poses at which meetings are looked for.
struct Station {
    std::vector<double> activations;
    std::vector<Pose> poses;
};

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
    for (const BoneSwing& swing : rig.parameters.swings)
        for (std::size_t s = swingStops; s > 0; --s) {
            result.push_back(rest);
            result.back().poses = swing[(s * swing.size() + swingStops - 1) / swingStops - 1];
        }
    return result;
}

TriangleMesh skinAt(const SkinRig& rig, const SkinScene& scene) {
    TriangleMesh mesh{{}, rig.triangles};
    for (const Move& x : scene.carried) mesh.vertices.push_back(x.head<3>().cast<double>());
    return mesh;
}

Vec3 triangleNormal(const TriangleMesh& mesh, int t) {
    const Vec3& a = mesh.corner(t, 0);
    return (mesh.corner(t, 1) - a).cross(mesh.corner(t, 2) - a).normalized();
}

/// Triangles of the skin that something was before, by what it is; through: and was behind it at rest.
struct Met {
    std::vector<std::vector<int>> triangles;
    std::vector<char> through;

    explicit Met(std::size_t count) : triangles(count), through(count, 0) {}
};

void meet(Met& met, std::size_t what, int triangle) {
    auto& list = met.triangles[what];
    if (std::find(list.begin(), list.end(), triangle) == list.end()) list.push_back(triangle);
}

/// Body vertices that the skin comes to lie on.
void meetBodies(const SkinRig& rig, const SkinScene& scene, const TriangleMesh& skin,
                const ClosestPointQuery& locator, bool atRest, Met& met) {
    const double reach = seenReach * static_cast<double>(rig.radius);
    Eigen::AlignedBox3d box = bounds(skin);
    for (std::size_t m = 0; m < rig.bodies.size(); ++m) {
        const SkinBody& body = rig.bodies[m];
        const SkinScene::Placed& placed = scene.bodies[m];
        parallelFor(body.count, [&](std::size_t k) {
            const std::uint32_t v = body.first + static_cast<std::uint32_t>(k);
            const Vec3 x = placed.toSkin(scene.surface[v].head<3>()).cast<double>();
            if (box.squaredExteriorDistance(x) > reach * reach) return;
            const Vec3 own = (placed.turn * scene.normals[v].head<3>()).cast<double>();
            if (met.through[v]) return;
            if (atRest && !body.bone()) { // bones stick out where they should: teeth do
                const NearestPoint any = locator.nearest(x, reach);
                if (any.triangle >= 0 && triangleNormal(skin, any.triangle).dot(x - any.point) > 0) {
                    met.through[v] = 1;
                    meet(met, v, any.triangle);
                    return;
                }
            }
            const NearestPoint near = locator.nearestFacing(x, reach, own);
            if (near.triangle < 0) return;
            const double above = triangleNormal(skin, near.triangle).dot(near.point - x);
            if (above >= -static_cast<double>(enterDepth * rig.radius)) meet(met, v, near.triangle);
        });
    }
}

/// Skin vertices that come before another part of the skin.
void meetFolds(const SkinRig& rig, const SkinScene& scene, const TriangleMesh& skin,
               const ClosestPointQuery& locator, Met& met) {
    const double reach = seenReach * static_cast<double>(rig.radius),
                 depth = static_cast<double>(enterDepth * rig.radius);
    parallelFor(skin.vertices.size(), [&](std::size_t v) {
        const Vec3 own = scene.normalOf(v).cast<double>();
        const Vec3& x = skin.vertices[v];
        const NearestPoint near = locator.nearestFacing(x, reach, -own);
        if (near.triangle < 0 || (skin.triangles[near.triangle].array() == static_cast<int>(v)).any()) return;
        // Before it, and not through the layer that the vertex is a part of.
        if (triangleNormal(skin, near.triangle).dot(x - near.point) < -depth ||
            own.dot(near.point - x) < -depth)
            return;
        meet(met, v, near.triangle);
    });
}

void addMet(SkinRig& rig, const Met& met, SkinMeeting meeting, std::vector<bool>& pushed) {
    std::size_t body = 0;
    for (std::uint32_t v = 0; v < met.triangles.size(); ++v) {
        const std::vector<int>& triangles = met.triangles[v];
        if (meeting == SkinMeeting::BodyOnSkin)
            while (v >= rig.bodies[body].first + rig.bodies[body].count) ++body;
        if (triangles.empty()) continue;
        SkinRow row;
        row.meeting = meeting;
        row.vertex = v;
        row.body = static_cast<std::uint32_t>(body);
        row.first = static_cast<std::uint32_t>(rig.starts.size());
        rig.starts.insert(rig.starts.end(), triangles.begin(), triangles.end());
        row.last = static_cast<std::uint32_t>(rig.starts.size());
        row.within = met.through[v] != 0;
        row.corners = rig.triangles[triangles.front()];
        row.weights.setConstant(1 / 3.0f);
        rig.rows.push_back(row);
        for (const int t : triangles)
            for (const int corner : rig.triangles[t]) pushed[corner] = true;
        if (meeting == SkinMeeting::SkinOnSkin) pushed[v] = true;
    }
}

/// How far outside a bone a place is, by the nearest of its surface: what faces the skin may be its other
/// side. Negative inside.
float outside(const SkinBody& body, const Move& place) {
    const Vec3 x = place.head<3>().cast<double>();
    const NearestPoint near = body.locator->nearest(x, std::numeric_limits<double>::infinity());
    if (near.triangle < 0) return 0;
    Vec3 normal = triangleNormal(*body.mesh, near.triangle);
    if (!(near.weights.minCoeff() > 0)) {
        normal.setZero();
        for (int k = 0; k < 3; ++k)
            normal +=
                near.weights[k] * body.normals[body.triangles[near.triangle][k]].head<3>().cast<double>();
    }
    const auto distance = static_cast<float>(near.distance);
    return normal.dot(x - near.point) >= 0 ? distance : -distance;
}

bool ofMuscle(const SkinRig& rig, const SkinRow& row) {
    return row.meeting != SkinMeeting::SkinOnSkin && !rig.bodies[row.body].bone();
}

/// What a row of a muscle keeps of how a scene stands.
SkinApart apartOf(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    SkinApart apart;
    apart.lie.head<3>() = relativeOf(rig, scene, row);
    const SkinPlane plane = lookUp(rig, scene, row);
    apart.gap() = apart.relative().norm();
    if (plane.found)
        apart.gap() = std::clamp(plane.distance, 0.0f, apart.gap());
    else if (row.meeting == SkinMeeting::BodyOnSkin)
        apart.gap() = distanceToKnown(rig, scene, row);
    return apart;
}

/// Each node's gap becomes what holds up to the next one.
void bridgeNodes(SkinApart* apart, std::size_t nodes) {
    for (std::size_t n = 0; n + 1 < nodes; ++n) {
        const float step = (apart[n + 1].relative() - apart[n].relative()).norm();
        apart[n].gap() = std::max(std::min(apart[n].gap(), apart[n + 1].gap()) - step / 2, 0.0f);
    }
}

/// The overlap at rest, which way the surface faces there, and how far a row that is no muscle's is free.
void measureAtRest(SkinRig& rig, const SkinScene& scene, SkinRow& row) {
    const bool body = row.meeting == SkinMeeting::SkinOnBody, bone = rig.bodies[row.body].bone();
    if (body && !bone) {
        for (int k = 0; k < 3; ++k)
            row.facing +=
                row.weights[k] * scene.normals[rig.bodies[row.body].first + row.corners[k]].head<3>();
        if (row.facing.squaredNorm() > 0) row.facing.normalize();
    }
    SkinApart& apart = rig.apart[row.apart];
    apart.lie.head<3>() = relativeOf(rig, scene, row);
    row.offset = -1; // whatever the overlap at rest is, it is believed
    SkinPlane plane = lookUp(rig, scene, row, 0);
    row.offset = 0;
    if (body && row.within && plane.found && plane.distance > 0) {
        row.turned = true;
        plane = lookUp(rig, scene, row, 0);
    }
    if (body && bone) {
        // Nothing comes in before it has come as far as the bone is away.
        apart.gap() = std::max(outside(rig.bodies[row.body], scene.skin[row.vertex]), 0.0f);
        if (plane.found && apart.gap() == 0) row.offset = std::min(plane.distance, 0.0f);
    } else if (plane.found) {
        row.offset = std::min(plane.distance, 0.0f);
        apart.gap() = std::clamp(plane.distance, 0.0f, apart.relative().norm());
    } else if (!body) { // it faces another way now, and is far from what it meets
        apart.gap() = distanceToKnown(rig, scene, row);
    }
}

} // namespace

std::vector<SkinBefore> skinBefore(const SkinGround& ground, const SkinTable& table) {
    const Table& t = table.table;
    std::vector<SkinBefore> result;
    std::vector<bool> meets(ground.bodies.size());
    std::set<std::pair<std::uint32_t, std::uint32_t>> known;
    for (std::size_t i = 0; i < t.a.size(); ++i) {
        const std::uint32_t v = ground.first[table.skinVertices[i]];
        std::fill(meets.begin(), meets.end(), false);
        for (std::uint32_t k = t.rowOffsets[i]; k < t.rowOffsets[i + 1]; ++k)
            meets[table.muscleOf[t.columns[k]]] = true;
        for (std::uint32_t m = 0; m < meets.size(); ++m)
            if (meets[m] && known.emplace(v, m).second) result.push_back({v, m, false, {}});
    }
    parallelFor(result.size(), [&](std::size_t k) {
        SkinBefore& before = result[k];
        const Vec3 &x = ground.skin.vertices[before.vertex], &own = ground.normals[before.vertex];
        const ClosestPointQuery& locator = ground.locators[before.body];
        before.inside = !ground.inside[before.body].empty() && ground.inside[before.body][before.vertex];
        const MuscleDeformer& body = *ground.bodies[before.body];
        before.near =
            body.rigid() ? locator.nearestFacing(x, ground.size, own) : locator.nearest(x, ground.size);
        if (before.near.triangle < 0 || body.rigid()) return;
        Vec3 smooth = Vec3::Zero();
        for (int c = 0; c < 3; ++c)
            smooth +=
                before.near.weights[c] *
                ground.surfaceNormals[before.body][body.muscle().surface.triangles[before.near.triangle][c]];
        // Outside of the muscle's other side the skin is no cover of it.
        if (smooth.dot(own) <= 0 && !before.inside) before.near.triangle = -1;
    });
    std::erase_if(result, [](const SkinBefore& before) { return before.near.triangle < 0; });
    return result;
}

std::vector<bool> addRows(SkinRig& rig, const std::vector<SkinBefore>& before,
                          const std::vector<std::uint32_t>& indexOf) {
    std::vector<bool> pushed(rig.places.size(), false);
    for (const SkinBefore& b : before) {
        SkinRow row;
        row.vertex = indexOf[b.vertex];
        row.body = b.body;
        row.within = b.inside;
        row.first = static_cast<std::uint32_t>(rig.starts.size());
        rig.starts.push_back(b.near.triangle);
        row.last = row.first + 1;
        row.corners = rig.bodies[b.body].triangles[b.near.triangle];
        row.weights = b.near.weights.cast<float>();
        rig.rows.push_back(row);
        pushed[row.vertex] = true;
    }
    std::sort(rig.rows.begin(), rig.rows.end(), [](const SkinRow& a, const SkinRow& b) {
        return std::pair(a.vertex, a.body) < std::pair(b.vertex, b.body);
    });
    Met bodies(rig.bodyVertices), folds(rig.parameters.selfContact ? rig.places.size() : 0);
    SkinScene scene;
    bool atRest = true;
    for (const Station& station : stationsOf(rig)) {
        placeBodies(rig, station.activations, station.poses, {}, scene);
        const TriangleMesh skin = skinAt(rig, scene);
        const ClosestPointQuery locator(skin);
        meetBodies(rig, scene, skin, locator, atRest, bodies);
        atRest = false;
        if (rig.parameters.selfContact) meetFolds(rig, scene, skin, locator, folds);
    }
    addMet(rig, bodies, SkinMeeting::BodyOnSkin, pushed);
    addMet(rig, folds, SkinMeeting::SkinOnSkin, pushed);
    return pushed;
}

void measureRows(SkinRig& rig) {
    for (SkinRow& row : rig.rows) {
        row.apart = static_cast<std::uint32_t>(rig.apart.size());
        rig.apart.resize(rig.apart.size() + (ofMuscle(rig, row) ? rig.bodies[row.body].nodes.size() : 1));
    }
    SkinScene scene;
    std::vector<double> activations(rig.bodies.size(), 0);
    const std::vector<Pose> poses(rig.bodies.size(), Pose::Identity());
    placeBodies(rig, activations, poses, {}, scene);
    parallelFor(rig.rows.size(), [&](std::size_t r) { measureAtRest(rig, scene, rig.rows[r]); });
    std::vector<std::vector<std::uint32_t>> rowsOf(rig.bodies.size());
    for (std::uint32_t r = 0; r < rig.rows.size(); ++r)
        if (ofMuscle(rig, rig.rows[r])) rowsOf[rig.rows[r].body].push_back(r);
    for (std::size_t m = 0; m < rig.bodies.size(); ++m) {
        const std::vector<double>& nodes = rig.bodies[m].nodes;
        for (std::size_t n = 0; n < nodes.size() && !rowsOf[m].empty(); ++n) {
            activations[m] = nodes[n];
            placeBodies(rig, activations, poses, {}, scene);
            for (const std::uint32_t r : rowsOf[m])
                rig.apart[rig.rows[r].apart + n] = apartOf(rig, scene, rig.rows[r]);
        }
        activations[m] = 0;
        for (const std::uint32_t r : rowsOf[m])
            bridgeNodes(rig.apart.data() + rig.rows[r].apart, nodes.size());
    }
}

} // namespace tss
