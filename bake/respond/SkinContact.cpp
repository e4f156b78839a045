#include "bake/respond/SkinContact.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace tss {
namespace {

constexpr int selected = 2;         ///< spheres whose triangles are looked at
constexpr int walkSteps = 6;        ///< triangles that a poke walks over, at most
constexpr double leastFacing = 0.1; ///< cosine between muscle and skin at which a contact is not believed ...
constexpr double fullFacing = 0.5;  ///< ... and from which on it is

double trust(double facing) {
    const double t = std::clamp((facing - leastFacing) / (fullFacing - leastFacing), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

bool isIdentity(const Pose& pose) {
    return pose.matrix() == Pose::Identity().matrix();
}

/// Normals of a closed muscle, weighted by area: smooth enough, and cheap.
void findNormals(const std::vector<Tri>& triangles, PlacedMuscle& placed) {
    placed.normals.assign(placed.surface.size(), Vec3::Zero());
    placed.faces.resize(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Tri& t = triangles[i];
        const Vec3& a = placed.surface[t[0]];
        placed.faces[i] = (placed.surface[t[1]] - a).cross(placed.surface[t[2]] - a);
        for (int k = 0; k < 3; ++k) placed.normals[t[k]] += placed.faces[i];
    }
    for (Vec3& n : placed.normals) n.normalize();
}

void follow(const MuscleTrack& track, double activation, const Pose* pose, std::vector<Vec3>& places) {
    const TrackPlace place = locate(track.nodes, activation);
    places.resize(track.points);
    for (std::size_t i = 0; i < track.points; ++i) {
        const Vec3 x = trackPosition(track, place, i);
        places[i] = pose ? Vec3(*pose * x) : x;
    }
}

void place(const SkinMuscle& muscle, double activation, const Pose& pose, PlacedMuscle& placed) {
    if (placed.activation == activation && placed.pose.matrix() == pose.matrix()) return;
    placed.activation = activation;
    placed.pose = pose;
    placed.dragPlace = locate(muscle.drag.nodes, activation);
    const Pose* moved = isIdentity(pose) ? nullptr : &pose;
    follow(muscle.surface, activation, moved, placed.surface);
    follow(muscle.spheres, activation, moved, placed.centres);
    findNormals(muscle.triangles, placed);
    placed.moved.resize(placed.surface.size());
    for (std::size_t v = 0; v < placed.moved.size(); ++v)
        placed.moved[v] = (placed.surface[v] - muscle.rest[v]).norm();
    placed.radii.resize(muscle.radii.size());
    const TrackPlace at = locate(muscle.spheres.nodes, activation);
    for (std::size_t i = 0; i < placed.radii.size(); ++i)
        placed.radii[i] = muscle.radii[i] * trackThickness(muscle.spheres, at, i);
}

void addDrag(const SkinDrag& drag, const TrackPlace& place, std::vector<Move>& sum) {
    const std::size_t count = drag.vertices.size();
    if (count == 0) return;
    const Move* from = &drag.moves[place.node * count];
    const Move* to = place.t == 0 ? from : from + count;
    const float t = static_cast<float>(place.t);
    for (std::size_t k = 0; k < count; ++k) sum[drag.vertices[k]] += from[k] + t * (to[k] - from[k]);
}

/// Turns a nearest point into the direction in which the surface pushes: its smooth normal; from beside a rim
/// more and more straight away from it, without a jump.
Vec3 pushDirection(const Vec3& smooth, const Vec3& away, double radius) {
    if (away.dot(smooth) <= 0) return smooth;
    const Vec3 blend = radius * smooth + away;
    const double length = blend.norm();
    return length > 0 ? Vec3(blend / length) : smooth;
}

} // namespace

void placeMuscles(const SkinRig& rig, std::span<const double> activations, std::span<const Pose> poses,
                  SkinScene& scene) {
    scene.muscles.resize(rig.muscles.size());
    scene.drag.assign(rig.rest.size(), Move::Zero());
    scene.reference.assign(rig.rest.size(), Move::Zero());
    for (std::size_t m = 0; m < rig.muscles.size(); ++m) {
        const SkinMuscle& muscle = rig.muscles[m];
        place(muscle, activations[m], poses[m], scene.muscles[m]);
        addDrag(muscle.drag, scene.muscles[m].dragPlace, scene.drag);
        if (isIdentity(poses[m])) continue;
        const TrackPlace at = locate(muscle.skin.nodes, activations[m]);
        for (std::size_t i = 0; i < muscle.carried.size(); ++i) {
            const Vec3 x = trackPosition(muscle.skin, at, i);
            const SkinCarry& c = muscle.carried[i];
            scene.reference[c.vertex].head<3>() += c.pull * (poses[m] * x - x).cast<float>();
        }
    }
    scene.predicted.resize(rig.rest.size());
    for (std::size_t v = 0; v < rig.rest.size(); ++v)
        scene.predicted[v] = rig.rest[v] + (scene.drag[v] + scene.reference[v]).head<3>().cast<double>();
}

SkinContact rowContact(const SkinRig& rig, const SkinScene& scene, std::size_t index) {
    const SkinRow& row = rig.rows[index];
    const Vec3& x = scene.predicted[row.vertex];
    const Vec3& facing = rig.restNormals[row.vertex];

    const SkinTest* best[selected] = {};
    double gaps[selected];
    std::fill(gaps, gaps + selected, std::max(rig.travel, row.radius));
    for (std::uint32_t k = row.first; k < row.last; ++k) {
        const SkinTest& test = rig.tests[k];
        const PlacedMuscle& muscle = scene.muscles[test.muscle];
        double gap = (x - muscle.centres[test.sphere]).norm() - muscle.radii[test.sphere] - row.radius;
        const SkinTest* candidate = &test;
        for (int s = 0; s < selected; ++s)
            if (gap < gaps[s]) {
                std::swap(gap, gaps[s]);
                std::swap(candidate, best[s]);
            }
    }

    double nearest = std::numeric_limits<double>::infinity();
    Vec3 weights = Vec3::Zero(), point = Vec3::Zero();
    Tri corners = Tri::Zero();
    const PlacedMuscle* on = nullptr;
    for (const SkinTest* test : best) {
        if (!test) continue;
        const SkinMuscle& muscle = rig.muscles[test->muscle];
        const PlacedMuscle& placed = scene.muscles[test->muscle];
        for (std::uint32_t k = muscle.behindStart[test->sphere]; k < muscle.behindStart[test->sphere + 1];
             ++k) {
            if (placed.faces[muscle.behind[k]].dot(facing) <= 0) continue;
            const Tri& t = muscle.triangles[muscle.behind[k]];
            const Vec3 &a = placed.surface[t[0]], &b = placed.surface[t[1]], &c = placed.surface[t[2]];
            const Vec3 w = nearestOnTriangle(x, a, b, c);
            const Vec3 p = w[0] * a + w[1] * b + w[2] * c;
            const double d = (x - p).squaredNorm();
            if (!(d < nearest)) continue;
            nearest = d;
            weights = w;
            point = p;
            corners = t;
            on = &placed;
        }
    }
    SkinContact contact;
    if (!on) return contact;
    const Vec3 smooth = (weights[0] * on->normals[corners[0]] + weights[1] * on->normals[corners[1]] +
                         weights[2] * on->normals[corners[2]])
                            .normalized();
    contact.normal = pushDirection(smooth, x - point, row.radius);
    contact.trust = trust(smooth.dot(facing));
    for (std::uint32_t& v : contact.vertex) v = row.vertex;
    contact.weight[0] = 1;
    contact.distance = contact.normal.dot(rig.rest[row.vertex] - point);
    contact.moved = (x - rig.rest[row.vertex]).norm();
    for (int k = 0; k < 3; ++k) contact.moved += weights[k] * on->moved[corners[k]];
    return contact;
}

SkinContact pokeContact(const SkinRig& rig, const SkinScene& scene, std::size_t index) {
    const SkinPoke& poke = rig.pokes[index];
    const PlacedMuscle& muscle = scene.muscles[poke.muscle];
    const Vec3& x = muscle.surface[poke.vertex];
    const auto at = [&](int v) -> const Vec3& { return scene.predicted[v]; };

    SkinContact contact;
    int triangle = rig.pokeTriangles[poke.first + muscle.dragPlace.node];
    if (triangle < 0 && muscle.dragPlace.t > 0)
        triangle = rig.pokeTriangles[poke.first + muscle.dragPlace.node + 1];
    if (triangle < 0) return contact;
    // From the triangle known at the node downhill to the nearest one.
    double nearest = std::numeric_limits<double>::infinity();
    Vec3 weights = Vec3::Zero(), point = Vec3::Zero();
    Tri corners = Tri::Zero();
    for (int step = 0, next = triangle; step < walkSteps && next >= 0; ++step) {
        const int from = std::exchange(next, -1);
        for (int k = step == 0 ? -1 : 0; k < 3; ++k) {
            const int candidate = k < 0 ? from : rig.across[from][k];
            if (candidate < 0) continue;
            const Tri& t = rig.triangles[candidate];
            const Vec3 w = nearestOnTriangle(x, at(t[0]), at(t[1]), at(t[2]));
            const Vec3 p = w[0] * at(t[0]) + w[1] * at(t[1]) + w[2] * at(t[2]);
            const double d = (x - p).squaredNorm();
            if (!(d < nearest)) continue;
            nearest = d;
            weights = w;
            point = p;
            corners = t;
            next = candidate;
        }
    }
    Vec3 normal = Vec3::Zero();
    for (int i = 0; i < 3; ++i) normal += weights[i] * rig.restNormals[corners[i]];
    normal.normalize();
    contact.trust = trust(normal.dot(muscle.normals[poke.vertex]));
    if (!(contact.trust > 0)) return contact;
    contact.normal =
        pushDirection((normal + muscle.normals[poke.vertex]).normalized(), point - x, poke.radius);
    Vec3 onSkin = Vec3::Zero();
    contact.moved = muscle.moved[poke.vertex];
    for (int i = 0; i < 3; ++i) {
        contact.vertex[i] = static_cast<std::uint32_t>(corners[i]);
        contact.weight[i] = weights[i];
        onSkin += weights[i] * rig.rest[corners[i]];
        contact.moved += weights[i] * (at(corners[i]) - rig.rest[corners[i]]).norm();
    }
    contact.distance = contact.normal.dot(onSkin - x);
    return contact;
}

} // namespace tss
