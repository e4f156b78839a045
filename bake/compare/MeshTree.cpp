#include "bake/compare/MeshTree.h"

#include "bake/base/Parallel.h"
#include "bake/base/Stopwatch.h"
#include "bake/compare/InnerPoles.h"
#include "bake/geometry/Import.h"

#include <algorithm>

namespace tss::compare {

namespace {

/// Halves the longest edge until none is longer than `longest`; triangles without an area stay as they are.
void splitInto(const Corners& element, double longest, std::vector<Corners>& elements) {
    const auto edge = [&](int k) { return (element[(k + 1) % 3] - element[k]).norm(); };
    if (std::max({edge(0), edge(1), edge(2)}) <= longest)
        elements.push_back(element);
    else
        for (const Corners& half : halves(element)) splitInto(half, longest, elements);
}

/// The elements with their corners each place once.
TriangleMesh meshOf(const std::vector<Corners>& elements) {
    TriangleMesh soup;
    for (const Corners& element : elements) {
        const auto first = static_cast<int>(soup.vertices.size());
        soup.vertices.insert(soup.vertices.end(), element.begin(), element.end());
        soup.triangles.emplace_back(first, first + 1, first + 2);
    }
    return welded(soup);
}

} // namespace

std::string BodyTrees::leavesText() const {
    const auto leaves = [](const EnclosingTree& tree) {
        return std::to_string(std::ranges::count(tree.nodes, 0u, &EnclosingTree::Node::count));
    };
    return leaves(a) + " + " + leaves(b) + " leaves";
}

std::unique_ptr<CollisionMethod> makeTreeMethod(BodyTrees trees, Description description) {
    return makeCountedMethod(
        std::move(description),
        [trees = std::make_shared<const BodyTrees>(std::move(trees))](const PoseQuery& query, auto& counter) {
            return treesTouch(trees->a, trees->b, query.pose, counter);
        });
}

std::unique_ptr<CollisionMethod>
makeMedialTrees(const ComparedPair& problem, int levels,
                EnclosingTree (*build)(const TriangleMesh&, const Solid&, int), const std::string& name,
                const std::string& how, const std::string& remark) {
    const Stopwatch watch;
    const Solid solidA(problem.meshA), solidB(problem.meshB);
    BodyTrees trees{build(problem.meshA, solidA, levels), build(problem.meshB, solidB, levels)};
    const double seconds = watch.seconds();
    Description description{name + std::to_string(levels),
                            "medial sphere tree",
                            how + ", " + std::to_string(levels) + " levels, " + trees.leavesText() + remark,
                            {0, leafProtrusion(trees.a, solidA) + leafProtrusion(trees.b, solidB)},
                            trees.bytes(),
                            seconds};
    return makeTreeMethod(std::move(trees), std::move(description));
}

double reach(const Vec3& centre, const Corners& element) {
    return std::sqrt(std::max({(element[0] - centre).squaredNorm(), (element[1] - centre).squaredNorm(),
                               (element[2] - centre).squaredNorm()}));
}

double leafProtrusion(const EnclosingTree& tree, const Solid& solid) {
    std::vector<double> each(tree.nodes.size(), 0.0);
    parallelFor(each.size(), [&](std::size_t i) {
        const EnclosingTree::Node& node = tree.nodes[i];
        if (node.count == 0) each[i] = solid.protrusion(node.centre, node.radius);
    });
    return each.empty() ? 0 : *std::ranges::max_element(each);
}

MedialSurface medialSurface(const TriangleMesh& mesh, const Solid& solid) {
    MedialSurface surface;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        splitInto(mesh.corners(t), solid.diagonal() / 40, surface.elements);
    const TriangleMesh divided = meshOf(surface.elements);
    std::vector<Vec3> normals(divided.vertices.size(), Vec3::Zero());
    for (std::size_t t = 0; t < divided.triangles.size(); ++t)
        for (const int corner : divided.triangles[t]) normals[corner] += divided.areaNormal(t);
    surface.balls = innerPoles(divided.vertices, normals);
    std::vector<std::uint32_t> last(divided.vertices.size(), UINT32_MAX);
    for (std::uint32_t e = 0; e < surface.elements.size(); ++e) {
        std::uint32_t best = divided.triangles[e][0];
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t corner : divided.triangles[e]) {
            const Sphere& ball = surface.balls[corner];
            const double needed =
                ball.radius > 0 ? reach(ball.centre, surface.elements[e]) - ball.radius : 1e300;
            if (needed < least) {
                least = needed;
                best = corner;
            }
            if (last[corner] != UINT32_MAX) surface.neighbours.emplace_back(last[corner], e);
            last[corner] = e;
        }
        surface.ballOf.push_back(best);
    }
    return surface;
}

Sphere fitBall(const MedialSurface& surface, const Solid& solid, std::span<const std::uint32_t> elements,
               std::span<const Vec3> centres) {
    SphereSet points;
    for (const std::uint32_t e : elements)
        for (const Vec3& corner : surface.elements[e]) points.push_back({corner, 0});
    Sphere best = coreSetBall(points, 0.2);
    double least = solid.protrusion(best.centre, best.radius);
    for (const Vec3& centre : centres) {
        double radius = 0;
        for (const std::uint32_t e : elements) radius = std::max(radius, reach(centre, surface.elements[e]));
        radius *= 1 + 1e-12;
        const double protrusion = solid.protrusion(centre, radius);
        if (protrusion < least) {
            least = protrusion;
            best = {centre, radius};
        }
    }
    return best;
}

} // namespace tss::compare
