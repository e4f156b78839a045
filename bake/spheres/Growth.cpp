// The growth of spheres in "Object Interaction Using Tabulated Spheres Subsets", Figure 1f-i.
#include "bake/spheres/SphereMethods.h"

#include "bake/geometry/Bvh.h"
#include "bake/geometry/MeshAudit.h"

#include <algorithm>

namespace tss {

namespace {

/// The options in scene units.
struct Lengths {
    double start, step, end, maxRadius;
};

Lengths lengths(const TriangleMesh& mesh, const GrowthOptions& o) {
    const double unit = o.relative ? diagonal(mesh) : 1;
    return {o.start * unit, o.step * unit, o.end * unit, o.maxRadius * unit};
}

class Grower {
public:
    Grower(const TriangleMesh& mesh, const GrowthOptions& options)
        : mesh_(mesh), lengths_(lengths(mesh, options)) {
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            centroids_.push_back((mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3);
        tree_ = buildBvh(std::vector<Eigen::AlignedBox3d>(centroids_.begin(), centroids_.end()));
    }

    GrownSphere grow(int triangle) const {
        GrownSphere grown;
        grown.met = {triangle};
        const Vec3 normal = mesh_.areaNormal(static_cast<std::size_t>(triangle)).stableNormalized();
        Line line{centroids_[triangle], -normal, lengths_.start};
        while (growAlong(line, grown) && grown.met.size() < 4) {
            // The line through the middle of the points met, m_L or m_T, and the centre so far.
            Vec3 anchor = Vec3::Zero();
            for (const int t : grown.met) anchor += centroids_[t] / static_cast<double>(grown.met.size());
            const Vec3 way = line.at() - anchor;
            const double length = way.norm();
            line = {anchor, length > 0 ? Vec3(way / length) : line.direction, length};
        }
        return grown;
    }

private:
    struct Line {
        Vec3 anchor, direction; ///< m1, m_L or m_T, and a unit vector: -N first
        double t = 0;           ///< T, of the centre
        Vec3 at() const { return anchor + t * direction; }
    };

    /// Grows from line.t on by steps until a further centroid is met: true. False at T_max or the threshold.
    bool growAlong(Line& line, GrownSphere& grown) const {
        const double from = line.t;
        for (int k = 0;; ++k) {
            line.t = from + k * lengths_.step;
            if (line.t > lengths_.end * (1 + 1e-12)) return false;
            const Vec3 centre = line.at();
            double radius = 0;
            for (const int m : grown.met) radius = std::max(radius, (centre - centroids_[m]).norm());
            if (radius > lengths_.maxRadius * (1 + 1e-12)) return false;
            const int met = meets(centre, radius, grown.met);
            // A sphere that holds a fourth point is one step too large.
            if (met < 0 || grown.met.size() < 3) grown.sphere = {centre, radius};
            if (met < 0) continue;
            grown.met.push_back(met);
            return true;
        }
    }

    /// The centroid deepest in the ball that is not among those met; -1: none.
    int meets(const Vec3& centre, double radius, const std::vector<int>& met) const {
        double best2 = radius * radius;
        int found = -1;
        visitNearest(tree_, centre, best2, [&](std::uint32_t t) {
            const double d2 = (centroids_[t] - centre).squaredNorm();
            const int index = static_cast<int>(t);
            if (!(d2 < best2) || std::find(met.begin(), met.end(), index) != met.end()) return;
            best2 = d2;
            found = index;
        });
        return found;
    }

    const TriangleMesh& mesh_;
    Lengths lengths_;
    std::vector<Vec3> centroids_;
    Bvh tree_;
};

} // namespace

std::vector<GrownSphere> growSpheres(const TriangleMesh& mesh, const GrowthOptions& options,
                                     const Progress& progress) {
    const Grower grower(mesh, options);
    std::vector<GrownSphere> spheres;
    std::vector<char> met(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (t % 1024 == 0 &&
            !report(progress, "growth", static_cast<double>(t) / static_cast<double>(mesh.triangles.size())))
            break;
        if (met[t]) continue;
        if (hasZeroArea(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2))) continue; // no way in
        GrownSphere grown = grower.grow(static_cast<int>(t));
        if (!(grown.sphere.radius > 0) || grown.met.size() < 2) continue;
        for (const int m : grown.met) met[m] = 1;
        spheres.push_back(std::move(grown));
    }
    return spheres;
}

} // namespace tss
