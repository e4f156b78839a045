#include "bake/respond/SkinContact.h"

#include "bake/respond/SkinClearance.h"
#include "bake/respond/SkinWalk.h"

#include <algorithm>
#include <cmath>

namespace tss {

using Vec3f = Eigen::Vector3f;

Vec3f constrainedPoint(const SkinScene& scene, const SkinPlane& plane) {
    Vec3f sum = Vec3f::Zero();
    for (int k = 0; k < plane.vertices; ++k) sum += plane.weight[k] * scene.skin[plane.vertex[k]].head<3>();
    return sum;
}

namespace {

/// Cosine of the angle between both surfaces' normals, brought to the same side (but of skin before a bone,
/// for which only surfaces that face it are sought): below leastFacing a contact
/// does not count, from fullFacing on fully. Beyond 84 degrees the surface found may be the far side of the
/// body.
constexpr float leastFacing = 0.1f, fullFacing = 0.5f;
/// Most triangles that a walk over a surface visits: enough to slide over a tenth of a fine one.
constexpr int walkSteps = 40;
/// A part of the skin behind a vertex at rest is an obstacle up to a depth of this share of their distance
/// then, and none from twice that on.
constexpr float ownLayer = 0.25f;

float smoothStep(float t) {
    t = std::clamp(t, 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

float trustOf(float facing) {
    return smoothStep((facing - leastFacing) / (fullFacing - leastFacing));
}

/// The direction in which a surface pushes: its smooth normal, blended continuously into the direction of its
/// nearest point beside a rim or inside a thin edge. away: from that point. side: 1 outside, -1 inside, 0:
/// smooth normal only.
Vec3f pushDirection(const Vec3f& smooth, const Vec3f& away, float side, float radius) {
    const Vec3f blend = radius * smooth + side * away;
    const float length = blend.norm();
    return length > 0 ? Vec3f(blend / length) : smooth;
}

Vec3f smoothNormal(const SurfacePoint& at, const Tri& corners, const auto& normal) {
    Vec3f sum = Vec3f::Zero();
    for (int k = 0; k < 3; ++k) sum += at.weights[k] * normal(corners[k]);
    const float length = sum.norm();
    return length > 0 ? Vec3f(sum / length) : sum;
}

/// The side of a surface that a point is on, given the offset `away` from its nearest point: by the
/// triangle's own normal where that point is inside the triangle, since smooth normals are wrong near sharp
/// edges, and by the smooth normal on edges and corners. -1 or 1.
float sideOf(const SurfacePoint& at, const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& smooth,
             const Vec3f& away) {
    const Vec3f normal = at.weights.minCoeff() > 0 ? Vec3f((b - a).cross(c - a)) : smooth;
    return normal.dot(away) < 0 ? -1.0f : 1.0f;
}

/// Fills normal, distance, gap and level of a plane whose vertices and weights are set. away: offset from the
/// surface's nearest point; trust: in [0, 1], how much the contact counts.
void fillPlane(const SkinRig& rig, const SkinScene& scene, const Vec3f& smooth, const Vec3f& away, float side,
               float trust, float offset, SkinPlane& plane) {
    plane.normal = pushDirection(smooth, away, side, rig.radius);
    const float distance = plane.normal.dot(away);
    const float beside = (away - distance * plane.normal).norm() / rig.radius;
    trust *= 1 - smoothStep(beside - 1);
    plane.distance = distance;
    plane.gap = distance - offset;
    // With less trust the constraint is weaker, so that contacts appear and vanish continuously.
    plane.gap += (1 - trust) * (std::max(-plane.gap, 0.0f) + rig.radius);
    plane.place = constrainedPoint(scene, plane);
    plane.level = plane.normal.dot(plane.place) - plane.gap;
    plane.found = trust > 0;
}

SurfacePoint toPoint(const NearestPoint& near) {
    return {near.triangle, near.weights.cast<float>(), near.point.cast<float>(),
            static_cast<float>(near.distance * near.distance)};
}

/// Trust in a contact of this depth, given the greatest depth that the motion since rest and the overlap at
/// rest explain: what is deeper was not entered through this side of the surface. 1 up to `most`, 0 at twice
/// that.
float entryTrust(float depth, float most) {
    return most > 0 ? 1 - smoothStep((depth - most) / most) : 0;
}

/// How the offset between the two sides of a row has changed since rest.
Vec3f motionSinceRest(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    return anchorOffset(rig, scene, row) - rig.clearances[clearancesAtRest(rig, row)].offsetAndGap.head<3>();
}

/// How far a point inside of a muscle can be from a point of its surface that is the nearest: the radius of
/// the ball inside that touches there.
float roomAt(const SkinBody& body, const SurfacePoint& at) {
    float room = 0;
    for (int k = 0; k < 3; ++k) room += at.weights[k] * body.room[body.triangles[at.triangle][k]];
    return room;
}

/// The nearest point of those triangles of a bone that face either way.
SurfacePoint nearestOf(const SkinBody& bone, const Vec3f& x, float range, const Vec3f& one,
                       const Vec3f& other, int first) {
    const Vec3 place = x.cast<double>();
    const NearestPoint best =
        bone.locator->nearestFacing(place, static_cast<double>(range), one.cast<double>(), first);
    const NearestPoint second = bone.locator->nearestFacing(
        place, best.triangle < 0 ? static_cast<double>(range) : best.distance, other.cast<double>());
    return toPoint(second.triangle < 0 ? best : second);
}

SkinPlane skinOnBody(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset) {
    SkinPlane plane;
    plane.vertices = 1;
    plane.vertex[0] = row.vertex;
    plane.weight[0] = 1;
    const SkinBody& body = rig.bodies[row.body];
    const SkinScene::Placed& placed = scene.bodies[row.body];
    const Vec3f x = placed.toBody(scene.skin[row.vertex].head<3>());
    Vec3f own = scene.normalOf(row.vertex);
    if (placed.moved) own = placed.turn.transpose() * own;
    if (row.fromOutside) own = -own;
    SurfacePoint hit;
    const Vec3f motion = motionSinceRest(rig, scene, row);
    if (body.bone()) {
        int first = rig.starts[row.first];
        if (!row.insideAtRest) first = body.locator->entered((x - motion).cast<double>(), x.cast<double>());
        if (first < 0) return plane;
        const float range = 2 * (motion.norm() - row.offset); // beyond this depth entryTrust() is 0
        hit = nearestOf(body, x, range, own, row.facing, first);
    } else {
        const Move* surface = scene.surface.data() + body.first;
        const auto at = [&](int v) -> Vec3f { return surface[v].head<3>(); };
        hit = walkDownhill(x, rig.starts[row.first], body.triangles, body.across, at, walkSteps);
    }
    if (hit.triangle < 0) return plane;
    const Move* normals = scene.normals.data() + body.first;
    Vec3f smooth =
        smoothNormal(hit, body.triangles[hit.triangle], [&](int v) { return normals[v].head<3>(); });
    // nearestOf() has sought what faces the skin; of a muscle the side faced at rest counts too.
    float trust = body.bone() ? 1.0f : trustOf(std::max(smooth.dot(own), smooth.dot(row.facing)));
    const Vec3f away = x - hit.point;
    const Tri& t = body.triangles[hit.triangle];
    const Move* at = scene.surface.data() + body.first;
    // Inside a bone skin is pushed along the smooth normal only, not sideways out of a thin edge.
    float side = smooth.dot(away) < 0 ? 0.0f : 1.0f;
    if (!body.bone())
        side = sideOf(hit, at[t[0]].head<3>(), at[t[1]].head<3>(), at[t[2]].head<3>(), smooth, away);
    if (side < 1 || smooth.dot(away) < 0) {
        float most = motion.norm() - row.offset;
        if (!body.bone()) most = std::min(most, std::max(roomAt(body, hit), -row.offset));
        trust *= entryTrust(away.norm(), most);
    }
    if (!(trust > 0)) return plane;
    if (row.flipped) {
        smooth = -smooth;
        side = -side;
    }
    fillPlane(rig, scene, placed.moved ? placed.turn * smooth : smooth,
              placed.moved ? placed.turn * away : away, side, trust, offset, plane);
    return plane;
}

/// The start triangle of a row whose first corner is nearest to a point.
int nearestStart(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, const Vec3f& x) {
    int nearest = -1;
    float least = std::numeric_limits<float>::max(); // squared distance
    for (std::uint32_t k = row.first; k < row.last; ++k) {
        const float squared = (x - scene.skin[rig.triangles[rig.starts[k]][0]].head<3>()).squaredNorm();
        if (squared < least) {
            least = squared;
            nearest = rig.starts[k];
        }
    }
    return nearest;
}

SurfacePoint walkSkin(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, const Vec3f& x) {
    const auto at = [&](int v) -> Vec3f { return scene.skin[v].head<3>(); };
    return walkDownhill(x, nearestStart(rig, scene, row, x), rig.triangles, rig.across, at, walkSteps);
}

Vec3f placeAtRest(const SkinRig& rig, const SurfacePoint& hit) {
    Vec3f place = Vec3f::Zero();
    for (int k = 0; k < 3; ++k)
        place += hit.weights[k] * rig.places[rig.triangles[hit.triangle][k]].head<3>();
    return place;
}

/// Signed height of the skin at rest above a vertex, at the point of the skin that the vertex touches now;
/// fades to 0 where that point lay to the side. place, normal: of the vertex at rest.
float heightAtRest(const SkinRig& rig, const Vec3f& place, const Vec3f& normal, const SurfacePoint& hit) {
    const Tri& corners = rig.triangles[hit.triangle];
    const Vec3f away = placeAtRest(rig, hit) - place;
    const Vec3f smooth = smoothNormal(hit, corners, [&](int c) { return rig.placeNormals[c].head<3>(); });
    const float above = (smooth + normal).normalized().dot(away);
    return above == 0 ? 0 : above * smoothStep(2 * std::abs(above) / away.norm() - 0.5f);
}

SkinPlane bodyOnSkin(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset) {
    SkinPlane plane;
    const SkinScene::Placed& placed = scene.bodies[row.body];
    const Vec3f x = vertexPlace(scene, row);
    Vec3f own = scene.normals[row.vertex].head<3>();
    if (placed.moved) own = placed.turn * own;
    const SurfacePoint hit = walkSkin(rig, scene, row, x);
    const Tri& corners = rig.triangles[hit.triangle];
    plane.vertices = 3;
    for (int k = 0; k < 3; ++k) {
        plane.vertex[k] = static_cast<std::uint32_t>(corners[k]);
        plane.weight[k] = hit.weights[k];
    }
    const Vec3f smooth = smoothNormal(hit, corners, [&](int v) { return scene.normalOf(v); });
    float facing = smooth.dot(own);
    if (row.insideAtRest) {
        Vec3f anchor = Vec3f::Zero();
        for (int k = 0; k < 3; ++k)
            anchor += scene.normalOf(static_cast<std::size_t>(rig.triangles[rig.starts[row.first]][k]));
        facing = std::max(facing, smooth.dot(anchor.normalized()));
    }
    float trust = trustOf(facing);
    const Vec3f away = hit.point - x, both = row.insideAtRest ? smooth : (smooth + own).normalized();
    if (both.dot(away) < 0) {
        float overlap = row.offset;
        if (const SkinBody& body = rig.bodies[row.body]; body.bone()) {
            // Bones such as teeth may stick out of the skin at rest, and may again.
            const std::uint32_t v = row.vertex - body.first;
            overlap = offset =
                std::min(heightAtRest(rig, body.rest[v].head<3>(), body.normals[v].head<3>(), hit), 0.0f);
        }
        trust *= entryTrust(away.norm(), motionSinceRest(rig, scene, row).norm() - overlap);
    }
    if (!(trust > 0)) return plane;
    fillPlane(rig, scene, both, away,
              both.dot(away) >= 0 ? 1.0f
              : row.insideAtRest  ? -1.0f
                                  : 0.0f,
              trust, offset, plane);
    return plane;
}

SkinPlane skinOnSkin(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset) {
    SkinPlane plane;
    const Vec3f x = vertexPlace(scene, row);
    const SurfacePoint hit = walkSkin(rig, scene, row, x);
    const Tri& corners = rig.triangles[hit.triangle];
    plane.vertices = 1;
    plane.vertex[0] = row.vertex;
    plane.weight[0] = 1;
    // Around the end of a fold the walk may arrive at the vertex itself.
    if ((corners.array() == static_cast<int>(row.vertex)).any()) return plane;
    plane.vertices = 4;
    for (int k = 0; k < 3; ++k) {
        plane.vertex[k + 1] = static_cast<std::uint32_t>(corners[k]);
        plane.weight[k + 1] = -hit.weights[k];
    }
    const Vec3f smooth = smoothNormal(hit, corners, [&](int v) { return scene.normalOf(v); });
    const Vec3f own = scene.normalOf(row.vertex);
    float trust = trustOf(-smooth.dot(own));
    const Vec3f away = x - hit.point, both = (smooth - own).normalized();
    if (both.dot(away) < 0) {
        trust *= entryTrust(away.norm(), motionSinceRest(rig, scene, row).norm() - row.offset);
        // A part of the skin behind the vertex at rest may be the back of its own layer, and no obstacle:
        // unless it was much farther away.
        const Vec3f place = rig.places[row.vertex].head<3>(),
                    outward = rig.placeNormals[row.vertex].head<3>();
        const float apart = (place - placeAtRest(rig, hit)).norm();
        trust *= std::max(entryTrust(heightAtRest(rig, place, -outward, hit), enterDepth * rig.radius),
                          entryTrust(away.norm(), ownLayer * apart));
    }
    if (!(trust > 0)) return plane;
    fillPlane(rig, scene, both, away, both.dot(away) < 0 ? 0.0f : 1.0f, trust, offset, plane);
    return plane;
}

} // namespace

SkinPlane queryContact(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset) {
    switch (row.kind) {
    case SkinContactKind::SkinOnBody:
        return skinOnBody(rig, scene, row, offset);
    case SkinContactKind::BodyOnSkin:
        return bodyOnSkin(rig, scene, row, offset);
    case SkinContactKind::SkinOnSkin:
        break;
    }
    return skinOnSkin(rig, scene, row, offset);
}

} // namespace tss
