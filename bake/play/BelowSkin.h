#pragma once
#include "bake/geometry/Solid.h"
#include "bake/model/UnderSkin.h"
#include "bake/motion/MuscleSpan.h"

#include <memory>
#include <span>

namespace tss {

/// What is kept from step to step of points that are asked for again and again: a point that has moved less
/// within a shape than it was away from its surface is on the same side of it.
struct DepthMemory {
    struct Side {
        Vec3 place = Vec3::Zero(); ///< in the shape's frame, when it was last looked for
        double free = 0;           ///< it may move so far from there; not above 0: to be looked for anew
        bool inside = false;
    };
    struct Shape {
        std::shared_ptr<const Solid> solid;
        std::vector<Side> sides; ///< one per point
    };
    std::vector<Shape> shapes; ///< one per shape below the skin
};

/// The muscles and bones below a skin in one place: how deep points of the skin are in them.
class ShapesBelow {
public:
    /// How deep each point, in the skin's frame, is in the shape that it is deepest in; 0: outside of all.
    /// memory: of the same points, for any shapes; the answer is the same without.
    std::vector<double> depths(std::span<const Vec3> points, DepthMemory* memory = nullptr) const;

private:
    friend class BelowSkin;
    struct Shape {
        std::shared_ptr<const Solid> solid;
        Eigen::AlignedBox3d box;
        Pose toShape; ///< from the skin's frame
    };
    std::vector<Shape> shapes_;
};

/// The muscles and bones below a skin, wherever they have moved. activations: one per muscle or bone. poses:
/// the motion of each since rest, in the skin's frame; empty: none has moved.
class BelowSkin {
public:
    /// muscles: skinMuscles().
    BelowSkin(std::vector<std::shared_ptr<const MuscleDeformer>> muscles,
              const std::vector<UnderSkin>& under);

    const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles() const { return muscles_; }

    /// The vertices of one, in the frame of its bone.
    std::vector<Vec3> vertices(std::size_t muscle, std::span<const double> activations,
                               std::span<const Pose> poses) const;

    /// memory: of an earlier step, whose shapes serve again where they have not changed.
    ShapesBelow at(std::span<const double> activations, std::span<const Pose> poses,
                   const DepthMemory& memory = {}) const;

private:
    std::vector<std::shared_ptr<const MuscleDeformer>> muscles_;
    std::vector<MuscleShape> shapes_;                 ///< of each
    std::vector<std::vector<int>> chains_;            ///< of each: see UnderSkin
    std::vector<std::shared_ptr<const Solid>> bones_; ///< of each whose shape never changes; else null
};

} // namespace tss
