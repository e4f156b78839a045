#pragma once
#include "bake/geometry/Solid.h"
#include "bake/model/SceneModel.h"
#include "bake/motion/MuscleDeformer.h"

#include <memory>
#include <span>

namespace tss {

/// The muscles and bones below a skin in one place: how deep points of the skin are in them.
class ShapesBelow {
public:
    /// How deep each point, in the skin's frame, is in the shape that it is deepest in; 0: outside of all.
    std::vector<double> depths(std::span<const Vec3> points) const;

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

    ShapesBelow at(std::span<const double> activations, std::span<const Pose> poses) const;

private:
    std::vector<std::shared_ptr<const MuscleDeformer>> muscles_;
    std::vector<int> insertions_;                     ///< of each: see UnderSkin
    std::vector<std::shared_ptr<const Solid>> bones_; ///< of each whose shape never changes; else null
};

} // namespace tss
