#pragma once
#include "bake/geometry/MeshQuery.h"
#include "bake/geometry/Solid.h"
#include "bake/motion/Motion.h"
#include "bake/table/Table.h"

#include <memory>
#include <optional>

namespace adversary {

using tss::Pose;
using tss::TriangleMesh;

/// A mesh in two: what is exempt at rest and all else, triangles without area among both.
struct SplitSurface {
    TriangleMesh exempt, other;
    double exemptShare = 0; ///< of the area
};
SplitSurface split(const TriangleMesh& mesh, const std::vector<tss::SurfacePart>& parts);

/// What is so, by FCL, where it can be asked; by distances of triangles for those without area, and as a
/// second opinion before anything is called a failure. Knows nothing of spheres.
class Surfaces {
public:
    Surfaces(const TriangleMesh& a, const TriangleMesh& b, const tss::RestRegion& region);
    ~Surfaces();

    /// The surfaces have a common point, one of a part that is exempt with another such excepted.
    bool meet(const Pose& pose) const;

    /// meet() is so to rounding by distances too: nothing else counts against a table.
    bool surelyMeet(const Pose& pose) const;

    /// Least distance, exempt pairs excepted.
    double clearance(const Pose& pose) const;

    /// Least distance of the whole surfaces.
    double distance(const Pose& pose) const;
    /// distance() is at least so much: quicker.
    bool apart(const Pose& pose, double distance) const;
    /// The same by FCL alone; for surfaces without triangles without area.
    double distanceByFcl(const Pose& pose) const;

    /// Where a mesh has openings its filling may count as body: the boundaries with their fans are nearer
    /// than `within`. What stands behind an opening as a whole, away from all of them, is no such case.
    bool fillingsNear(const Pose& pose, double within) const;

    /// How far calculating with coordinates of this size at this pose may be off, scene units.
    double rounding(const Pose& pose) const;

    double size() const { return size_; } ///< largest coordinate
    double exemptShareA() const { return shareA_; }
    double exemptShareB() const { return shareB_; }

private:
    struct Side;
    struct Part;
    bool meet(const Part& a, const Part& b, const Pose& pose) const;

    std::unique_ptr<Side> a_, b_;
    double shareA_ = 0, shareB_ = 0, size_ = 0;
};

} // namespace adversary
