#include "bake/play/BelowSkin.h"

#include "bake/base/Parallel.h"
#include "bake/motion/BoneSwing.h"
#include "bake/motion/MuscleSpan.h"

#include <algorithm>

namespace tss {

std::vector<double> ShapesBelow::depths(std::span<const Vec3> points) const {
    std::vector<double> deepest(points.size(), 0.0);
    parallelFor(points.size(), [&](std::size_t i) {
        for (const auto& [solid, box, toShape] : shapes_)
            if (const Vec3 x = toShape * points[i]; box.contains(x) && solid->inside(x))
                deepest[i] = std::max(deepest[i], solid->boundary().distance(x));
    });
    return deepest;
}

BelowSkin::BelowSkin(std::vector<std::shared_ptr<const MuscleDeformer>> muscles,
                     const std::vector<UnderSkin>& under)
    : muscles_(std::move(muscles)), bones_(muscles_.size()) {
    for (const UnderSkin& one : under) insertions_.push_back(one.insertion);
    for (std::size_t m = 0; m < muscles_.size(); ++m) {
        const TriangleMesh& surface = muscles_[m]->muscle().surface;
        if (muscles_[m]->rigid() && insertions_[m] < 0 && !surface.empty())
            bones_[m] = std::make_shared<const Solid>(surface);
    }
}

std::vector<Vec3> BelowSkin::vertices(std::size_t m, std::span<const double> activations,
                                      std::span<const Pose> poses) const {
    const bool spans = insertions_[m] >= 0 && !poses.empty();
    return verticesBetween(*muscles_[m], activations[m],
                           spans ? between(poses[m], poses[insertions_[m]]) : Pose::Identity());
}

ShapesBelow BelowSkin::at(std::span<const double> activations, std::span<const Pose> poses) const {
    ShapesBelow below;
    for (std::size_t m = 0; m < muscles_.size(); ++m) {
        const TriangleMesh& surface = muscles_[m]->muscle().surface;
        if (surface.empty()) continue; // it moves skin and has no shape
        std::shared_ptr<const Solid> solid = bones_[m];
        if (!solid)
            solid = std::make_shared<const Solid>(
                TriangleMesh{vertices(m, activations, poses), surface.triangles});
        below.shapes_.push_back(
            {solid, bounds(solid->mesh()), poses.empty() ? Pose::Identity() : Pose(poses[m].inverse())});
    }
    return below;
}

} // namespace tss
