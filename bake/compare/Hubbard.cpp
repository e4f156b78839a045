// After Hubbard, "Approximating polyhedra with spheres for time-critical collision detection", 1996.
#include "bake/compare/MeshTree.h"

#include "bake/base/Parallel.h"
#include "bake/base/UnionFind.h"
#include "bake/spheres/SphereSet.h"

#include <algorithm>
#include <numeric>
#include <queue>
#include <set>

namespace tss::compare {

namespace {

/// A growing set of surface elements.
struct Cluster {
    Sphere ball;          ///< contains its elements
    double inscribed = 0; ///< radius of the largest medial ball under it
    std::set<std::uint32_t> neighbours;
    std::uint32_t version = 0;
    bool alive = true;
};

/// About how far a ball that contains both would stick out: s^2 / 2R for a patch of radius s over a medial
/// ball of radius R, s where the medial ball is no help.
double mergeCost(const Cluster& a, const Cluster& b) {
    const double s = ballAround(a.ball, b.ball).radius;
    return s * s / (2 * std::max({a.inscribed, b.inscribed, 0.5 * s, 1e-300}));
}

struct Merge {
    double cost;
    std::uint32_t a, b, versionA, versionB;
    bool operator<(const Merge& other) const {
        if (cost != other.cost) return cost > other.cost;
        return std::pair(a, b) > std::pair(other.a, other.b);
    }
};

class Merging {
public:
    explicit Merging(const MedialSurface& surface) : together_(surface.elements.size()) {
        for (std::size_t e = 0; e < surface.elements.size(); ++e) {
            SphereSet corners;
            for (const Vec3& corner : surface.elements[e]) corners.push_back({corner, 0});
            clusters_.push_back({enclosingBall(corners, Enclosure::Balls),
                                 surface.balls[surface.ballOf[e]].radius,
                                 {},
                                 0,
                                 true});
        }
        for (const auto& [i, j] : surface.neighbours) link(i, j);
        count_ = clusters_.size();
    }

    std::size_t count() const { return count_; }

    /// What tells the cluster of an element from all others.
    std::uint32_t of(std::uint32_t element) { return static_cast<std::uint32_t>(together_.root(element)); }

    void mergeDownTo(std::size_t target) {
        while (count_ > target) {
            if (queue_.empty()) linkStrangers();
            const Merge next = queue_.top();
            queue_.pop();
            const bool current = clusters_[next.a].alive && clusters_[next.b].alive &&
                                 clusters_[next.a].version == next.versionA &&
                                 clusters_[next.b].version == next.versionB;
            if (current) merge(next.a, next.b);
        }
    }

private:
    void link(std::uint32_t i, std::uint32_t j) {
        if (i == j || !clusters_[i].neighbours.insert(j).second) return;
        clusters_[j].neighbours.insert(i);
        push(i, j);
    }
    void push(std::uint32_t i, std::uint32_t j) {
        const std::uint32_t a = std::min(i, j), b = std::max(i, j);
        queue_.push(
            {mergeCost(clusters_[a], clusters_[b]), a, b, clusters_[a].version, clusters_[b].version});
    }
    void merge(std::uint32_t keep, std::uint32_t drop) {
        if (clusters_[drop].neighbours.size() > clusters_[keep].neighbours.size()) std::swap(keep, drop);
        Cluster &into = clusters_[keep], &from = clusters_[drop];
        into.ball = ballAround(into.ball, from.ball);
        into.inscribed = std::max(into.inscribed, from.inscribed);
        ++into.version;
        from.alive = false;
        together_.join(keep, drop);
        --count_;
        for (const std::uint32_t other : from.neighbours) {
            clusters_[other].neighbours.erase(drop);
            if (other == keep) continue;
            into.neighbours.insert(other);
            clusters_[other].neighbours.insert(keep);
        }
        from.neighbours.clear();
        for (const std::uint32_t other : into.neighbours) push(keep, other);
    }
    /// Components that no edge connects: each is linked to the nearest few along each axis.
    void linkStrangers() {
        std::vector<std::uint32_t> alive;
        for (std::uint32_t i = 0; i < clusters_.size(); ++i)
            if (clusters_[i].alive) alive.push_back(i);
        for (int axis = 0; axis < 3; ++axis) {
            std::ranges::sort(alive, [&](std::uint32_t i, std::uint32_t j) {
                const double x = clusters_[i].ball.centre[axis], y = clusters_[j].ball.centre[axis];
                return x != y ? x < y : i < j;
            });
            for (std::size_t k = 0; k + 1 < alive.size(); ++k) link(alive[k], alive[k + 1]);
        }
    }

