#include "bake/bind/SkinShares.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace tss {
namespace {

/// In sizes of an influence: a seed is nearer to it than seedNear, and to all others farther than seedFar and
/// than seedNearer times its distance from this one. A closed upper lip lies on the lower teeth, but is
/// nearer than that to the upper jaw.
constexpr double seedNear = 0.08, seedFar = 0.12, seedNearer = 2.5;
/// If fewer than this share of the vertices that are far enough from all others are near enough, the next
/// rule applies: a thin bone deep in flesh would have seeds at its ends only.
constexpr double seedNearShare = 0.5;
/// Then seeds are vertices whose contrast, the distance from the next influence less that from this one,
/// exceeds this share of the largest contrast of any vertex. With less, skin that only passes by another bone
/// would count; with more, a bone with little skin would have no seeds.
constexpr double seedContrast = 0.2;
/// Share of those that are kept, the nearest ones: the others lie beyond the ends of the influence.
constexpr double seedShare = 0.8;
/// In sizes of an influence: smaller distances count as this much, the thickness of tissue under which a
/// claim is not weaker.
constexpr double closeShare = 0.01;
/// In sizes of an influence: the distance of its certain vertices counts as at most this.
constexpr double certainShare = 0.15;
/// Weight of a claim against the smoothness of shares along the skin.
constexpr double claimWeight = 8;
/// How fast the certainty of a claim grows with the distance from where two claims meet.
constexpr int certaintyPower = 8;
/// A triangle gets twice as stiff where a share changes by this much over one size of the influence, without
/// a unit: so skin does not fold where two influences meet at a point, as at the corner of a mouth.
constexpr double steepShare = 3;
constexpr int steepRounds = 3; ///< of solves that see the slope of the one before
/// A triangle that a motion would shrink below this share of its area, or flip, is made stiffer. The margin
/// is for muscles and contacts.
constexpr double leastArea = 0.15;

struct Claims {
    std::vector<std::uint32_t> influence; ///< #V: which one claims it
    std::vector<double> weight; ///< #V: firmness, area over squared distance times certainty, without a unit
    std::vector<double> size;   ///< #V: of the smaller of the two influences that meet here, scene units
    std::vector<ShellVertex> shells; ///< #V; empty where there are no shells
    std::vector<std::uint32_t> ends; ///< one per influence with seeds: see ShareOptions::leastAtEnds
};

/// For each vertex the distance from the nearest other influence less that from this one; infinite for the
/// only one.
std::vector<double> contrastOf(const std::vector<SkinInfluence>& influences, std::size_t index) {
    const std::vector<double>& own = influences[index].distance;
    std::vector<double> contrast(own.size(), infinity);
    for (std::size_t h = 0; h < influences.size(); ++h)
        for (std::size_t v = 0; v < own.size() && h != index; ++v)
            contrast[v] = std::min(contrast[v], influences[h].distance[v] - own[v]);
    return contrast;
}

/// Seeds by the first rule (seedNear, seedFar, seedNearer); empty by seedNearShare.
std::vector<std::uint32_t> seedsByDistance(const SkinInfluence& influence,
                                           const std::vector<double>& contrast) {
    std::vector<std::uint32_t> seeds;
    std::size_t far = 0; // vertices far enough from all others
    for (std::uint32_t v = 0; v < contrast.size(); ++v) {
        const double own = influence.distance[v];
        if (contrast[v] + own <= std::max(seedFar * influence.size, seedNearer * own)) continue;
        ++far;
        if (own < seedNear * influence.size) seeds.push_back(v);
    }
    if (static_cast<double>(seeds.size()) < seedNearShare * static_cast<double>(far)) seeds.clear();
    return seeds;
}

/// Seeds by the second rule (seedContrast, seedShare).
std::vector<std::uint32_t> seedsByContrast(const SkinInfluence& influence, std::vector<double> contrast) {
    for (std::size_t v = 0; v < influence.excluded.size(); ++v)
        if (influence.excluded[v]) contrast[v] = -infinity;
    const double most = *std::max_element(contrast.begin(), contrast.end());
    std::vector<std::uint32_t> seeds;
    std::vector<double> distances;
    for (std::uint32_t v = 0; v < contrast.size(); ++v)
        if (contrast[v] > seedContrast * std::max(most, 0.0)) {
            seeds.push_back(v);
            distances.push_back(influence.distance[v]);
        }
    if (seeds.empty()) return seeds;
    const auto last =
        std::min(static_cast<std::size_t>(seedShare * static_cast<double>(seeds.size())), seeds.size() - 1);
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(last),
                     distances.end());
    std::erase_if(seeds, [&](std::uint32_t v) { return influence.distance[v] > distances[last]; });
    return seeds;
}

