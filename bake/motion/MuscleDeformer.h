#pragma once
#include "bake/motion/ClosestPointQuery.h"
#include "bake/motion/Muscle.h"
#include "bake/motion/MuscleFibre.h"
#include "bake/motion/MuscleRing.h"

#include <optional>

namespace tss {

/// A point bound to a muscle: what map() needs, found once by bind().
struct MusclePoint {
    Vec3 rest;                  ///< at activation 0
    double s = 0;               ///< fibre parameter
    Vec3 offset = Vec3::Zero(); ///< part of its position that thickening scales, scene units: from the fibre
                                ///< line (tube, ring) or medial surface (sheet) to the surface
    Vec3 normal = Vec3::Zero(); ///< outward, of the nearest surface
    double height = 0;          ///< above the surface, negative inside, scene units
    double share = 0;           ///< place along the bones, see Muscle::chainShares
};

/// A muscle at one activation.
struct MuscleState {
    double activation = 0;
    double thickening = 1; ///< factor on the local thickening that keeps the volume of the mesh; near 1
};

/// A muscle that never contracts and lies on one bone is a bone: its surface may be any mesh, its fibre is
/// not looked at.
inline bool isRigid(const Muscle& muscle) {
    if (muscle.spans) return false;
    return muscle.maxContraction == 0 || (muscle.activationLower == 0 && muscle.activationUpper == 0);
}

/// The deformation of a muscle by its activation a (METHOD 6.1), exact and without history:
///   x(a) = x + C(s') - C(s) + k(a) (g(s, a) - 1) o(x),   s' = s - a c_max (I(s) - I(s_anchor))
/// C is the fibre, I the integral of a bump with smooth ends, g the factor that makes up for the local
/// shortening 1 - a c_max I'(s): its inverse across a sheet, the square root of that about a tube. A ring
/// narrows instead: C(s') - C(s) is -a c_max times the way from its axis to C(s), its local shortening
/// 1 - a c_max. k is solved so that the volume enclosed by the mesh is kept to rounding. a = 0 gives the rest
/// shape bit for bit; a < 0 stretches.
class MuscleDeformer {
public:
    /// Throws InputError: a flat or inside-out surface of what is not rigid, or one with large openings, a
    /// shell of it that is inside out, a bad fibre, a contraction that would turn the muscle over within its
    /// activation range, take a ring through its own middle, or leave it none with the volume at rest.
    explicit MuscleDeformer(Muscle muscle);
    MuscleDeformer(const MuscleDeformer&) = delete;
    MuscleDeformer& operator=(const MuscleDeformer&) = delete;

    const Muscle& muscle() const { return muscle_; }
    /// Nothing about it moves by itself: a bone.
    bool rigid() const { return isRigid(muscle_); }
    const MuscleFibre& fibre() const { return fibre_; } ///< not of a ring
    double restVolume() const { return volume_; }
    /// Those of the surface, then those that close its openings: what the volume is enclosed by.
    const std::vector<Tri>& closedTriangles() const { return closed_; }

    /// a is clamped to the muscle's activation range; NaN counts as 0.
    MuscleState state(double activation) const;

    /// #V surface vertices at an activation.
    std::vector<Vec3> vertices(const MuscleState& state) const;
    std::vector<Vec3> vertices(double activation) const { return vertices(state(activation)); }

    /// #V: the surface vertices, bound.
    const std::vector<MusclePoint>& surfacePoints() const { return points_; }

    /// Binds any point: inside the muscle it thickens with it, outside it keeps its offset to the surface.
    MusclePoint bind(const Vec3& rest) const;
    Vec3 map(const MusclePoint& point, const MuscleState& state) const;
    Vec3 map(const Vec3& rest, double activation) const { return map(bind(rest), state(activation)); }

    /// Local factor of the thickness at a fibre parameter: what the radius of a sphere inside grows by.
    double thickness(double s, const MuscleState& state) const;

    /// Where along the bones a point goes: as the nearest point of the surface.
    double chainShare(const Vec3& rest) const;
    const std::vector<double>& chainShares() const { return shares_; } ///< #V

    /// How much of the muscle's shortening lies before a point, from 0 at the origin to 1 at the insertion;
    /// of a ring its place along its bones.
    double alongShare(const MusclePoint& point) const {
        return ring_ ? point.share : contractionIntegral(point.s);
    }

private:
    double parameter(const Vec3& x) const { return ring_ ? ring_->parameter(x) : fibre_.parameter(x); }
    Vec3 linePoint(double s) const { return ring_ ? ring_->point(s) : fibre_.point(s); }
    /// Displacement along the fibre, of a ring towards its axis: C(s') - C(s).
    Vec3 shiftAt(const MusclePoint& point, double activation) const;
    double thickeningGain(double s, double activation) const; ///< g(s, a) - 1
    bool isValidAt(double activation) const;
    /// Throws InputError that says how far a ring may contract. end: of its activation range.
    [[noreturn]] void throwTooShort(double end) const;

    Muscle muscle_;
    std::optional<MuscleRing> ring_;
    MuscleFibre fibre_;
    ClosestPointQuery locator_;
    std::vector<Tri> closed_;         ///< see closedTriangles()
    std::vector<Vec3> normals_;       ///< #V
    std::vector<MusclePoint> points_; ///< #V
    std::vector<double> shares_;      ///< #V, see Muscle::chainShares
    double anchorIntegral_ = 0;
    double volume_ = 0;
};

} // namespace tss
