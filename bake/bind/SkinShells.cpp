#include "bake/bind/SkinClaims.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/base/UnionFind.h"
#include "bake/motion/ClosestPointQuery.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tss {
namespace {

/// Shells up to this many times as far from bound skin as the nearest one are bound in the same round,
/// without a unit: so there are few rounds however many shells, and what lies on another shell waits for it.
constexpr double alike = 2;

struct Shell {
    std::vector<std::uint32_t> vertices, triangles; ///< of the skin
    double least = infinity, most = infinity;       ///< of the distances of its vertices, scene units
    Eigen::AlignedBox3d box;
};

/// Triangles of the skin that are bound already, with closest-point queries.
class BoundSkin {
public:
    BoundSkin(const TriangleMesh& skin, std::vector<std::uint32_t> triangles)
        : skin_(skin), triangles_(std::move(triangles)), mesh_(partOf(skin, triangles_)), query_(mesh_),
          box_(bounds(mesh_)) {}

    /// Binds a shell's vertices to this skin where that is nearer than what they are bound to.
    void bind(Shell& shell, std::vector<ShellVertex>& made) const {
        if (triangles_.empty() || !(box_.exteriorDistance(shell.box) < shell.most)) return;
        parallelFor(shell.vertices.size(), [&](std::size_t i) {
            ShellVertex& vertex = made[shell.vertices[i]];
            const NearestPoint near = query_.nearest(skin_.vertices[shell.vertices[i]], vertex.distance);
            if (near.triangle < 0) return;
            vertex.skin = skin_.triangles[triangles_[near.triangle]];
            vertex.weights = near.weights;
            vertex.distance = near.distance;
        });
    }

private:
    static TriangleMesh partOf(const TriangleMesh& skin, const std::vector<std::uint32_t>& triangles) {
        TriangleMesh part;
        for (const std::uint32_t t : triangles) {
            const auto first = static_cast<int>(part.vertices.size());
            for (int k = 0; k < 3; ++k) part.vertices.push_back(skin.vertices[skin.triangles[t][k]]);
            part.triangles.emplace_back(first, first + 1, first + 2);
        }
        return part;
    }

    const TriangleMesh& skin_;
    std::vector<std::uint32_t> triangles_;
    TriangleMesh mesh_;
    ClosestPointQuery query_;
    Eigen::AlignedBox3d box_;
};

void measure(Shell& shell, const std::vector<ShellVertex>& made) {
    shell.least = infinity;
    shell.most = 0;
    for (const std::uint32_t v : shell.vertices) {
        shell.least = std::min(shell.least, made[v].distance);
        shell.most = std::max(shell.most, made[v].distance);
    }
}

ShellVertex nearestInfluence(const std::vector<SkinInfluence>& influences, std::size_t v) {
    ShellVertex made;
    made.distance = infinity;
    for (std::uint32_t h = 0; h < influences.size(); ++h) {
        if (!(influences[h].distance[v] < made.distance)) continue;
        made.distance = influences[h].distance[v];
        made.influence = h;
    }
    return made;
}

} // namespace

std::vector<ShellVertex> bindShells(const TriangleMesh& skin, const std::vector<SkinInfluence>& influences,
                                    const std::vector<double>& nearestSeed) {
    const std::size_t count = nearestSeed.size();
    const auto isSeeded = [&](std::size_t v) { return std::isfinite(nearestSeed[v]); };
    std::size_t first = 0;
    while (first < count && isSeeded(first)) ++first;
    if (first == count) return {};
    UnionFind sets(count);
    for (const Tri& t : skin.triangles)
        for (int k = 0; k < 2; ++k) sets.join(t[k], t[k + 1]);
    std::map<std::size_t, Shell> byRoot;
    std::vector<std::uint32_t> bound; // triangles bound in the last round
    for (std::uint32_t i = 0; i < skin.triangles.size(); ++i) {
        const auto v = static_cast<std::size_t>(skin.triangles[i][0]);
        (isSeeded(v) ? bound : byRoot[sets.root(v)].triangles).push_back(i);
    }
    std::vector<ShellVertex> made(count);
    for (std::uint32_t v = 0; v < count; ++v) {
        if (isSeeded(v)) continue;
        made[v] = nearestInfluence(influences, v);
        made[v].least = made[v].distance;
        made[v].round = 0;
        const auto shell = byRoot.find(sets.root(v)); // a vertex without triangles is in no shell
        if (shell == byRoot.end()) continue;
        shell->second.vertices.push_back(v);
        shell->second.box.extend(skin.vertices[v]);
    }
    std::vector<Shell> shells;
    for (auto& [root, shell] : byRoot) shells.push_back(std::move(shell));
    for (int round = 0; !shells.empty(); ++round) {
        const BoundSkin below(skin, std::move(bound));
        double least = infinity;
        for (Shell& shell : shells) {
            below.bind(shell, made);
            measure(shell, made);
            least = std::min(least, shell.least);
        }
        bound.clear();
        std::erase_if(shells, [&](const Shell& shell) {
            if (shell.least > alike * least) return false;
            bound.insert(bound.end(), shell.triangles.begin(), shell.triangles.end());
            for (const std::uint32_t v : shell.vertices) {
                made[v].round = round;
                made[v].least = shell.least;
            }
            return true;
        });
    }
    return made;
}

} // namespace tss