/// The seed of each influence that is farthest, along the skin, from the seeds of all others.
std::vector<std::uint32_t> endsOf(const std::vector<std::uint32_t>& influence,
                                  const std::vector<double>& nearest, const std::vector<double>& second,
                                  std::size_t influences) {
    std::vector<std::uint32_t> ends;
    for (std::size_t h = 0; h < influences; ++h) {
        double farthest = 0;
        for (std::uint32_t v = 0; v < influence.size(); ++v)
            if (influence[v] == h && nearest[v] == 0 && std::isfinite(second[v]) && second[v] > farthest) {
                if (farthest == 0) ends.push_back(v);
                farthest = second[v];
                ends.back() = v;
            }
    }
    return ends;
}

/// For each vertex the distance between the seed that claims it and the nearest seed of another influence,
/// the unit of its certainty. So a limb without bones is claimed up to its end as firmly as the skin that it
/// is attached to.
std::vector<double> gapsOf(const SkinGraph& graph, const std::vector<std::uint32_t>& influence,
                           const std::vector<double>& nearest, const std::vector<double>& second) {
    std::vector<std::uint32_t> order(nearest.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return nearest[a] < nearest[b]; });
    std::vector<double> gap = second;
    for (const std::uint32_t v : order) {
        double least = nearest[v] > 0 && std::isfinite(nearest[v]) ? infinity : 0;
        for (const SkinGraph::Edge& edge : graph.edges[v]) {
            const double by = nearest[edge.to] + edge.length;
            if (influence[edge.to] != influence[v] || nearest[edge.to] >= nearest[v] || by >= least) continue;
            least = by;
            gap[v] = gap[edge.to];
        }
    }
    return gap;
}

Claims claim(const TriangleMesh& skin, const SkinGraph& graph, const std::vector<SkinInfluence>& influences) {
    const std::size_t count = graph.vertices();
    std::vector<double> nearest(count, infinity), second(count, infinity);
    Claims claims{std::vector<std::uint32_t>(count, 0), {}, {}, {}, {}};
    std::vector<std::uint32_t> rival(count, 0);
    std::vector<std::vector<std::uint32_t>> seeds = seedsOf(influences);
    std::vector<std::int64_t> owner(count, -1);
    for (std::uint32_t h = 0; h < influences.size(); ++h)
        for (const std::uint32_t v : influences[h].certain) owner[v] = h;
    for (std::uint32_t h = 0; h < influences.size(); ++h) {
        std::vector<double> along(count, infinity);
        std::vector<std::uint32_t>& sources = seeds[h];
        std::erase_if(sources, [&](std::uint32_t v) { return owner[v] >= 0 && owner[v] != h; });
        sources.insert(sources.end(), influences[h].certain.begin(), influences[h].certain.end());
        lowerDistances(graph, sources, infinity, along);
        for (std::size_t v = 0; v < count; ++v) {
            if (along[v] < nearest[v]) {
                second[v] = nearest[v];
                rival[v] = claims.influence[v];
                nearest[v] = along[v];
                claims.influence[v] = h;
            } else if (along[v] < second[v]) {
                second[v] = along[v];
                rival[v] = h;
            }
        }
    }
    const std::vector<double> gap = gapsOf(graph, claims.influence, nearest, second);
    claims.ends = endsOf(claims.influence, nearest, second, influences.size());
    claims.shells = bindShells(skin, influences, nearest);
    for (std::size_t v = 0; v < count; ++v) {
        const bool ofShell = !std::isfinite(nearest[v]);
        if (ofShell) claims.influence[v] = claims.shells[v].influence;
        if (!std::isfinite(second[v])) rival[v] = claims.influence[v];
        const SkinInfluence& own = influences[claims.influence[v]];
        double size = std::min(own.size, influences[rival[v]].size);
        if (!std::isfinite(size))
            for (const SkinInfluence& h : influences) size = std::min(size, h.size);
        double certainty = std::isfinite(second[v]) && second[v] > 0 ? 0 : 1;
        if (certainty == 0 && nearest[v] < second[v]) certainty = (second[v] - nearest[v]) / gap[v];
        const double close = closeShare * size;
        double distance =
            std::max(owner[v] >= 0 ? std::min(own.distance[v], certainShare * size) : own.distance[v], close);
        if (ofShell) { // of a thing held in a hand, the end at the hand counts most
            distance = std::max(claims.shells[v].distance, close);
            distance *= distance / std::max(claims.shells[v].least, close);
        }
        claims.size.push_back(size);
        claims.weight.push_back(graph.area[v] / (distance * distance) *
                                std::max(claimWeight * std::pow(certainty, certaintyPower), 1e-9));
    }
    return claims;
}

