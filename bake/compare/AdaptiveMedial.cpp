// After Bradshaw and O'Sullivan, "Adaptive medial-axis approximation for sphere-tree construction", 2004.
#include "bake/compare/MeshTree.h"

#include "bake/base/Order.h"
#include "bake/base/Parallel.h"
#include "bake/spheres/SphereSet.h"

#include <algorithm>

namespace tss::compare {

namespace {

constexpr std::size_t childCount = 8;
constexpr std::size_t seedCount = 40;

using Elements = std::vector<std::uint32_t>;

/// Medial balls spread over a region: each is the one that the balls before it reach least.
std::vector<std::uint32_t> spread(const MedialSurface& surface, const Elements& region) {
    std::vector<std::uint32_t> seeds{surface.ballOf[region[0]]};
    std::vector<double> left(region.size(), std::numeric_limits<double>::infinity());
    while (seeds.size() < std::min(seedCount, region.size())) {
        const Sphere& ball = surface.balls[seeds.back()];
        std::size_t worst = 0;
        for (std::size_t k = 0; k < region.size(); ++k) {
            left[k] = std::min(left[k], reach(ball.centre, surface.elements[region[k]]) - ball.radius);
            if (left[k] > left[worst]) worst = k;
        }
        const std::uint32_t next = surface.ballOf[region[worst]];
        if (std::ranges::find(seeds, next) != seeds.end()) break;
        seeds.push_back(next);
    }
    return seeds;
}

/// Each element goes to the ball that has to grow least to contain it.
std::vector<Elements> assign(const MedialSurface& surface, const Elements& region, const SphereSet& balls) {
    std::vector<Elements> parts(balls.size());
    for (const std::uint32_t e : region) {
        std::size_t best = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t b = 0; b < balls.size(); ++b) {
            const double growth = reach(balls[b].centre, surface.elements[e]) - balls[b].radius;
            if (growth < least) {
                least = growth;
                best = b;
            }
        }
        parts[best].push_back(e);
    }
    std::erase_if(parts, [](const Elements& part) { return part.empty(); });
    return parts;
}

/// Merges the two parts whose common ball grows least until few enough are left.
void mergeDown(const MedialSurface& surface, std::vector<Elements>& parts) {
    SphereSet balls;
    for (const Elements& part : parts) {
        SphereSet corners;
        for (const std::uint32_t e : part)
            for (const Vec3& corner : surface.elements[e]) corners.push_back({corner, 0});
        balls.push_back(coreSetBall(corners, 0.3));
    }
    while (parts.size() > childCount) {
        std::size_t first = 0, second = 1;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < parts.size(); ++i)
            for (std::size_t j = i + 1; j < parts.size(); ++j) {
                const double radius = ballAround(balls[i], balls[j]).radius;
                if (radius < least) {
                    least = radius;
                    first = i;
                    second = j;
                }
            }
        balls[first] = ballAround(balls[first], balls[second]);
        parts[first].insert(parts[first].end(), parts[second].begin(), parts[second].end());
        balls.erase(balls.begin() + second);
        parts.erase(parts.begin() + second);
    }
}

/// A few of the medial centres under a part, the largest balls first.
std::vector<Vec3> centresUnder(const MedialSurface& surface, const Elements& part) {
    std::vector<std::uint32_t> balls;
    const std::size_t stride = std::max<std::size_t>(1, part.size() / 12);
    for (std::size_t k = 0; k < part.size(); k += stride) balls.push_back(surface.ballOf[part[k]]);
    std::ranges::sort(balls, [&](std::uint32_t i, std::uint32_t j) {
        const double ri = surface.balls[i].radius, rj = surface.balls[j].radius;
        return ri != rj ? ri > rj : i < j;
    });
    balls.erase(std::unique(balls.begin(), balls.end()), balls.end());
    if (balls.size() > 5) balls.resize(5);
    std::vector<Vec3> centres;
    for (const std::uint32_t i : balls)
        if (surface.balls[i].radius > 0) centres.push_back(surface.balls[i].centre);
    return centres;
}

struct Part {
    Elements elements;
    Sphere ball;
};

std::vector<Part> divide(const MedialSurface& surface, const Solid& solid, const Elements& region) {
    SphereSet seeds;
    for (const std::uint32_t i : spread(surface, region)) seeds.push_back(surface.balls[i]);
    std::vector<Elements> parts = assign(surface, region, seeds);
    mergeDown(surface, parts);
    SphereSet fitted;
    for (const Elements& part : parts)
        fitted.push_back(fitBall(surface, solid, part, centresUnder(surface, part)));
    std::vector<Part> result;
    for (Elements& part : assign(surface, region, fitted)) {
        const Sphere ball = fitBall(surface, solid, part, centresUnder(surface, part));
        result.push_back({std::move(part), ball});
    }
    return result;
}

EnclosingTree buildAdaptiveMedial(const TriangleMesh& mesh, const Solid& solid, int levels) {
    EnclosingTree tree;
    const MedialSurface surface = medialSurface(mesh, solid);
    if (surface.elements.empty()) return tree;
    Elements all = indicesOf(surface.elements.size());
    const Sphere root = fitBall(surface, solid, all, {});
    tree.nodes.push_back({root.centre, root.radius, 0, 0});
    std::vector<std::pair<std::uint32_t, Elements>> open{{0, std::move(all)}};
    for (int level = 0; level < levels; ++level) {
        std::vector<std::vector<Part>> divided(open.size());
        parallelFor(open.size(), [&](std::size_t i) {
            if (open[i].second.size() > 1) divided[i] = divide(surface, solid, open[i].second);
        });
        std::vector<std::pair<std::uint32_t, Elements>> below;
        for (std::size_t i = 0; i < open.size(); ++i) {
            if (divided[i].size() < 2) continue; // nothing to gain: stays a leaf
            EnclosingTree::Node& node = tree.nodes[open[i].first];
            node.first = static_cast<std::uint32_t>(tree.nodes.size());
            node.count = static_cast<std::uint32_t>(divided[i].size());
            for (Part& part : divided[i]) {
                below.emplace_back(static_cast<std::uint32_t>(tree.nodes.size()), std::move(part.elements));
                tree.nodes.push_back({part.ball.centre, part.ball.radius, 0, 0});
            }
        }
        open = std::move(below);
    }
    return tree;
}

} // namespace

std::unique_ptr<CollisionMethod> makeAdaptiveMedial(const ComparedPair& problem, int levels) {
    return makeMedialTrees(
        problem, levels, buildAdaptiveMedial, "medial-adaptive-",
        "after Bradshaw and O'Sullivan: each region's medial balls merged to 8 and refitted",
        "; the medial axis is not sampled anew in a region, no burst step");
}

} // namespace tss::compare
