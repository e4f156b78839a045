#include "bake/respond/SkinWatch.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Of the distance from pushing, how far a point and what it met may move against each other, along the
/// plane's normal: the normal turns, too.
constexpr float mostAlong = 0.5f;
/// What a move beside the normal counts: surfaces hardly rise by more than half of what they slide.
constexpr float beside = 0.5f;

Eigen::Vector3f placeFrom(const Vec3& x, const std::vector<Tri>& triangles, const std::vector<Vec3>& points,
                          int triangle, const Eigen::Vector3f& weights) {
    if (triangle < 0) return x.cast<float>();
    const Tri& corners = triangles[triangle];
    Vec3 met = Vec3::Zero();
    for (int k = 0; k < 3; ++k) met += static_cast<double>(weights[k]) * points[corners[k]];
    return (x - met).cast<float>();
}

/// Of the point that a contact looks up, from that point of `triangle`; or, where this is -1, its own.
Eigen::Vector3f placeOf(const SkinRig& rig, const SkinScene& scene, std::size_t contact, int triangle,
                        const Eigen::Vector3f& weights) {
    const std::size_t rows = rig.rows.size(), pokes = rows + rig.pokes.size();
    if (contact < rows) {
        const SkinRow& row = rig.rows[contact];
        return placeFrom(scene.predicted[row.vertex], rig.muscles[row.muscle].triangles,
                         scene.muscles[row.muscle].surface, triangle, weights);
    }
    const Vec3* x = nullptr;
    if (contact < pokes) {
        const SkinPoke& poke = rig.pokes[contact - rows];
        x = &scene.muscles[poke.muscle].surface[poke.vertex];
    } else {
        x = &scene.predicted[rig.folds[contact - pokes].vertex];
    }
    return placeFrom(*x, rig.triangles, scene.predicted, triangle, weights);
}

/// PlacedMuscle::path of a row's muscle.
double pathOf(const SkinRig& rig, const SkinScene& scene, std::size_t row) {
    return scene.muscles[rig.rows[row].muscle].path;
}

} // namespace

SkinWatch::SkinWatch(const SkinRig& rig) : seen_(rig.rows.size() + rig.pokes.size() + rig.folds.size()) {}

void SkinWatch::forget() {
    std::fill(seen_.begin(), seen_.end(), Seen{});
}

bool SkinWatch::due(const SkinRig& rig, const SkinScene& scene, std::size_t contact, float slack) const {
    const Seen& seen = seen_[contact];
    const bool met = seen.triangle >= 0;
    if (!((met ? slack : seen.clear) > 0)) return true;
    const Eigen::Vector3f by = placeOf(rig, scene, contact, seen.triangle, seen.weights) - seen.place;
    if (!met) {
        const auto path = static_cast<float>(pathOf(rig, scene, contact) - seen.path);
        return !(by.norm() + path < seen.clear);
    }
    const float along = std::abs(by.dot(seen.normal));
    const float across = std::sqrt(std::max(0.0f, by.squaredNorm() - along * along));
    return !(along + beside * across < mostAlong * slack);
}

void SkinWatch::note(const SkinRig& rig, const SkinScene& scene, std::size_t contact,
                     const SkinContact& found) {
    Seen& seen = seen_[contact];
    seen = {};
    if (found.found()) {
        seen.triangle = found.triangle;
        seen.weights = found.weights.cast<float>();
        seen.normal = found.normal.cast<float>();
    } else if (found.clear > 0) {
        seen.clear = static_cast<float>(found.clear);
        seen.path = pathOf(rig, scene, contact);
    }
    seen.place = placeOf(rig, scene, contact, seen.triangle, seen.weights);
}

} // namespace tss