    std::vector<Cluster> clusters_;
    UnionFind together_; ///< elements of one cluster
    std::priority_queue<Merge> queue_;
    std::size_t count_ = 0;
};

std::vector<Vec3> someCentres(const MedialSurface& surface, const std::vector<std::uint32_t>& elements) {
    std::vector<Vec3> centres;
    const std::size_t stride = std::max<std::size_t>(1, elements.size() / 4);
    for (std::size_t k = 0; k < elements.size() && centres.size() < 4; k += stride) {
        const Sphere& ball = surface.balls[surface.ballOf[elements[k]]];
        if (ball.radius > 0) centres.push_back(ball.centre);
    }
    return centres;
}

EnclosingTree buildHubbard(const TriangleMesh& mesh, const Solid& solid, int levels) {
    EnclosingTree tree;
    const MedialSurface surface = medialSurface(mesh, solid);
    const std::size_t elementCount = surface.elements.size();
    if (elementCount == 0) return tree;
    // owner[l][e]: the cluster that element e is in when at most 8^l clusters are left.
    std::vector<std::vector<std::uint32_t>> owner(static_cast<std::size_t>(levels) + 1);
    Merging merging(surface);
    for (int l = levels; l >= 0; --l) {
        merging.mergeDownTo(std::size_t{1} << (3 * l));
        auto& of = owner[l];
        for (std::uint32_t e = 0; e < elementCount; ++e) of.push_back(merging.of(e));
    }
    std::vector<std::vector<std::uint32_t>> open(1, std::vector<std::uint32_t>(elementCount));
    std::iota(open[0].begin(), open[0].end(), 0u);
    tree.nodes.emplace_back();
    std::vector<std::vector<std::uint32_t>> elementsOf = open; // by node
    for (std::size_t node = 0, level = 0, levelEnd = 1; level < static_cast<std::size_t>(levels); ++level) {
        for (; node < levelEnd; ++node) {
            auto& elements = elementsOf[node];
            std::ranges::sort(elements, [&](std::uint32_t i, std::uint32_t j) {
                return std::pair(owner[level + 1][i], i) < std::pair(owner[level + 1][j], j);
            });
            std::vector<std::vector<std::uint32_t>> parts;
            for (const std::uint32_t e : elements) {
                if (parts.empty() || owner[level + 1][parts.back()[0]] != owner[level + 1][e])
                    parts.emplace_back();
                parts.back().push_back(e);
            }
            if (parts.size() < 2 && level + 1 < static_cast<std::size_t>(levels) && elements.size() < 2)
                continue; // a single element stays a leaf
            tree.nodes[node].first = static_cast<std::uint32_t>(tree.nodes.size());
            tree.nodes[node].count = static_cast<std::uint32_t>(parts.size());
            for (auto& part : parts) {
                tree.nodes.emplace_back();
                elementsOf.push_back(std::move(part));
            }
        }
        levelEnd = tree.nodes.size();
    }
    parallelFor(tree.nodes.size(), [&](std::size_t i) {
        const Sphere ball = fitBall(surface, solid, elementsOf[i], someCentres(surface, elementsOf[i]));
        tree.nodes[i].centre = ball.centre;
        tree.nodes[i].radius = ball.radius;
    });
    return tree;
}

} // namespace

std::unique_ptr<CollisionMethod> makeHubbard(const ComparedPair& problem, int levels) {
    return makeMedialTrees(problem, levels, buildHubbard, "medial-hubbard-",
                           "after Hubbard: medial balls merged bottom up to 8 to the power of the level");
}

} // namespace tss::compare
