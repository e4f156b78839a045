#include "bake/play/BelowSkin.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// How deep a point of a shape's frame is in the shape, 0 outside.
double depthIn(const Solid& solid, const Vec3& x, DepthMemory::Side* known) {
    const bool same = known && (x - known->place).norm() < known->free;
    const bool inside = same ? known->inside : solid.inside(x);
    if (!inside && (same || !known)) return 0;
    const double distance = solid.boundary().distance(x);
    constexpr double rounded = 0.999;
    if (known && !same) *known = {x, rounded * distance, inside};
    return inside ? distance : 0;
}

/// How far the vertices of a closed mesh are from those of another of the same triangles, at most: between
/// the two no surface passes farther. Infinity: the two are not to be compared.
double farthestMove(const Solid& from, const Solid& to) {
    const TriangleMesh &before = from.mesh(), &now = to.mesh();
    if (from.open() || to.open() || before.triangles != now.triangles) return infinity;
    double squared = 0;
    for (std::size_t v = 0; v < now.vertices.size(); ++v)
        squared = std::max(squared, (now.vertices[v] - before.vertices[v]).squaredNorm());
    return std::sqrt(squared);
}

/// Brings what is remembered of a shape to where it is now.
void renew(DepthMemory::Shape& memory, const std::shared_ptr<const Solid>& solid, std::size_t points) {
    if (memory.solid == solid && memory.sides.size() == points) return;
    const double moved = memory.solid ? farthestMove(*memory.solid, *solid) : infinity;
    memory.sides.resize(points);
    for (DepthMemory::Side& side : memory.sides) side.free -= moved;
    memory.solid = solid;
}

} // namespace

std::vector<double> ShapesBelow::depths(std::span<const Vec3> points, DepthMemory* memory) const {
    if (memory) memory->shapes.resize(shapes_.size());
    for (std::size_t k = 0; memory && k < shapes_.size(); ++k)
        renew(memory->shapes[k], shapes_[k].solid, points.size());
    std::vector<double> deepest(points.size(), 0.0);
    parallelFor(points.size(), [&](std::size_t i) {
        for (std::size_t k = 0; k < shapes_.size(); ++k) {
            const auto& [solid, box, toShape] = shapes_[k];
            if (const Vec3 x = toShape * points[i]; box.contains(x))
                deepest[i] =
                    std::max(deepest[i], depthIn(*solid, x, memory ? &memory->shapes[k].sides[i] : nullptr));
        }
    });
    return deepest;
}

BelowSkin::BelowSkin(std::vector<std::shared_ptr<const MuscleDeformer>> muscles,
                     const std::vector<UnderSkin>& under)
    : muscles_(std::move(muscles)), bones_(muscles_.size()) {
    for (const UnderSkin& one : under) chains_.push_back(one.chain);
    for (std::size_t m = 0; m < muscles_.size(); ++m) {
        shapes_.emplace_back(*muscles_[m]);
        const TriangleMesh& surface = muscles_[m]->muscle().surface;
        if (muscles_[m]->rigid() && chains_[m].empty() && !surface.empty())
            bones_[m] = std::make_shared<const Solid>(surface);
    }
}

std::vector<Vec3> BelowSkin::vertices(std::size_t m, std::span<const double> activations,
                                      std::span<const Pose> poses) const {
    return shapes_[m].vertices(activations[m],
                               poses.empty() ? ChainMotion() : chainMotion(poses, m, chains_[m]));
}

ShapesBelow BelowSkin::at(std::span<const double> activations, std::span<const Pose> poses,
                          const DepthMemory& memory) const {
    ShapesBelow below;
    for (std::size_t m = 0; m < muscles_.size(); ++m) {
        const TriangleMesh& surface = muscles_[m]->muscle().surface;
        if (surface.empty()) continue; // it moves skin and has no shape
        std::shared_ptr<const Solid> solid = bones_[m];
        if (!solid) {
            TriangleMesh mesh{vertices(m, activations, poses), surface.triangles};
            const std::size_t k = below.shapes_.size();
            if (k < memory.shapes.size() && memory.shapes[k].solid->mesh().vertices == mesh.vertices)
                solid = memory.shapes[k].solid;
            else
                solid = std::make_shared<const Solid>(mesh);
        }
        below.shapes_.push_back(
            {solid, bounds(solid->mesh()), poses.empty() ? Pose::Identity() : Pose(poses[m].inverse())});
    }
    return below;
}

} // namespace tss
