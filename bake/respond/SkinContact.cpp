#include "bake/respond/SkinContact.h"

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

/// Of what the corners of a triangle have, what a point of it has.
Vec3f between(const SurfacePoint& at, const Tri& corners, const auto& of) {
    Vec3f sum = Vec3f::Zero();
    for (int k = 0; k < 3; ++k) sum += at.weights[k] * of(corners[k]);
    return sum;
}

Vec3f smoothNormal(const SurfacePoint& at, const Tri& corners, const auto& normal) {
    const Vec3f sum = between(at, corners, normal);
    const float length = sum.norm();
    return length > 0 ? Vec3f(sum / length) : sum;
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

/// Trust in a contact of this depth, given the greatest depth that the motion since rest and the overlap at
/// rest explain: what is deeper was not entered through this side of the surface. 1 up to `most`, 0 at twice
/// that.
float entryTrust(float depth, float most) {
    return most > 0 ? 1 - smoothStep((depth - most) / most) : 0;
}

/// How the offset between the two sides of a row has changed since rest.
Vec3f motionSinceRest(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    return anchorOffset(rig, scene, row) - rig.clearances[clearancesAtRest(rig, row)].head<3>();
}

/// How far a point inside of a muscle can be from a point of its surface that is the nearest: the radius of
/// the ball inside that touches there.
float roomAt(const SkinBody& body, const SurfacePoint& at) {
    float room = 0;
    for (int k = 0; k < 3; ++k) room += at.weights[k] * body.room[body.triangles[at.triangle][k]];
    return room;
}

/// The point of a bone that skin is held at where it has gone into the bone: the nearest on those triangles
/// that face as the vertex does or as what it faced at rest. motion: of the vertex since rest; most: how deep
/// it can be.
SurfacePoint enteredBone(const SkinBody& bone, const SkinRow& row, int start, const Vec3f& x,
                         const Vec3f& motion, const Vec3f& own, float most) {
    const Vec3 place = x.cast<double>();
    const int first = row.insideAtRest ? start : bone.locator->entered((x - motion).cast<double>(), place);
    if (first < 0) return {};
    const double range = 2 * static_cast<double>(most); // beyond this depth entryTrust() is 0
    NearestPoint near = bone.locator->nearestFacing(place, range, own.cast<double>(), first);
    const NearestPoint other = bone.locator->nearestFacing(place, near.triangle < 0 ? range : near.distance,
                                                           row.facing.cast<double>());
    if (other.triangle >= 0) near = other;
    return {near.triangle, near.weights.cast<float>(), near.point.cast<float>(),
            static_cast<float>(near.distance * near.distance)};
}

/// The side of a muscle's surface that a point is on, given the offset `away` from its nearest point: by the
/// triangle's own normal where that point is inside the triangle, since smooth normals are wrong near sharp
/// edges, and by the smooth normal on edges and corners. -1 or 1.
float sideOf(const SurfacePoint& hit, const Tri& t, const auto& at, const Vec3f& smooth, const Vec3f& away) {
    const bool within = hit.weights.minCoeff() > 0;
    const Vec3f normal = within ? Vec3f((at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]))) : smooth;
    return normal.dot(away) < 0 ? -1.0f : 1.0f;
}

