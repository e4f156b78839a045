#pragma once
#include "bake/base/Infinity.h"
#include "bake/geometry/Bvh.h"

namespace tss {

/// The nearest point of a mesh.
struct ClosestPoint {
    Vec3 point = Vec3::Zero();
    double distance = infinity; ///< infinity: nothing within the limit asked
    int triangle = -1;
};

/// Distance and inside queries of a triangle mesh, in double precision throughout and recentred on the
/// mesh, so that the distance is right to rounding for meshes 1e7 units from the origin or 1e-6 in size.
/// Keeps a copy of the triangles; immutable, so that threads may share one.
class MeshQuery {
public:
    /// Throws InputError as checkIndices() does. An empty list of triangles is allowed: nothing is ever near.
    /// closed: triangles with an area run through every edge equally often in both directions.
    explicit MeshQuery(const TriangleMesh& mesh, bool closed = false);

    std::size_t triangleCount() const { return corners_.size(); }

    /// A ball that holds the mesh.
    const Vec3& centre() const { return origin_; }
    double radius() const {
        return bvh_.empty() ? 0
                            : bvh_.nodes[0].lower.cwiseAbs().cwiseMax(bvh_.nodes[0].upper.cwiseAbs()).norm();
    }

    /// No point of the mesh is farther from the origin of its frame.
    double extent() const { return bvh_.empty() ? 0 : origin_.norm() + radius(); }

    /// The nearest point of the mesh to p, if it is nearer than `within`.
    ClosestPoint closest(const Vec3& p, double within = infinity) const;

    /// Whether some point of the mesh is nearer to p than `within`: closest() without the answer to which, at
    /// a fraction of the time where the mesh is well within.
    bool comesWithin(const Vec3& p, double within) const;

    /// Distance from p to the mesh, or infinity where it is not below `within`.
    double distance(const Vec3& p, double within = infinity) const { return closest(p, within).distance; }

    /// The generalised winding number of the mesh about p: 1 inside a closed mesh, 2 where two closed
    /// components overlap, 0 outside, -1 in an inverted mesh, a fraction about an open one (Jacobson 2013).
    /// Of a mesh known to be closed what two rays say, where they agree. Else far triangles count by their
    /// dipole (Barill 2018), nearer ones too where a ray says that this is right: many shells on one another
    /// add up to much. What is neither is summed exactly.
    double windingNumber(const Vec3& p) const;

    /// |winding number| >= 1/2: inside the union of the components, whichever way they are oriented.
    bool inside(const Vec3& p) const;

    /// The least distance of the surfaces, the other mesh moved into this one's frame: 0 where they cross,
    /// infinity where it is not below `within`. Right to rounding.
    double distanceTo(const MeshQuery& other, const Eigen::Isometry3d& otherToThis,
                      double within = infinity) const;

    /// An estimate of distanceTo(), at a fraction of its time where the surfaces are far apart: the distance
    /// of some two points, no more than a twentieth above the least.
    double roughDistanceTo(const MeshQuery& other, const Eigen::Isometry3d& otherToThis) const;

    /// The surfaces are shown to stay at least `distance` away from each other, with no more than about
    /// `most` looks at pairs of nodes and of triangles, which are added to `*looks`.
    bool apart(const MeshQuery& other, const Eigen::Isometry3d& otherToThis, double distance,
               std::uint64_t* looks = nullptr, std::uint64_t most = anyNumber) const;

    const Bvh& bvh() const { return bvh_; }

    /// The corners of the triangle at this place among the tree's items, about centre() as its nodes are.
    const Corners& localTriangle(std::uint32_t item) const { return corners_[bvh_.items[item]]; }

private:
    /// First-order far field of a node's triangles (Barill 2018).
    struct Dipole {
        Vec3 centre = Vec3::Zero();
        Vec3 areaNormal = Vec3::Zero();
        double radius = 0; ///< all the node's corners lie within it about the centre
    };

    static constexpr std::uint64_t anyNumber = UINT64_MAX;

    /// What squaredDistanceTo() may leave out.
    struct DistanceLimits {
        bool stopAtFirst = false;       ///< ends with the first distance found below the one asked about
        std::uint64_t most = anyNumber; ///< looks; with more of them the answer is 0
        double share2 = 1;              ///< the answer is right to this share, squared
    };
    /// Squared distance of the surfaces where it is below best2, else best2. Counts what it visits in
    /// `looks`.
    double squaredDistanceTo(const MeshQuery& other, const Eigen::Isometry3d& otherToThis, double best2,
                             const DistanceLimits& limits, std::uint64_t& looks) const;
    void buildDipoles();
    /// Of one triangle; 0 for one without area, whose solid angle would be rounding alone.
    double solidAngleOf(std::uint32_t triangle, const Vec3& local) const;
    double exactWinding(const Vec3& local) const;
    /// By how much the exits of a ray from `local` outnumber its entries: the winding number where the mesh
    /// is closed and the ray runs along no edge. along: its direction, with 1 for x.
    int crossings(const Vec3& local, const Vec3& along) const;
    /// Barill's approximation: a node farther away than beta of its radii counts by its dipole.
    double approximateWinding(const Vec3& local, double beta) const;

    bool closed_;
    Vec3 origin_ = Vec3::Zero();
    std::vector<Corners> corners_; ///< one per triangle, about origin_
    Bvh bvh_;
    std::vector<Dipole> dipoles_; ///< one per node
    std::vector<char> flat_;      ///< one per triangle: it has no area; empty where all have one
};

} // namespace tss
