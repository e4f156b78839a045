#include "bake/respond/SkinContact.h"

#include "bake/respond/SkinWalk.h"

#include <algorithm>
#include <limits>

namespace tss {
namespace {

constexpr int walkSteps = 8;    ///< triangles that a look-up walks over, at most
constexpr double lookSlide = 2; ///< in radii: how far skin that has slid along its muscle is looked up from
                                ///< where the muscle would carry it; farther it may have slid off, or through
constexpr double leastFacing = 0.1; ///< cosine between muscle and skin at which a contact is not believed ...
constexpr double fullFacing = 0.5;  ///< ... and from which on it is

/// From 0 at 0 to 1 at 1.
double smoothStep(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

double trust(double facing) {
    return smoothStep((facing - leastFacing) / (fullFacing - leastFacing));
}

bool isIdentity(const Pose& pose) {
    return pose.matrix() == Pose::Identity().matrix();
}

/// Normals of a closed muscle, weighted by area: smooth enough, and cheap.
void findNormals(const std::vector<Tri>& triangles, PlacedMuscle& placed) {
    placed.normals.assign(placed.surface.size(), Vec3::Zero());
    for (const Tri& t : triangles) {
        const Vec3& a = placed.surface[t[0]];
        const Vec3 n = (placed.surface[t[1]] - a).cross(placed.surface[t[2]] - a);
        for (int k = 0; k < 3; ++k) placed.normals[t[k]] += n;
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

/// The triangle to walk from: that of the node before, or the one after where it has none.
int startAt(const int* triangles, const TrackPlace& place) {
    const int before = triangles[place.node];
    return before >= 0 || place.t == 0 ? before : triangles[place.node + 1];
}

void placeSpheres(const SkinMuscle& muscle, double activation, const Pose* pose, PlacedMuscle& placed) {
    const TrackPlace at = locate(muscle.spheres.nodes, activation);
    placed.centres.resize(muscle.radii.size(), Vec3::Zero());
    placed.radii.resize(muscle.radii.size(), 0);
    double farthest = 0;
    for (std::size_t i = 0; i < muscle.radii.size(); ++i) {
        const Vec3 x = trackPosition(muscle.spheres, at, i), centre = pose ? Vec3(*pose * x) : x;
        const double radius = muscle.radii[i] * trackThickness(muscle.spheres, at, i);
        farthest =
            std::max(farthest, (centre - placed.centres[i]).norm() + std::abs(radius - placed.radii[i]));
        placed.centres[i] = centre;
        placed.radii[i] = radius;
    }
    placed.path += farthest;
}

void place(const SkinMuscle& muscle, double activation, const Pose& pose, PlacedMuscle& placed) {
    if (placed.activation == activation && placed.pose.matrix() == pose.matrix()) return;
    placed.activation = activation;
    placed.pose = pose;
    placed.dragPlace = locate(muscle.drag.nodes, activation);
    const Pose* moved = isIdentity(pose) ? nullptr : &pose;
    follow(muscle.surface, activation, moved, placed.surface);
    findNormals(muscle.triangles, placed);
    placeSpheres(muscle, activation, moved, placed);
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

/// Of the predicted skin.
Vec3 predictedNormal(const SkinRig& rig, const SkinScene& scene, const SurfacePoint& at) {
    Vec3 smooth = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
        const auto v = static_cast<std::uint32_t>(rig.triangles[at.triangle][k]);
        smooth += at.weights[k] * scene.turn.turned(v, rig.restNormals[v]);
    }
    return smooth.normalized();
}

} // namespace

void placeMuscles(const SkinRig& rig, std::span<const double> activations, std::span<const Pose> poses,
                  SkinScene& scene) {
    scene.muscles.resize(rig.muscles.size());
    scene.drag.assign(rig.rest.size(), Move::Zero());
    scene.turn.clear();
    for (std::size_t m = 0; m < rig.muscles.size(); ++m) {
        const SkinMuscle& muscle = rig.muscles[m];
        place(muscle, activations[m], poses[m], scene.muscles[m]);
        addDrag(muscle.drag, scene.muscles[m].dragPlace, scene.drag);
        if (isIdentity(poses[m])) continue;
        const TrackPlace at = locate(muscle.skin.nodes, activations[m]);
        const Eigen::Quaterniond rotation(poses[m].linear());
        for (std::size_t i = 0; i < muscle.carried.size(); ++i) {
            const Vec3 x = trackPosition(muscle.skin, at, i);
            const SkinCarry& c = muscle.carried[i];
            scene.drag[c.vertex].head<3>() += c.pull * (poses[m] * x - x).cast<float>();
            scene.turn.add(rig.rest.size(), c.vertex, static_cast<double>(c.pull), rotation);
        }
    }
    scene.turn.normalise();
    scene.predicted.resize(rig.rest.size());
    for (std::size_t v = 0; v < rig.rest.size(); ++v)
        scene.predicted[v] = rig.rest[v] + scene.drag[v].head<3>().cast<double>();
}

SkinContact rowContact(const SkinRig& rig, const SkinScene& scene, std::size_t index) {
    const SkinRow& row = rig.rows[index];
    const SkinMuscle& muscle = rig.muscles[row.muscle];
    const PlacedMuscle& placed = scene.muscles[row.muscle];
    Vec3 x = scene.predicted[row.vertex];
    if (row.restTriangle >= 0) {
        const Tri& corners = muscle.triangles[row.restTriangle];
        Vec3 carried = Vec3::Zero(), normal = Vec3::Zero();
        for (int k = 0; k < 3; ++k) {
            carried += row.restWeights[k] * placed.surface[corners[k]];
            normal += row.restWeights[k] * placed.normals[corners[k]];
        }
        carried += row.restHeight * normal.normalized();
        const Vec3 slid = x - carried;
        const double far = slid.norm(), most = lookSlide * row.radius;
        if (far > most) x = carried + most / far * slid;
    }
    const double limit = row.radius + std::max(rig.travel, row.radius);
    SkinContact contact;
    // The spheres select: whether anything is near, and where to look when the skin was not before it at any
    // node of the muscle's own motion.
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = 0;
    for (std::uint32_t k = row.first; k < row.last; ++k) {
        const std::uint32_t sphere = rig.tests[k].sphere;
        const double squared = (x - placed.centres[sphere]).squaredNorm(),
                     within = least + placed.radii[sphere];
        if (!(squared < within * within)) continue;
        least = std::sqrt(squared) - placed.radii[sphere];
        nearest = sphere;
        if (row.met && least <= limit) break;
    }
    if (least > limit) {
        contact.clear = least - limit;
        return contact;
    }
    const int start =
        row.met ? startAt(&rig.rowTriangles[row.triangles], placed.dragPlace) : muscle.behind[nearest];
    if (start < 0) return contact;

    const auto at = [&](int v) -> const Vec3& { return placed.surface[v]; };
    const SurfacePoint hit = walkDownhill(x, start, muscle.triangles, muscle.across, at, walkSteps);
    const Tri& corners = muscle.triangles[hit.triangle];
    Vec3 smooth = Vec3::Zero();
    for (int k = 0; k < 3; ++k) smooth += hit.weights[k] * placed.normals[corners[k]];
    smooth.normalize();
    contact.trust = trust(smooth.dot(placed.pose.linear() * row.facing));
    if (!(contact.trust > 0)) return contact;
    contact.triangle = hit.triangle;
    contact.weights = hit.weights;
    contact.normal = pushDirection(smooth, x - hit.point, row.radius);
    for (std::uint32_t& v : contact.vertex) v = row.vertex;
    contact.weight[0] = 1;
    contact.vertices = 1;
    contact.distance = contact.normal.dot(rig.rest[row.vertex] - hit.point);
    return contact;
}

SkinContact pokeContact(const SkinRig& rig, const SkinScene& scene, std::size_t index) {
    const SkinPoke& poke = rig.pokes[index];
    const PlacedMuscle& muscle = scene.muscles[poke.muscle];
    const Vec3& x = muscle.surface[poke.vertex];
    SkinContact contact;
    const int start = startAt(&rig.pokeTriangles[poke.triangles], muscle.dragPlace);
    if (start < 0) return contact;

    const auto at = [&](int v) -> const Vec3& { return scene.predicted[v]; };
    const SurfacePoint hit = walkDownhill(x, start, rig.triangles, rig.across, at, walkSteps);
    const Tri& corners = rig.triangles[hit.triangle];
    const Vec3 smooth = predictedNormal(rig, scene, hit);
    contact.trust = trust(smooth.dot(muscle.normals[poke.vertex]));
    if (!(contact.trust > 0)) return contact;
    contact.triangle = hit.triangle;
    contact.weights = hit.weights;
    contact.normal =
        pushDirection((smooth + muscle.normals[poke.vertex]).normalized(), hit.point - x, poke.radius);
    Vec3 onSkin = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
        contact.vertex[k] = static_cast<std::uint32_t>(corners[k]);
        contact.weight[k] = hit.weights[k];
        onSkin += hit.weights[k] * rig.rest[corners[k]];
    }
    contact.distance = contact.normal.dot(onSkin - x);
    return contact;
}

SkinContact foldContact(const SkinRig& rig, const SkinScene& scene, std::size_t index) {
    const SkinFold& fold = rig.folds[index];
    const Vec3& x = scene.predicted[fold.vertex];
    SkinContact contact;
    double least = rig.foldReach * rig.foldReach;
    int start = -1;
    for (std::uint32_t k = fold.first; k < fold.last; ++k) {
        const auto triangle = static_cast<int>(rig.foldTriangles[k]);
        const double squared = (x - scene.predicted[rig.triangles[triangle][0]]).squaredNorm();
        if (squared >= least) continue;
        least = squared;
        start = triangle;
    }
    if (start < 0) return contact;

    const auto at = [&](int v) -> const Vec3& { return scene.predicted[v]; };
    const SurfacePoint hit = walkDownhill(x, start, rig.triangles, rig.across, at, walkSteps);
    const Tri& corners = rig.triangles[hit.triangle];
    // Around a fold's end the walk comes to the vertex itself.
    if ((corners.array() == static_cast<int>(fold.vertex)).any()) return contact;
    const Vec3 smooth = predictedNormal(rig, scene, hit);
    const Vec3 own = scene.turn.turned(fold.vertex, rig.restNormals[fold.vertex]);
    contact.trust = trust(-smooth.dot(own));
    if (!(contact.trust > 0)) return contact;
    const Vec3 between = (smooth - own).normalized(), away = x - hit.point;
    const Vec3 normal = pushDirection(between, away, rig.foldRadius);
    // Beside the other part's rim there is nothing to keep out of.
    const double depth = normal.dot(away), beside = (away - depth * normal).norm() / rig.foldRadius;
    contact.trust *= 1 - smoothStep(beside - 1);
    if (!(contact.trust > 0)) return contact;
    int nearest = 0;
    hit.weights.maxCoeff(&nearest);
    const auto other = static_cast<std::uint32_t>(corners[nearest]);
    contact.triangle = hit.triangle;
    contact.weights = hit.weights;
    contact.normal = normal;
    contact.vertex[0] = contact.vertex[2] = fold.vertex;
    contact.vertex[1] = other;
    contact.weight[0] = 1;
    contact.weight[1] = -1;
    contact.vertices = 2;
    contact.distance =
        depth - normal.dot((x - rig.rest[fold.vertex]) - (scene.predicted[other] - rig.rest[other]));
    return contact;
}

} // namespace tss