SkinPlane skinOnBody(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset) {
    SkinPlane plane;
    plane.add(row.vertex, 1);
    const SkinBody& body = rig.bodies[row.body];
    const SkinScene::Placed& placed = scene.bodies[row.body];
    const Vec3f x = placed.toBody(scene.skin[row.vertex].head<3>());
    Vec3f own = placed.turnedBack(scene.normalOf(row.vertex));
    if (row.fromOutside) own = -own;
    const Vec3f motion = motionSinceRest(rig, scene, row);
    float most = motion.norm() - row.offset;
    const Move *surface = scene.surface.data() + body.first, *normals = scene.normals.data() + body.first;
    const auto at = [&](int v) -> Vec3f { return surface[v].head<3>(); };
    const int start = rig.starts[row.first];
    const SurfacePoint hit = body.bone() ? enteredBone(body, row, start, x, motion, own, most)
                                         : walkDownhill(x, start, body.triangles, body.across, at, walkSteps);
    if (hit.triangle < 0) return plane;
    const Tri& t = body.triangles[hit.triangle];
    Vec3f smooth = smoothNormal(hit, t, [&](int v) { return normals[v].head<3>(); });
    // A bone's triangles are those that face the skin; of a muscle the side faced at rest counts too.
    float trust = body.bone() ? 1.0f : trustOf(std::max(smooth.dot(own), smooth.dot(row.facing)));
    const Vec3f away = x - hit.point;
    const bool inside = smooth.dot(away) < 0;
    // Inside a bone skin is pushed along the smooth normal only, not sideways out of a thin edge.
    float side = body.bone() ? (inside ? 0.0f : 1.0f) : sideOf(hit, t, at, smooth, away);
    if (side < 1 || inside) {
        if (!body.bone()) most = std::min(most, std::max(roomAt(body, hit), -row.offset));
        trust *= entryTrust(away.norm(), most);
    }
    if (!(trust > 0)) return plane;
    if (row.flipped) {
        smooth = -smooth;
        side = -side;
    }
    fillPlane(rig, scene, placed.turned(smooth), placed.turned(away), side, trust, offset, plane);
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

/// The point of the skin that a vertex at x meets.
SurfacePoint walkSkin(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, const Vec3f& x) {
    const auto at = [&](int v) -> Vec3f { return scene.skin[v].head<3>(); };
    return walkDownhill(x, nearestStart(rig, scene, row, x), rig.triangles, rig.across, at, walkSteps);
}

/// Signed height of the skin at rest above a vertex, at the point of the skin that the vertex touches now;
/// fades to 0 where that point lay to the side. normal: of the vertex at rest; away: from it to the point.
float heightAtRest(const SkinRig& rig, const SurfacePoint& hit, const Vec3f& normal, const Vec3f& away) {
    const Vec3f smooth =
        smoothNormal(hit, rig.triangles[hit.triangle], [&](int c) { return rig.placeNormals[c].head<3>(); });
    const float above = (smooth + normal).normalized().dot(away);
    return above == 0 ? 0 : above * smoothStep(2 * std::abs(above) / away.norm() - 0.5f);
}

/// What is left of the trust in a contact of a vertex that is this deep behind the skin. offset: of a bone's
/// vertex it is set to what that keeps.
float trustBehind(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, const SurfacePoint& hit,
                  float trust, float depth, float& offset) {
    const float motion = motionSinceRest(rig, scene, row).norm();
    const Vec3f place =
        between(hit, rig.triangles[hit.triangle], [&](int c) { return rig.places[c].head<3>(); });
    if (row.kind == SkinContactKind::SkinOnSkin) {
        // A part of the skin behind the vertex at rest may be the back of its own layer, and no obstacle:
        // unless it was much farther away.
        const Vec3f away = place - rig.places[row.vertex].head<3>();
        const float height = heightAtRest(rig, hit, -rig.placeNormals[row.vertex].head<3>(), away);
        trust *= entryTrust(depth, motion - row.offset);
        return trust * std::max(entryTrust(height, enterDepth * rig.radius),
                                entryTrust(depth, ownLayer * away.norm()));
    }
    const SkinBody& body = rig.bodies[row.body];
    if (!body.bone()) return trust * entryTrust(depth, motion - row.offset);
    // Bones such as teeth may stick out of the skin at rest, and may again.
    const std::uint32_t v = row.vertex - body.first;
    offset =
        std::min(heightAtRest(rig, hit, body.normals[v].head<3>(), place - body.rest[v].head<3>()), 0.0f);
    return trust * entryTrust(depth, motion - offset);
}

/// A vertex of a body or of the skin against another part of the skin. The vertex of a body is below.
SkinPlane againstSkin(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset) {
    SkinPlane plane;
    const bool onSkin = row.kind == SkinContactKind::SkinOnSkin;
    const Vec3f x = vertexPlace(scene, row);
    const SurfacePoint hit = walkSkin(rig, scene, row, x);
    const Tri& corners = rig.triangles[hit.triangle];
    if (onSkin) plane.add(row.vertex, 1);
    // Around the end of a fold the walk may arrive at the vertex itself.
    if (onSkin && (corners.array() == static_cast<int>(row.vertex)).any()) return plane;
    for (int k = 0; k < 3; ++k)
        plane.add(static_cast<std::uint32_t>(corners[k]), onSkin ? -hit.weights[k] : hit.weights[k]);
    const auto normal = [&](int v) { return scene.normalOf(v); };
    const Vec3f smooth = smoothNormal(hit, corners, normal),
                own = onSkin ? Vec3f(-normal(static_cast<int>(row.vertex)))
                             : scene.bodies[row.body].turned(scene.normals[row.vertex].head<3>());
    float facing = smooth.dot(own);
    if (row.insideAtRest) {
        const Tri& anchor = rig.triangles[rig.starts[row.first]];
        const Vec3f sum = normal(anchor[0]) + normal(anchor[1]) + normal(anchor[2]);
        facing = std::max(facing, smooth.dot(sum.normalized()));
    }
    float trust = trustOf(facing);
    const Vec3f away = onSkin ? x - hit.point : hit.point - x,
                both = row.insideAtRest ? smooth : (smooth + own).normalized();
    const bool behind = both.dot(away) < 0;
    if (behind) trust = trustBehind(rig, scene, row, hit, trust, away.norm(), offset);
    if (!(trust > 0)) return plane;
    const float inside = row.insideAtRest ? -1.0f : 0.0f;
    fillPlane(rig, scene, both, away, behind ? inside : 1.0f, trust, offset, plane);
    return plane;
}

} // namespace

SkinPlane queryContact(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset) {
    return row.kind == SkinContactKind::SkinOnBody ? skinOnBody(rig, scene, row, offset)
                                                   : againstSkin(rig, scene, row, offset);
}

} // namespace tss
