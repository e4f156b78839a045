#pragma once
#include "bake/motion/MuscleDeformer.h"
#include "bake/motion/PoseBlend.h"

#include <span>

namespace tss {

/// A muscle between two bones (METHOD 6.1): each point moves with the blend of their motions by its
/// MuscleDeformer::insertionShare(). Blending changes the volume; to keep it, the part that moves with both
/// bones becomes thicker or thinner, all of it by one factor, and the parts that move with one bone stay as
/// they are.
class MuscleSpan {
public:
    /// unit: scene units per length of what carry() is given.
    explicit MuscleSpan(const MuscleDeformer& muscle, double unit = 1);

    /// How much it swells: the factor on swelling(). places: #V, as the muscle's activation has them,
    /// in the frame of the origin's bone. far: the motion of the insertion's bone since rest, in that frame.
    double swell(const Pose& far, std::span<const Vec3> places) const;

    /// Moves the places, and turns their normals with them. Returns swell(). far at rest: nothing, bit for
    /// bit.
    double carry(const Pose& far, std::span<Vec3> places, std::span<Vec3> normals = {}) const;

    /// #V: away from the medial surface, whatever the muscle's form.
    const std::vector<Vec3>& swelling() const { return swelling_; }

private:
    std::vector<Pose> posesAt(const Pose& far) const;
    double swell(const std::vector<Pose>& poses, std::span<const Vec3> places) const;

    std::vector<Tri> triangles_;
    Eigen::Vector4d side_;        ///< Muscle::side
    std::vector<double> shares_;  ///< #V, of the insertion's bone
    std::vector<Vec3> gradients_; ///< #V, of the shares along the surface, per length
    std::vector<Vec3> swelling_;
    double slope_ = 0; ///< of six times the volume by the factor on swelling_, at rest
};

/// The vertices of a muscle, in the frame of its origin's bone. far: see MuscleSpan::carry(); of a muscle
/// that does not span, nothing.
std::vector<Vec3> verticesBetween(const MuscleDeformer& muscle, double activation, const Pose& far);

} // namespace tss
