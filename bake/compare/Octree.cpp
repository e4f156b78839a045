// Hubbard, "Approximating polyhedra with spheres for time-critical collision detection", 1996, and Bradshaw
// and O'Sullivan, "Adaptive medial-axis approximation for sphere-tree construction", 2004: their octree.
#include "bake/base/Stopwatch.h"
#include "bake/compare/MeshTree.h"

namespace tss::compare {

namespace {

/// Whether there is a separating axis between a triangle and a cube about the origin of half width `half`.
/// The cube is made a little larger, so that rounding loses no piece of surface between cubes.
bool separated(const Vec3& a, const Vec3& b, const Vec3& c, double half) {
    const double h = half * (1 + 1e-9);
    const auto apart = [&](const Vec3& axis) {
        const double pa = axis.dot(a), pb = axis.dot(b), pc = axis.dot(c);
        const double reach = h * axis.cwiseAbs().sum();
        return std::min({pa, pb, pc}) > reach || std::max({pa, pb, pc}) < -reach;
    };
    for (int k = 0; k < 3; ++k)
        if (apart(Vec3::Unit(k))) return true;
    const Vec3 edges[3] = {b - a, c - b, a - c};
    if (apart(edges[0].cross(edges[1]))) return true;
    for (const Vec3& edge : edges)
        for (int k = 0; k < 3; ++k)
            if (apart(edge.cross(Vec3::Unit(k)))) return true;
    return false;
}

struct Cube {
    std::uint32_t node;
    int level;
    Vec3 centre;
    double half;
    std::vector<std::uint32_t> triangles;
};

EnclosingTree buildOctree(const TriangleMesh& mesh, int levels) {
    EnclosingTree tree;
    if (mesh.empty()) return tree;
    const Eigen::AlignedBox3d box = bounds(mesh);
    Cube root{0, 0, box.center(), 0.5 * box.sizes().maxCoeff(), {}};
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) root.triangles.push_back(t);
    std::vector<Cube> open;
    open.push_back(std::move(root));
    tree.nodes.push_back({box.center(), 0, 0, 0});
    for (std::size_t next = 0; next < open.size(); ++next) { // breadth first
        const Cube cube = std::move(open[next]);
        EnclosingTree::Node node{cube.centre, cube.half * std::sqrt(3.0) * (1 + 1e-9), 0, 0};
        if (cube.level < levels) {
            node.first = static_cast<std::uint32_t>(tree.nodes.size());
            for (int octant = 0; octant < 8; ++octant) {
                const Vec3 side(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
                Cube child{0, cube.level + 1, cube.centre + 0.5 * cube.half * side, 0.5 * cube.half, {}};
                for (const std::uint32_t t : cube.triangles)
                    if (!separated(mesh.corner(t, 0) - child.centre, mesh.corner(t, 1) - child.centre,
                                   mesh.corner(t, 2) - child.centre, child.half))
                        child.triangles.push_back(t);
                if (child.triangles.empty()) continue;
                child.node = static_cast<std::uint32_t>(tree.nodes.size());
                tree.nodes.emplace_back();
                open.push_back(std::move(child));
                ++node.count;
            }
        }
        tree.nodes[cube.node] = node;
    }
    return tree;
}

} // namespace

std::unique_ptr<CollisionMethod> makeOctree(const ComparedPair& problem, int levels) {
    const Stopwatch watch;
    BodyTrees trees{buildOctree(problem.meshA, levels), buildOctree(problem.meshB, levels)};
    const double seconds = watch.seconds();
    // A leaf's cube holds a point of the surface, so no point of its ball is farther from that than 2 r.
    double early = 0;
    for (const EnclosingTree* tree : {&trees.a, &trees.b}) {
        double radius = 0;
        for (const EnclosingTree::Node& node : tree->nodes)
            if (node.count == 0) radius = std::max(radius, node.radius);
        early += 2 * radius;
    }
    Description description{"octree-" + std::to_string(levels),
                            "octree sphere tree",
                            "balls about the cubes that the surface passes, " + std::to_string(levels) +
                                " levels, " + trees.leavesText(),
                            {0, early},
                            trees.bytes(),
                            seconds};
    return makeTreeMethod(std::move(trees), std::move(description));
}

} // namespace tss::compare