/// Sets the stiffness of each triangle by the gradients of the shares in it.
void stiffen(const TriangleMesh& skin, const Claims& claims, const std::vector<std::vector<double>>& shares,
             std::vector<double>& stiffness) {
    for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
        const Tri& t = skin.triangles[i];
        const Vec3 u = skin.vertices[t[1]] - skin.vertices[t[0]],
                   v = skin.vertices[t[2]] - skin.vertices[t[0]];
        const double squared = u.cross(v).squaredNorm();
        if (!(squared > 0)) continue;
        double slope = 0;
        for (const std::vector<double>& share : shares) {
            const double du = share[t[1]] - share[t[0]], dv = share[t[2]] - share[t[0]];
            slope +=
                (du * v - dv * u).squaredNorm() / squared / 2; // halved: where one share falls another rises
        }
        const double size = claims.size[t[0]] / steepShare;
        stiffness[i] = (stiffness[i] + 1 + slope * size * size) / 2;
    }
}

/// Makes triangles stiffer that a motion shrinks too much or flips. Returns whether there are any.
bool stiffenFolded(const TriangleMesh& skin, const std::vector<std::vector<double>>& shares,
                   const ShareOptions& options, std::vector<double>& stiffness) {
    std::vector<char> folded(skin.triangles.size(), 0);
    std::vector<Pose> poses(skin.vertices.size());
    for (const std::vector<DualPose>& motion : options.motions) {
        parallelFor(poses.size(), [&](std::size_t v) {
            const double free = options.tether.empty() ? 1 : 1 - options.tether[v];
            PoseBlend blend(options.keepSigns);
            for (std::size_t h = 0; h < motion.size(); ++h) blend.add(free * shares[h][v], motion[h]);
            poses[v] = blend.pose();
        });
        for (std::size_t i = 0; i < folded.size(); ++i) {
            const Tri& t = skin.triangles[i];
            Vec3 rest[3], now[3];
            for (int k = 0; k < 3; ++k) now[k] = poses[t[k]] * (rest[k] = skin.vertices[t[k]]);
            const Vec3 before = poses[t[0]].linear() * (rest[1] - rest[0]).cross(rest[2] - rest[0]),
                       after = (now[1] - now[0]).cross(now[2] - now[0]);
            if (after.dot(before) < leastArea * before.squaredNorm()) folded[i] = 1;
        }
    }
    for (std::size_t i = 0; i < folded.size(); ++i)
        if (folded[i]) stiffness[i] *= options.stiffening;
    return std::find(folded.begin(), folded.end(), 1) != folded.end();
}

/// Solves for the shares from the claims. Shells bound in different rounds are not connected: each round is a
/// linear system of its own, solved after those that its vertices are bound to.
class ClaimSolver {
public:
    ClaimSolver(const TriangleMesh& skin, const Claims& claims)
        : skin_(skin), claims_(claims), place_(claims.influence.size()) {
        for (std::size_t v = 0; v < place_.size(); ++v) {
            std::vector<std::uint32_t>& vertices = rounds_[roundOf(v)].vertices;
            place_[v] = static_cast<int>(vertices.size());
            vertices.push_back(static_cast<std::uint32_t>(v));
        }
    }

    void solve(const std::vector<double>& stiffness, std::vector<std::vector<double>>& shares) {
        const SparseMatrix laplacian = skinLaplacian(skin_, stiffness);
        for (auto& [number, round] : rounds_) {
            const auto size = static_cast<Eigen::Index>(round.vertices.size());
            std::vector<Eigen::Triplet<double>> entries;
            for (const std::uint32_t v : round.vertices) {
                entries.emplace_back(place_[v], place_[v], claims_.weight[v]);
                for (SparseMatrix::InnerIterator e(laplacian, v); e; ++e)
                    entries.emplace_back(place_[e.row()], place_[v], e.value());
            }
            SparseMatrix system(size, size);
            system.setFromTriplets(entries.begin(), entries.end());
            if (round.solver.rows() != size) round.solver.analyzePattern(system);
            round.solver.factorize(system);
            for (std::size_t h = 0; h < shares.size(); ++h) {
                Eigen::VectorXd right(size);
                for (const std::uint32_t v : round.vertices)
                    right[place_[v]] = claims_.weight[v] * claimed(shares, h, v);
                const Eigen::VectorXd solved = round.solver.solve(right);
                for (const std::uint32_t v : round.vertices)
                    shares[h][v] = std::clamp(solved[place_[v]], 0.0, 1.0);
            }
        }
    }

private:
    struct Round {
        std::vector<std::uint32_t> vertices;
        Eigen::SimplicialLDLT<SparseMatrix> solver;
    };

    int roundOf(std::size_t v) const { return claims_.shells.empty() ? -1 : claims_.shells[v].round; }

    /// The share of an influence that a vertex's claim asks for.
    double claimed(const std::vector<std::vector<double>>& shares, std::size_t h, std::uint32_t v) const {
        if (roundOf(v) < 0 || claims_.shells[v].weights.isZero(0)) return claims_.influence[v] == h;
        double share = 0;
        for (int k = 0; k < 3; ++k)
            share += claims_.shells[v].weights[k] * shares[h][claims_.shells[v].skin[k]];
        return share;
    }

