#include "bake/respond/SkinContact.h"

#include <algorithm>
#include <limits>

namespace tss {
namespace {

constexpr int selected = 2; ///< spheres whose triangles are looked at

bool isIdentity(const Pose& pose) {
    return pose.matrix() == Pose::Identity().matrix();
}

/// Normals of a closed muscle, weighted by area: smooth enough, and cheap.
void areaNormals(const std::vector<Vec3>& vertices, const std::vector<Tri>& triangles,
                 std::vector<Vec3>& normals) {
    normals.assign(vertices.size(), Vec3::Zero());
    for (const Tri& t : triangles) {
        const Vec3 n = (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
        for (int k = 0; k < 3; ++k) normals[t[k]] += n;
    }
    for (Vec3& n : normals) n.normalize();
}

void follow(const MuscleTrack& track, double activation, const Pose* pose, std::vector<Vec3>& places) {
    const TrackPlace place = locate(track.nodes, activation);
    places.resize(track.points);
    for (std::size_t i = 0; i < track.points; ++i) {
        const Vec3 x = trackPosition(track, place, i);
        places[i] = pose ? Vec3(*pose * x) : x;
    }
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
    scene.predicted = rig.rest;
    scene.reference.assign(rig.rest.size(), Vec3::Zero());
    std::vector<Vec3> carried;
    for (std::size_t m = 0; m < rig.muscles.size(); ++m) {
        const SkinMuscle& muscle = rig.muscles[m];
        PlacedMuscle& placed = scene.muscles[m];
        const double activation = m < activations.size() ? activations[m] : 0;
        const Pose* pose = m < poses.size() && !isIdentity(poses[m]) ? &poses[m] : nullptr;
        follow(muscle.surface, activation, pose, placed.surface);
        follow(muscle.spheres, activation, pose, placed.centres);
        areaNormals(placed.surface, muscle.triangles, placed.normals);
        placed.radii.resize(muscle.radii.size());
        const TrackPlace place = locate(muscle.spheres.nodes, activation);
        for (std::size_t i = 0; i < placed.radii.size(); ++i)
            placed.radii[i] = muscle.radii[i] * trackThickness(muscle.spheres, place, i);

        follow(muscle.skin, activation, pose, carried);
        for (const SkinCarry& c : muscle.carried) {
            const Vec3 d = carried[c.point] - rig.rest[c.vertex];
            scene.predicted[c.vertex] += c.share * d;
            scene.reference[c.vertex] += c.stiffness * rig.inverseMass[c.vertex] * d;
        }
    }
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
    Vec3 weights, point;
    Tri corners;
    const PlacedMuscle* on = nullptr;
    for (const SkinTest* test : best) {
        if (!test) continue;
        const SkinMuscle& muscle = rig.muscles[test->muscle];
        const PlacedMuscle& placed = scene.muscles[test->muscle];
        for (std::uint32_t k = muscle.behindStart[test->sphere]; k < muscle.behindStart[test->sphere + 1];
             ++k) {
            const Tri& t = muscle.triangles[muscle.behind[k]];
            const Vec3 &a = placed.surface[t[0]], &b = placed.surface[t[1]], &c = placed.surface[t[2]];
            if ((b - a).cross(c - a).dot(facing) <= 0) continue;
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
    for (std::uint32_t& v : contact.vertex) v = row.vertex;
    contact.weight[0] = 1;
    contact.bound = contact.normal.dot(point - rig.rest[row.vertex]);
    return contact;
}

SkinContact pokeContact(const SkinRig& rig, const SkinScene& scene, std::size_t index) {
    const SkinPoke& poke = rig.pokes[index];
    const PlacedMuscle& muscle = scene.muscles[poke.muscle];
    const Vec3& x = muscle.surface[poke.vertex];
    const Vec3& normal = muscle.normals[poke.vertex];
    const auto place = [&](std::uint32_t v) -> const Vec3& { return scene.predicted[v]; };

    SkinContact contact;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t k = poke.first; k < poke.last; ++k) {
        const Tri& t = rig.triangles[rig.pokeTriangles[k]];
        const Vec3 &a = place(t[0]), &b = place(t[1]), &c = place(t[2]);
        const Vec3 w = nearestOnTriangle(x, a, b, c);
        const double d = (x - w[0] * a - w[1] * b - w[2] * c).squaredNorm();
        if (!(d < nearest)) continue;
        nearest = d;
        contact.normal = normal;
        for (int i = 0; i < 3; ++i) {
            contact.vertex[i] = static_cast<std::uint32_t>(t[i]);
            contact.weight[i] = w[i];
        }
    }
    if (!contact.found()) return contact;
    Vec3 onSkin = Vec3::Zero();
    for (int i = 0; i < 3; ++i) onSkin += contact.weight[i] * rig.rest[contact.vertex[i]];
    contact.bound = normal.dot(x - onSkin);
    return contact;
}

} // namespace tss
