#pragma once
#include "bake/motion/BoneChain.h"
#include "bake/motion/MuscleDeformer.h"

#include <memory>
#include <span>

namespace tss {

/// A muscle over two or more bones (METHOD 6.1): each vertex moves by the dual quaternion blend of the two
/// bones beside its MuscleDeformer::chainShare(). Blending alone changes the volume; it is restored by
/// displacing vertices along swelling(), all scaled by one factor. swelling() vanishes at both ends.
class MuscleSpan {
public:
    /// unit: scene units per length of what carry() is given.
    explicit MuscleSpan(const MuscleDeformer& muscle, double unit = 1);

    /// The factor on swelling() that restores the volume. bones: how those behind the origin's have moved.
    /// places: #V, vertices at the muscle's activation, in the frame of the origin's bone.
    double swell(const ChainMotion& bones, std::span<const Vec3> places) const;

    /// Deforms the places and turns their normals accordingly. Returns swell(). Where no bone has moved
    /// nothing changes by a bit.
    double carry(const ChainMotion& bones, std::span<Vec3> places, std::span<Vec3> normals = {}) const;

    /// #V, lengths as given to carry(): displacements away from the medial surface, whatever the muscle's
    /// form.
    const std::vector<Vec3>& swelling() const { return swelling_; }

private:
    std::vector<Pose> posesBy(const ChainBlend& blend) const;
    double swellBy(const std::vector<Pose>& poses, std::span<const Vec3> places) const;

    std::vector<Tri> closed_;            ///< MuscleDeformer::closedTriangles()
    std::vector<Eigen::Vector4d> sides_; ///< Muscle::sides
    std::vector<double> shares_;         ///< #V, Muscle::chainShares
    std::vector<Vec3> gradients_;        ///< #V, gradient of the shares along the surface, per length
    std::vector<Vec3> swelling_;
    double slope_ = 0; ///< derivative of six times the volume by the factor on swelling_, at rest
};

/// The shape of a muscle at any activation, wherever its bones are.
class MuscleShape {
public:
    /// Keeps a reference to the muscle.
    explicit MuscleShape(const MuscleDeformer& muscle);

    /// In the frame of its origin's bone. bones: see MuscleSpan::carry(); of a muscle on one bone, none.
    std::vector<Vec3> vertices(double activation, const ChainMotion& bones) const;

private:
    const MuscleDeformer* muscle_;
    std::shared_ptr<const MuscleSpan> span_; ///< null for one on one bone
};

} // namespace tss