    const TriangleMesh& skin_;
    const Claims& claims_;
    std::vector<int> place_;      ///< #V: row in the system of its round
    std::map<int, Round> rounds_; ///< by number; -1: skin that is not of a shell
};

} // namespace

/// All influences by the first rule or all by the second: with different rules one would reach farther than
/// its neighbour.
std::vector<std::vector<std::uint32_t>> seedsOf(const std::vector<SkinInfluence>& influences) {
    std::vector<std::vector<std::uint32_t>> clear, seeds;
    bool all = true;
    for (std::size_t h = 0; h < influences.size(); ++h) {
        const std::vector<double> contrast = contrastOf(influences, h);
        seeds.push_back(seedsByContrast(influences[h], contrast));
        const bool sized = std::isfinite(influences[h].size);
        clear.push_back(sized ? seedsByDistance(influences[h], contrast) : seeds.back());
        all = all && !clear.back().empty();
    }
    return all ? clear : seeds;
}

std::vector<std::vector<double>> claimedShares(const TriangleMesh& skin, const SkinGraph& graph,
                                               const std::vector<SkinInfluence>& influences,
                                               const ShareOptions& options) {
    const std::size_t count = graph.vertices();
    std::vector<std::vector<double>> shares(influences.size(), std::vector<double>(count, 1));
    if (influences.size() < 2 || count == 0) return shares;
    const Claims claims = claim(skin, graph, influences);
    std::vector<double> stiffness(skin.triangles.size(), 1);
    ClaimSolver solver(skin, claims);
    solver.solve(stiffness, shares);
    for (int round = 0; round < steepRounds; ++round) {
        stiffen(skin, claims, shares, stiffness);
        solver.solve(stiffness, shares);
    }
    for (int round = 0; round < options.maxRounds && stiffenFolded(skin, shares, options, stiffness);
         ++round) {
        std::vector<std::vector<double>> before = shares;
        solver.solve(stiffness, shares);
        for (const std::uint32_t v : claims.ends)
            if (shares[claims.influence[v]][v] < options.leastAtEnds) return before;
    }
    return shares;
}

void unfoldShares(const TriangleMesh& skin, const SkinGraph& graph, double reach, const ShareOptions& options,
                  std::vector<std::vector<double>>& shares) {
    const auto rows = static_cast<Eigen::Index>(graph.vertices());
    Eigen::VectorXd mass(rows);
    for (Eigen::Index v = 0; v < rows; ++v) // a vertex of no triangle keeps its own
        mass[v] = graph.area[v] > 0 ? graph.area[v] / (reach * reach) : 1;
    const std::vector<std::vector<double>> before = shares;
    std::vector<double> stiffness(skin.triangles.size(), 1), beyond;
    Eigen::SimplicialLDLT<SparseMatrix> solver;
    for (int round = 0; round < options.maxRounds && stiffenFolded(skin, shares, options, stiffness);
         ++round) {
        beyond = stiffness;
        for (double& b : beyond) b -= 1;
        SparseMatrix system = skinLaplacian(skin, beyond);
        for (Eigen::Index v = 0; v < rows; ++v) system.coeffRef(v, v) += mass[v];
        if (round == 0) solver.analyzePattern(system);
        solver.factorize(system);
        for (std::size_t h = 0; h < shares.size(); ++h) {
            const Eigen::Map<const Eigen::VectorXd> target(before[h].data(), rows);
            const Eigen::VectorXd solved = solver.solve(mass.cwiseProduct(target));
            for (Eigen::Index v = 0; v < rows; ++v)
                shares[h][static_cast<std::size_t>(v)] = std::clamp(solved[v], 0.0, 1.0);
        }
    }
}

void spreadOver(const TriangleMesh& skin, const SkinGraph& graph, double reach,
                std::span<const double> firmness, std::vector<std::vector<double>>& values) {
    const auto rows = static_cast<Eigen::Index>(graph.vertices());
    if (rows == 0 || values.empty() || !(reach > 0)) return;
    SparseMatrix mass(rows, rows);
    mass.setIdentity();
    for (Eigen::Index v = 0; v < rows; ++v)
        mass.coeffRef(v, v) = firmness[v] * graph.area[v] / (reach * reach);
    const SparseMatrix system = skinLaplacian(skin) + mass;
    const Eigen::SimplicialLDLT<SparseMatrix> solver(system);
    for (std::vector<double>& list : values) {
        Eigen::Map<Eigen::VectorXd> value(list.data(), rows);
        value = solver.solve(mass * value).eval();
        for (double& v : list) v = std::max(v, 0.0);
    }
}

} // namespace tss
