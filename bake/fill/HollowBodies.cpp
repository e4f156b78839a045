#include "bake/fill/HollowBodies.h"

#include "bake/base/Parallel.h"
#include "bake/base/Poll.h"
#include "bake/search/NodePairs.h"
#include "bake/search/SampledSearch.h"
#include "bake/table/Table.h"

#include <algorithm>

namespace tss {

namespace {

bool fillable(const FilledBody& body) {
    return body.solid.open() && !body.solid.hollow();
}

/// Whether the sphere fills material behind the surface: its centre is farther inside than its protrusion.
bool fillsInterior(const FilledBody& body, std::uint32_t sphere) {
    return fillable(body) &&
           body.solid.boundary().distance(body.spheres[sphere].centre) > 0.5 * body.protrusion;
}

/// Whether the other body's surface, next to the sphere of it that touches, is inside `body` where a sphere
/// fills it.
bool entered(const FilledBody& body, std::uint32_t sphere, const FilledBody& other, std::uint32_t touching,
             const Pose& otherToBody) {
    if (!fillsInterior(body, sphere)) return false;
    return body.solid.inside(otherToBody * other.surface.closest(other.spheres[touching].centre).point);
}

struct Trees {
    SphereTree a, b;
};

/// Which bodies are hollow as far as one pose shows.
HollowBodies hollowAt(const FilledBody& a, const FilledBody& b, const Trees& trees, const Pose& bToA,
                      double reach) {
    constexpr std::size_t enough = 64; // pairs; more are about the same place
    std::vector<SpherePair> touching;
    visitPairsWithin(trees.a, trees.b, bToA, 0, [&](std::uint32_t i, std::uint32_t j, double) {
        touching.push_back({i, j});
        return touching.size() < enough;
    });
    if (touching.empty() || !a.surface.apart(b.surface, bToA, reach)) return {};
    const Pose aToB = bToA.inverse();
    HollowBodies hollow, maybe;
    for (const SpherePair& pair : touching) {
        hollow.a = hollow.a || entered(a, pair.a, b, pair.b, bToA);
        hollow.b = hollow.b || entered(b, pair.b, a, pair.a, aToB);
        maybe.a = maybe.a || fillsInterior(a, pair.a);
        maybe.b = maybe.b || fillsInterior(b, pair.b);
    }
    return hollow ? hollow : maybe;
}

} // namespace

HollowBodies findHollow(const FilledBody& a, const FilledBody& b, const Motion& motion, double reach,
                        const Progress& progress) {
    HollowBodies hollow;
    if (!(fillable(a) || fillable(b)) || a.spheres.empty() || b.spheres.empty()) return hollow;
    std::vector<std::vector<double>> poses = exploredPoses(motion, 2000, 1);
    poses.insert(poses.begin(), restValues(motion));
    Poll poll(progress, "openings");
    const auto stop = [&] { return poll.stopped(); };
    const Trees trees{SphereTree(a.spheres, stop), SphereTree(b.spheres, stop)};
    if (poll.stopped()) return hollow;
    constexpr std::size_t batch = 64; // of fixed size, so that the outcome does not depend on threads
    std::vector<HollowBodies> found(batch);
    for (std::size_t first = 0; first < poses.size() && !hollow; first += batch) {
        if (!report(progress, "openings", double(first) / double(poses.size()))) break;
        const std::size_t count = std::min(batch, poses.size() - first);
        parallelFor(count, [&](std::size_t k) {
            found[k] = hollowAt(a, b, trees, pose(motion, poses[first + k]), reach);
        });
        for (std::size_t k = 0; k < count; ++k) {
            hollow.a = hollow.a || found[k].a;
            hollow.b = hollow.b || found[k].b;
        }
    }
    return hollow;
}

} // namespace tss
