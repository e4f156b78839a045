// O'Rourke and Badler, "Decomposition of three-dimensional objects into spheres", 1979.
#include "bake/base/Stopwatch.h"
#include "bake/compare/MeshTree.h"

#include "bake/base/Order.h"
#include "bake/base/Parallel.h"
#include "bake/spheres/FitMetrics.h"

#include <algorithm>

namespace tss::compare {

namespace {

Vec3 centroid(const TriangleMesh& mesh, std::size_t t) {
    return (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3;
}

/// The largest sphere that rests against the middle of each triangle from inside, one per triangle; radius 0:
/// none. (No ball inside can rest against a convex corner.)
SphereSet restingSpheres(const TriangleMesh& mesh, const Solid& solid) {
    SphereSet resting(mesh.triangles.size());
    parallelFor(resting.size(), [&](std::size_t i) {
        const Vec3 p = centroid(mesh, i);
        resting[i] = {p, 0};
        const Vec3 area = mesh.areaNormal(i);
        if (!(area.norm() > 0)) return;
        // Shrink about the point until nothing of the surface is inside: each round the sphere is made to
        // pass through the nearest surface point.
        const Vec3 n = area.normalized();
        double radius = 0.5 * solid.diagonal();
        for (int round = 0; round < 60 && radius > 1e-9 * solid.diagonal(); ++round) {
            const Vec3 centre = p - radius * n;
            const ClosestPoint near = solid.boundary().closest(centre, radius * (1 - 1e-6));
            if (near.triangle < 0) {
                resting[i] = {centre, radius};
                return;
            }
            const Vec3 toPoint = p - near.point;
            const double facing = toPoint.dot(n);
            if (!(facing > 0)) return;
            radius = std::min(radius * (1 - 1e-6), toPoint.squaredNorm() / (2 * facing));
        }
    });
    return resting;
}

/// Largest first, a sphere is kept when it rests against a point that no kept one comes near to.
SphereSet keepLargest(const TriangleMesh& mesh, const SphereSet& resting, double near) {
    std::vector<std::uint32_t> order = indicesOf(resting.size());
    std::ranges::sort(order, [&](std::uint32_t i, std::uint32_t j) {
        return resting[i].radius != resting[j].radius ? resting[i].radius > resting[j].radius : i < j;
    });
    std::vector<Vec3> points;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) points.push_back(centroid(mesh, t));
    const Bvh bvh = buildBvh(std::vector<Eigen::AlignedBox3d>(points.begin(), points.end()));
    std::vector<char> reached(resting.size(), 0);
    SphereSet kept;
    for (const std::uint32_t i : order) {
        if (reached[i] || resting[i].radius <= 0) continue;
        kept.push_back(resting[i]);
        const double reach = resting[i].radius + near;
        visitBall(bvh, resting[i].centre, reach, [&](std::uint32_t v) {
            if ((points[v] - resting[i].centre).norm() <= reach) reached[v] = 1;
        });
        reached[i] = 1;
    }
    return kept;
}

} // namespace

std::unique_ptr<CollisionMethod> makeOrourkeBadler(const ComparedPair& problem) {
    const Stopwatch watch;
    const Solid solidA(problem.meshA), solidB(problem.meshB);
    const SphereSet a =
        keepLargest(problem.meshA, restingSpheres(problem.meshA, solidA), 1e-3 * solidA.diagonal());
    const SphereSet b =
        keepLargest(problem.meshB, restingSpheres(problem.meshB, solidB), 1e-3 * solidB.diagonal());
    BodyTrees trees{buildEnclosingTree(a, 8, Enclosure::Balls), buildEnclosingTree(b, 8, Enclosure::Balls)};
    const double seconds = watch.seconds();
    const double miss =
        coverageBound(a, patchesOf(problem.meshA)) + coverageBound(b, patchesOf(problem.meshB));
    Description description{
        "orourke-badler",
        "O'Rourke-Badler",
        "the largest ball resting against each triangle's middle from inside, largest first, those kept that "
        "come nearer than 0.1 % of the diagonal to a middle that no other does; " +
            std::to_string(a.size()) + " + " + std::to_string(b.size()) +
            " balls, tree of 8; inscribed, so that shallow contacts are missed",
        {miss, leafProtrusion(trees.a, solidA) + leafProtrusion(trees.b, solidB)},
        trees.bytes(),
        seconds};
    return makeTreeMethod(std::move(trees), std::move(description));
}

} // namespace tss::compare
