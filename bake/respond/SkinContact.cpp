#include "bake/respond/SkinContact.h"

#include "bake/respond/SkinWalk.h"

#include <algorithm>
#include <cmath>

namespace tss {

using Vec3f = Eigen::Vector3f;

Vec3f placeOf(const SkinScene& scene, const SkinPlane& plane) {
    Vec3f sum = Vec3f::Zero();
    for (int k = 0; k < plane.vertices; ++k) sum += plane.weight[k] * scene.skin[plane.vertex[k]].head<3>();
    return sum;
}

namespace {

/// Cosine between two surfaces at which a contact is not believed, and from which on it is: what faces the
/// skin's way at less than 84 degrees may be its other side.
constexpr float leastFacing = 0.1f, fullFacing = 0.5f;
/// Triangles that a look-up walks over, at most: enough for a slide over a tenth of a fine surface; more
/// would only serve what is not near its start.
constexpr int walkSteps = 40;
/// How far a bone is looked for: in radii of the skin, and in sizes of it, whichever is more. What is farther
/// meets nothing; over the last quarter of the way there it fades.
constexpr float boneReach = 12, boneReachOfSize = 0.1f;

float smoothStep(float t) {
    t = std::clamp(t, 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

float trustOf(float facing) {
    return smoothStep((facing - leastFacing) / (fullFacing - leastFacing));
}

/// relativeOf() with a fourth number of 0, so that it is reckoned four at a time.
inline Move relativePlace(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    const SkinScene::Placed& placed = scene.bodies[row.body];
    const auto before = [&](const Move* surface) -> Move {
        return row.weights[0] * surface[row.corners[0]] + row.weights[1] * surface[row.corners[1]] +
               row.weights[2] * surface[row.corners[2]];
    };
    const auto toBody = [&](const Move& x) -> Move {
        if (!placed.moved) return x;
        const Vec3f y = placed.toBody(x.head<3>());
        return {y[0], y[1], y[2], 0};
    };
    const Move* skin = scene.skin.data();
    if (row.meeting == SkinMeeting::BodyOnSkin) return scene.surface[row.vertex] - toBody(before(skin));
    if (row.meeting == SkinMeeting::SkinOnSkin) return skin[row.vertex] - before(skin);
    const SkinBody& body = rig.bodies[row.body];
    const Move x = toBody(skin[row.vertex]);
    return body.bone() ? x : Move(x - before(scene.surface.data() + body.first));
}

/// The direction in which a surface pushes: its smooth normal; from beside a rim, or from within a thin edge,
/// more and more straight to or from its nearest point, without a jump. side: -1 inside, 1 outside, 0: along
/// the smooth normal.
Vec3f pushDirection(const Vec3f& smooth, const Vec3f& away, float side, float radius) {
    const Vec3f blend = radius * smooth + side * away;
    const float length = blend.norm();
    return length > 0 ? Vec3f(blend / length) : smooth;
}

Vec3f smoothAt(const SurfacePoint& at, const Tri& corners, const auto& normal) {
    Vec3f sum = Vec3f::Zero();
    for (int k = 0; k < 3; ++k) sum += at.weights[k] * normal(corners[k]);
    const float length = sum.norm();
    return length > 0 ? Vec3f(sum / length) : sum;
}

/// Which side of a surface what lies `away` from its nearest point is on: amid a triangle that of the
/// triangle, since smooth normals may lie beside sharp edges; at its edges and corners that of the smooth
/// normal.
float sideOf(const SurfacePoint& at, const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& smooth,
             const Vec3f& away) {
    const Vec3f normal = at.weights.minCoeff() > 0 ? Vec3f((b - a).cross(c - a)) : smooth;
    return normal.dot(away) < 0 ? -1.0f : 1.0f;
}

/// Fills gap, level and normal of a plane whose vertices stand: away is what lies between.
void finish(const SkinRig& rig, const SkinScene& scene, const Vec3f& smooth, const Vec3f& away, float side,
            float trust, float offset, SkinPlane& plane) {
    plane.normal = pushDirection(smooth, away, side, rig.radius);
    const float distance = plane.normal.dot(away);
    const float beside = (away - distance * plane.normal).norm() / rig.radius;
    trust *= 1 - smoothStep(beside - 1);
    plane.distance = distance;
    plane.gap = distance - offset;
    // What is not quite believed asks for less, so that contacts come and go without a jump.
    plane.gap += (1 - trust) * (std::max(-plane.gap, 0.0f) + rig.radius);
    plane.level = plane.normal.dot(placeOf(scene, plane)) - plane.gap;
    plane.found = trust > 0;
}

SurfacePoint toPoint(const NearestPoint& near) {
    return {near.triangle, near.weights.cast<float>(), near.point.cast<float>(),
            static_cast<float>(near.distance * near.distance)};
}

/// Whether what seems this deep in a surface can have come there: by its way since rest, and the overlap
/// there. What seems deeper is another side of the surface, seen past it.
float comeThrough(float depth, float most) {
    return most > 0 ? 1 - smoothStep((depth - most) / most) : 0;
}

/// What meets since rest, as seen from what it is before.
Vec3f wayOf(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    return relativeOf(rig, scene, row) - rig.apart[row.apart].relative();
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
    SurfacePoint hit;
    Vec3f way = Vec3f::Zero();
    const float reach = std::max(boneReach * rig.radius, boneReachOfSize);
    if (body.bone()) {
        way = wayOf(rig, scene, row);
        int first = rig.starts[row.first];
        if (row.offset == 0) first = body.locator->entered((x - way).cast<double>(), x.cast<double>());
        if (first < 0) return plane;
        // Deeper than twice its way it is not believed, see comeThrough().
        const float range = std::min(reach, 2 * (way.norm() - row.offset));
        hit = toPoint(body.locator->nearestFacing(x.cast<double>(), static_cast<double>(range),
                                                  own.cast<double>(), first));
    } else {
        const Move* surface = scene.surface.data() + body.first;
        const auto at = [&](int v) -> Vec3f { return surface[v].head<3>(); };
        hit = walkDownhill(x, rig.starts[row.first], body.triangles, body.across, at, walkSteps);
    }
    if (hit.triangle < 0) return plane;
    const Move* normals = scene.normals.data() + body.first;
    Vec3f smooth = smoothAt(hit, body.triangles[hit.triangle], [&](int v) { return normals[v].head<3>(); });
    // Skin inside a muscle may be nearest to a side that faces away from it.
    float trust = trustOf(std::max(smooth.dot(own), smooth.dot(row.facing)));
    const Vec3f away = x - hit.point;
    if (body.bone() && smooth.dot(away) < 0)
        trust *=
            comeThrough(away.norm(), way.norm() - row.offset) * (1 - smoothStep(4 * away.norm() / reach - 3));
    if (!(trust > 0)) return plane;
    const Tri& t = body.triangles[hit.triangle];
    const Move* at = scene.surface.data() + body.first;
    float side = sideOf(hit, at[t[0]].head<3>(), at[t[1]].head<3>(), at[t[2]].head<3>(), smooth, away);
    // Of a bone only what faces the skin is looked at: beside that, skin is not pushed along it.
    if (body.bone()) side = smooth.dot(away) < 0 ? 0.0f : 1.0f;
    if (row.turned) {
        smooth = -smooth;
        side = -side;
    }
    finish(rig, scene, placed.moved ? placed.turn * smooth : smooth, placed.moved ? placed.turn * away : away,
           side, trust, offset, plane);
    return plane;
}

/// Of the triangles of the skin that a row is known to meet, the one whose first corner is nearest to x.
struct KnownTriangle {
    int triangle = -1;
    float squared = std::numeric_limits<float>::max(); ///< distance
};

KnownTriangle nearestKnown(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, const Vec3f& x) {
    KnownTriangle known;
    for (std::uint32_t k = row.first; k < row.last; ++k) {
        const Tri& t = rig.triangles[rig.starts[k]];
        const float squared = (x - scene.skin[t[0]].head<3>()).squaredNorm();
        if (squared < known.squared) known = {rig.starts[k], squared};
    }
    return known;
}

/// Where what meets the skin is: a vertex of a body or of the skin itself.
Vec3f placeBefore(const SkinScene& scene, const SkinRow& row) {
    if (row.meeting == SkinMeeting::SkinOnSkin) return scene.skin[row.vertex].head<3>();
    return scene.bodies[row.body].toSkin(scene.surface[row.vertex].head<3>());
}

SurfacePoint walkSkin(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, const Vec3f& x) {
    const auto at = [&](int v) -> Vec3f { return scene.skin[v].head<3>(); };
    const int start = nearestKnown(rig, scene, row, x).triangle;
    return walkDownhill(x, start, rig.triangles, rig.across, at, walkSteps);
}

/// How far the skin lay above something at rest, there where the two meet now; 0 where it lay beside it.
/// place, normal: its own at rest.
float aboveAtRest(const SkinRig& rig, const Vec3f& place, const Vec3f& normal, const SurfacePoint& hit) {
    const Tri& corners = rig.triangles[hit.triangle];
    Vec3f away = -place;
    for (int k = 0; k < 3; ++k) away += hit.weights[k] * rig.places[corners[k]].head<3>();
    const Vec3f smooth = smoothAt(hit, corners, [&](int c) { return rig.placeNormals[c].head<3>(); });
    const float above = (smooth + normal).normalized().dot(away);
    return above == 0 ? 0 : above * smoothStep(2 * std::abs(above) / away.norm() - 0.5f);
}

SkinPlane bodyOnSkin(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset) {
    SkinPlane plane;
    const SkinScene::Placed& placed = scene.bodies[row.body];
    const Vec3f x = placeBefore(scene, row);
    Vec3f own = scene.normals[row.vertex].head<3>();
    if (placed.moved) own = placed.turn * own;
    const SurfacePoint hit = walkSkin(rig, scene, row, x);
    const Tri& corners = rig.triangles[hit.triangle];
    plane.vertices = 3;
    for (int k = 0; k < 3; ++k) {
        plane.vertex[k] = static_cast<std::uint32_t>(corners[k]);
        plane.weight[k] = hit.weights[k];
    }
    const Vec3f smooth = smoothAt(hit, corners, [&](int v) { return scene.normalOf(v); });
    float facing = smooth.dot(own);
    if (row.within) {
        Vec3f before = Vec3f::Zero();
        for (int k = 0; k < 3; ++k)
            before += row.weights[k] * scene.normalOf(static_cast<std::size_t>(row.corners[k]));
        facing = std::max(facing, smooth.dot(before.normalized()));
    }
    float trust = trustOf(facing);
    const Vec3f away = hit.point - x, both = row.within ? smooth : (smooth + own).normalized();
    if (rig.bodies[row.body].bone() && both.dot(away) < 0) {
        // Teeth stick out at rest, and may again.
        const SkinBody& body = rig.bodies[row.body];
        const std::uint32_t v = row.vertex - body.first;
        offset = std::min(aboveAtRest(rig, body.rest[v].head<3>(), body.normals[v].head<3>(), hit), 0.0f);
        trust *= comeThrough(away.norm(), wayOf(rig, scene, row).norm() - offset);
    }
    if (!(trust > 0)) return plane;
    finish(rig, scene, both, away,
           both.dot(away) >= 0 ? 1.0f
           : row.within        ? -1.0f
                               : 0.0f,
           trust, offset, plane);
    return plane;
}

SkinPlane skinOnSkin(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset) {
    SkinPlane plane;
    const Vec3f x = placeBefore(scene, row);
    const SurfacePoint hit = walkSkin(rig, scene, row, x);
    const Tri& corners = rig.triangles[hit.triangle];
    plane.vertices = 1;
    plane.vertex[0] = row.vertex;
    plane.weight[0] = 1;
    // Around a fold's end the walk comes to the vertex itself.
    if ((corners.array() == static_cast<int>(row.vertex)).any()) return plane;
    plane.vertices = 4;
    for (int k = 0; k < 3; ++k) {
        plane.vertex[k + 1] = static_cast<std::uint32_t>(corners[k]);
        plane.weight[k + 1] = -hit.weights[k];
    }
    const Vec3f smooth = smoothAt(hit, corners, [&](int v) { return scene.normalOf(v); });
    const Vec3f own = scene.normalOf(row.vertex);
    float trust = trustOf(-smooth.dot(own));
    const Vec3f away = x - hit.point, both = (smooth - own).normalized();
    if (both.dot(away) < 0) {
        trust *= comeThrough(away.norm(), wayOf(rig, scene, row).norm() - row.offset);
        // What it was behind at rest is the other side of its own layer.
        trust *= comeThrough(
            aboveAtRest(rig, rig.places[row.vertex].head<3>(), -rig.placeNormals[row.vertex].head<3>(), hit),
            enterDepth * rig.radius);
    }
    if (!(trust > 0)) return plane;
    finish(rig, scene, both, away, both.dot(away) < 0 ? 0.0f : 1.0f, trust, offset, plane);
    return plane;
}

} // namespace

Vec3f relativeOf(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    return relativePlace(rig, scene, row).head<3>();
}

float distanceToKnown(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    return std::sqrt(nearestKnown(rig, scene, row, placeBefore(scene, row)).squared);
}

bool mayMeet(const SkinRig& rig, const SkinScene& scene, const SkinRow& row) {
    const bool onSkin = row.meeting == SkinMeeting::SkinOnSkin;
    const SkinScene::Placed& placed = scene.bodies[row.body];
    // Of the skin: half of what edges are let change.
    const float strain = row.meeting == SkinMeeting::SkinOnBody ? placed.strain : 0.25f;
    const SkinApart* apart = rig.apart.data() + row.apart + (onSkin ? 0 : placed.at.node);
    // Beside the place that is looked at, a surface has moved by its strain over at most twice the gap.
    float free = apart->gap() * (1 - 2 * strain);
    // At rest nothing is lacking; where a muscle stands by itself something may be.
    if (onSkin || rig.bodies[row.body].bone()) free = std::max(free, unseen);
    if (!(free > 0)) return true;
    Move expected = apart->lie;
    if (!onSkin && placed.at.t != 0) expected += static_cast<float>(placed.at.t) * (apart[1].lie - expected);
    const Move off = relativePlace(rig, scene, row) - expected; // and the gap
    return off[0] * off[0] + off[1] * off[1] + off[2] * off[2] >= free * free;
}

SkinPlane lookUp(const SkinRig& rig, const SkinScene& scene, const SkinRow& row, float offset) {
    switch (row.meeting) {
    case SkinMeeting::SkinOnBody:
        return skinOnBody(rig, scene, row, offset);
    case SkinMeeting::BodyOnSkin:
        return bodyOnSkin(rig, scene, row, offset);
    case SkinMeeting::SkinOnSkin:
        break;
    }
    return skinOnSkin(rig, scene, row, offset);
}

} // namespace tss
