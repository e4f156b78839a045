#pragma once
#include "bake/motion/MuscleDeformer.h"
#include "bake/motion/PoseBlend.h"

#include <memory>
#include <span>

namespace tss {

/// A muscle between two bones (METHOD 6.1): each vertex moves by the dual quaternion blend of both bones'
/// motions, with its MuscleDeformer::insertionShare() as weight. Blending alone changes the volume; it is
/// restored by displacing vertices along swelling(), all scaled by one factor. swelling() vanishes at both
/// ends.
class MuscleSpan {
public:
    /// unit: scene units per length of what carry() is given.
    explicit MuscleSpan(const MuscleDeformer& muscle, double unit = 1);

    /// The factor on swelling() that restores the volume. places: #V, vertices at the muscle's activation, in
    /// the frame of the origin's bone. far: motion of the insertion's bone since rest, in that frame.
    double swell(const Pose& far, std::span<const Vec3> places) const;

    /// Deforms the places and turns their normals accordingly. Returns swell(). Where `far` is the identity
    /// nothing changes by a bit.
    double carry(const Pose& far, std::span<Vec3> places, std::span<Vec3> normals = {}) const;

    /// #V, lengths as given to carry(): displacements away from the medial surface, whatever the muscle's
    /// form.
    const std::vector<Vec3>& swelling() const { return swelling_; }

private:
    std::vector<Pose> posesAt(const Pose& far) const;
    double swell(const std::vector<Pose>& poses, std::span<const Vec3> places) const;

    std::vector<Tri> closed_;     ///< MuscleDeformer::closedTriangles()
    Eigen::Vector4d side_;        ///< Muscle::side
    std::vector<double> shares_;  ///< #V, of the insertion's bone
    std::vector<Vec3> gradients_; ///< #V, gradient of the shares along the surface, per length
    std::vector<Vec3> swelling_;
    double slope_ = 0; ///< derivative of six times the volume by the factor on swelling_, at rest
};

/// The shape of a muscle at any activation, wherever its bones are.
class MuscleShape {
public:
    /// Keeps a reference to the muscle.
    explicit MuscleShape(const MuscleDeformer& muscle);

    /// In the frame of its origin's bone. far: see MuscleSpan::carry(); of a muscle that does not span,
    /// nothing.
    std::vector<Vec3> vertices(double activation, const Pose& far) const;

private:
    const MuscleDeformer* muscle_;
    std::shared_ptr<const MuscleSpan> span_; ///< null for one that does not span
};

} // namespace tss
