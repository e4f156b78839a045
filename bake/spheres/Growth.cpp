// The growth of spheres in "Object Interaction Using Tabulated Spheres Subsets", Figure 1f-i.
#include "bake/spheres/Growth.h"

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
        std::vector<Eigen::AlignedBox3d> boxes;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            centroids_.push_back((mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3);
            boxes.emplace_back(centroids_.back());
        }
        tree_ = buildBvh(boxes);
    }

    GrowthTrace grow(int triangle) const {
        GrowthTrace trace;
        trace.seed = triangle;
        trace.met = {triangle};
        const Vec3 normal = (mesh_.corner(triangle, 1) - mesh_.corner(triangle, 0))
                                .cross(mesh_.corner(triangle, 2) - mesh_.corner(triangle, 0))
                                .stableNormalized();
        GrowthStage stage{centroids_[triangle], -normal, lengths_.start, Vec3::Zero(), 0, -1};
        while (runStage(stage, trace) && trace.met.size() < 4) {
            // The line through the middle of the points met and the centre so far.
            GrowthStage next{Vec3::Zero(), stage.direction, 0, Vec3::Zero(), 0, -1};
            for (const int t : trace.met)
                next.anchor += centroids_[t] / static_cast<double>(trace.met.size());
            const Vec3 line = stage.centre - next.anchor;
            next.t = line.norm();
            if (next.t > 0) next.direction = line / next.t;
            stage = next;
        }
        trace.bounded = trace.met.size() > 1;
        return trace;
    }

private:
    /// Grows from stage.t on by steps until a further centroid is met: true. False at T_max or the threshold.
    bool runStage(GrowthStage& stage, GrowthTrace& trace) const {
        const double from = stage.t;
        bool grown = false;
        for (int k = 0;; ++k) {
            const double t = from + k * lengths_.step;
            if (t > lengths_.end * (1 + 1e-12)) break;
            const Vec3 centre = stage.anchor + t * stage.direction;
            double radius = 0;
            for (const int m : trace.met) radius = std::max(radius, (centre - centroids_[m]).norm());
            if (radius > lengths_.maxRadius * (1 + 1e-12)) break;
            stage.t = t;
            stage.centre = centre;
            stage.radius = radius;
            grown = true;
            stage.met = meets(centre, radius, trace.met);
            // A sphere that holds a fourth point is one step too large.
            if (stage.met < 0 || trace.met.size() < 3) trace.sphere = {centre, radius};
            if (stage.met >= 0) break;
        }
        if (grown) trace.stages.push_back(stage);
        if (stage.met < 0) return false;
        trace.met.push_back(stage.met);
        return true;
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

GrowthTrace growSphere(const TriangleMesh& mesh, int triangle, const GrowthOptions& options) {
    return Grower(mesh, options).grow(triangle);
}

std::vector<GrowthTrace> growSpheres(const TriangleMesh& mesh, const GrowthOptions& options,
                                     const Progress& progress) {
    const Grower grower(mesh, options);
    std::vector<GrowthTrace> traces;
    std::vector<char> met(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (t % 1024 == 0 &&
            !report(progress, "growth", static_cast<double>(t) / static_cast<double>(mesh.triangles.size())))
            break;
        if (met[t] && !options.seedEveryTriangle) continue;
        if (hasZeroArea(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2))) continue; // no way in
        GrowthTrace trace = grower.grow(static_cast<int>(t));
        if (!(trace.sphere.radius > 0) || !(trace.bounded || options.keepUnbounded)) continue;
        for (const int m : trace.met) met[m] = 1;
        traces.push_back(std::move(trace));
    }
    return traces;
}

} // namespace tss
