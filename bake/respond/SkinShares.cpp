#include "bake/respond/SkinShares.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace tss {
namespace {

/// A seed lies near its holder and far from all others, in sizes of the holder, and this many times nearer: a
/// closed upper lip lies on the lower teeth, but so far from the upper jaw it never is.
constexpr double seedNear = 0.08, seedFar = 0.12, seedNearer = 2.5;
/// Unless less than this share of what is so much nearer lies near: a bone that is thin in its flesh would
/// hold skin at its ends alone.
constexpr double seedNearShare = 0.5;
/// Where there is none, as on thin limbs and between teeth, what is nearer to its holder than to all others
/// by this share of the most that any vertex is. Less, and skin that only passes another bone counts as its
/// own; more, and a bone with little skin has none.
constexpr double seedContrast = 0.2;
/// Of those the nearest ones count: the rest lies far off, beyond the ends of the holder.
constexpr double seedShare = 0.8;
/// Distances below this share of the holder's size are alike: that is how thick the tissue on a bone may be
/// before its hold gets weaker.
constexpr double closeShare = 0.01;
/// What is a holder's own for certain is held as if it were no farther than this share of its size.
constexpr double sureShare = 0.15;
/// How much a claim weighs against the change of shares along the skin.
constexpr double claimWeight = 8;
/// How fast the certainty of a claim grows with the distance from where two claims meet.
constexpr int certaintyPower = 8;
/// A share that changes by this much along a length of one size of the holder counts twice; so skin does not
/// fold where two holders meet at a point, as at the corner of a mouth. Without a unit.
constexpr double steepShare = 3;
constexpr int steepRounds = 3; ///< of solves that see the slope of the one before
/// Where bones would draw a triangle together to less than this share of its area, or turn it over, it is
/// made stiffer: a little is left for muscles and contacts to take.
constexpr double leastArea = 0.15;

struct Claims {
    std::vector<std::uint32_t> holder; ///< #V
    std::vector<double> weight;        ///< #V, how firmly: area over squared distance, without a unit
    std::vector<double> size;          ///< #V, of the smaller one of the two that meet here
    std::vector<ShellVertex> shells;   ///< #V; empty where all skin has a seed
    std::vector<std::uint32_t> ends;   ///< #holders or fewer: see SkinStrokes::leastAtEnds
};

/// For each vertex how much farther than a holder the nearest other one is; infinite for the only one.
std::vector<double> contrastOf(const std::vector<SkinHolder>& holders, std::size_t index) {
    const std::vector<double>& own = holders[index].distance;
    std::vector<double> contrast(own.size(), infinity);
    for (std::size_t h = 0; h < holders.size(); ++h)
        for (std::size_t v = 0; v < own.size() && h != index; ++v)
            contrast[v] = std::min(contrast[v], holders[h].distance[v] - own[v]);
    return contrast;
}

/// Empty where too few of those that lie far from all others lie near to it.
std::vector<std::uint32_t> undisputed(const SkinHolder& holder, const std::vector<double>& contrast) {
    std::vector<std::uint32_t> seeds;
    std::size_t apart = 0;
    for (std::uint32_t v = 0; v < contrast.size(); ++v) {
        const double own = holder.distance[v];
        if (contrast[v] + own <= std::max(seedFar * holder.size, seedNearer * own)) continue;
        ++apart;
        if (own < seedNear * holder.size) seeds.push_back(v);
    }
    if (static_cast<double>(seeds.size()) < seedNearShare * static_cast<double>(apart)) seeds.clear();
    return seeds;
}

std::vector<std::uint32_t> mostContrasting(const SkinHolder& holder, std::vector<double> contrast) {
    for (std::size_t v = 0; v < holder.apart.size(); ++v)
        if (holder.apart[v]) contrast[v] = -infinity;
    const double most = *std::max_element(contrast.begin(), contrast.end());
    std::vector<std::uint32_t> seeds;
    std::vector<double> distances;
    for (std::uint32_t v = 0; v < contrast.size(); ++v)
        if (contrast[v] > seedContrast * std::max(most, 0.0)) {
            seeds.push_back(v);
            distances.push_back(holder.distance[v]);
        }
    if (seeds.empty()) return seeds;
    const auto last =
        std::min(static_cast<std::size_t>(seedShare * static_cast<double>(seeds.size())), seeds.size() - 1);
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(last),
                     distances.end());
    std::erase_if(seeds, [&](std::uint32_t v) { return holder.distance[v] > distances[last]; });
    return seeds;
}

/// Of each holder that has a seed the one that lies farthest, along the skin, from the seeds of others.
std::vector<std::uint32_t> endsOf(const std::vector<std::uint32_t>& holder,
                                  const std::vector<double>& nearest, const std::vector<double>& second,
                                  std::size_t holders) {
    std::vector<std::uint32_t> ends;
    for (std::size_t h = 0; h < holders; ++h) {
        double farthest = 0;
        for (std::uint32_t v = 0; v < holder.size(); ++v)
            if (holder[v] == h && nearest[v] == 0 && std::isfinite(second[v]) && second[v] > farthest) {
                if (farthest == 0) ends.push_back(v);
                farthest = second[v];
                ends.back() = v;
            }
    }
    return ends;
}

/// How far the seed that claims each vertex is from the nearest seed of others. So a limb none of whose bones
/// are named is claimed, up to its end, as firmly as the skin that it hangs on.
std::vector<double> gapsOf(const SkinGraph& graph, const std::vector<std::uint32_t>& holder,
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
            if (holder[edge.to] != holder[v] || nearest[edge.to] >= nearest[v] || by >= least) continue;
            least = by;
            gap[v] = gap[edge.to];
        }
    }
    return gap;
}

Claims claim(const TriangleMesh& skin, const SkinGraph& graph, const std::vector<SkinHolder>& holders) {
    const std::size_t count = graph.vertices();
    std::vector<double> nearest(count, infinity), second(count, infinity);
    Claims claims{std::vector<std::uint32_t>(count, 0), {}, {}, {}, {}};
    std::vector<std::uint32_t> rival(count, 0);
    std::vector<std::vector<std::uint32_t>> seeds = seedsOf(holders);
    std::vector<std::int64_t> owner(count, -1);
    for (std::uint32_t h = 0; h < holders.size(); ++h)
        for (const std::uint32_t v : holders[h].sure) owner[v] = h;
    for (std::uint32_t h = 0; h < holders.size(); ++h) {
        std::vector<double> along(count, infinity);
        std::vector<std::uint32_t>& sources = seeds[h];
        std::erase_if(sources, [&](std::uint32_t v) { return owner[v] >= 0 && owner[v] != h; });
        sources.insert(sources.end(), holders[h].sure.begin(), holders[h].sure.end());
        lowerDistances(graph, sources, infinity, along);
        for (std::size_t v = 0; v < count; ++v) {
            if (along[v] < nearest[v]) {
                second[v] = nearest[v];
                rival[v] = claims.holder[v];
                nearest[v] = along[v];
                claims.holder[v] = h;
            } else if (along[v] < second[v]) {
                second[v] = along[v];
                rival[v] = h;
            }
        }
    }
    const std::vector<double> gap = gapsOf(graph, claims.holder, nearest, second);
    claims.ends = endsOf(claims.holder, nearest, second, holders.size());
    claims.shells = heldShells(skin, holders, nearest);
    for (std::size_t v = 0; v < count; ++v) {
        const bool ofShell = !std::isfinite(nearest[v]);
        if (ofShell) claims.holder[v] = claims.shells[v].holder;
        if (!std::isfinite(second[v])) rival[v] = claims.holder[v];
        const SkinHolder& own = holders[claims.holder[v]];
        double size = std::min(own.size, holders[rival[v]].size);
        if (!std::isfinite(size))
            for (const SkinHolder& h : holders) size = std::min(size, h.size);
        double certainty = std::isfinite(second[v]) && second[v] > 0 ? 0 : 1;
        if (certainty == 0 && nearest[v] < second[v]) certainty = (second[v] - nearest[v]) / gap[v];
        const double close = closeShare * size;
        double distance =
            std::max(owner[v] >= 0 ? std::min(own.distance[v], sureShare * size) : own.distance[v], close);
        if (ofShell) { // of a thing that is held the end at the hand counts
            distance = std::max(claims.shells[v].distance, close);
            distance *= distance / std::max(claims.shells[v].least, close);
        }
        claims.size.push_back(size);
        claims.weight.push_back(graph.area[v] / (distance * distance) *
                                std::max(claimWeight * std::pow(certainty, certaintyPower), 1e-9));
    }
    return claims;
}

/// How much stiffer each triangle gets by the slopes of the shares in it.
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
            slope += (du * v - dv * u).squaredNorm() / squared / 2; // both sides of a border have it
        }
        const double size = claims.size[t[0]] / steepShare;
        stiffness[i] = (stiffness[i] + 1 + slope * size * size) / 2;
    }
}

/// Makes those triangles stiffer that a motion draws together too much, or turns over. Returns whether there
/// are any.
bool stiffenDrawn(const TriangleMesh& skin, const std::vector<std::vector<double>>& shares,
                  const SkinStrokes& strokes, std::vector<double>& stiffness) {
    std::vector<char> drawn(skin.triangles.size(), 0);
    std::vector<Pose> poses(skin.vertices.size());
    for (const std::vector<DualPose>& motion : strokes.motions) {
        parallelFor(poses.size(), [&](std::size_t v) {
            const double free = strokes.tether.empty() ? 1 : 1 - strokes.tether[v];
            PoseBlend blend(strokes.asGiven);
            for (std::size_t h = 0; h < motion.size(); ++h) blend.add(free * shares[h][v], motion[h]);
            poses[v] = blend.pose();
        });
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            const Tri& t = skin.triangles[i];
            Vec3 rest[3], now[3];
            for (int k = 0; k < 3; ++k) now[k] = poses[t[k]] * (rest[k] = skin.vertices[t[k]]);
            const Vec3 before = poses[t[0]].linear() * (rest[1] - rest[0]).cross(rest[2] - rest[0]),
                       after = (now[1] - now[0]).cross(now[2] - now[0]);
            if (after.dot(before) < leastArea * before.squaredNorm()) drawn[i] = 1;
        }
    }
    for (std::size_t i = 0; i < drawn.size(); ++i)
        if (drawn[i]) stiffness[i] *= strokes.stiffer;
    return std::find(drawn.begin(), drawn.end(), 1) != drawn.end();
}

/// Spreads the claims over the skin. What was held in one round hangs together with nothing of another: each
/// is a system of its own, and what its vertices go with is solved before.
class ClaimSpread {
public:
    ClaimSpread(const TriangleMesh& skin, const Claims& claims)
        : skin_(skin), claims_(claims), place_(claims.holder.size()) {
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

    /// The share of a holder that a vertex's claim asks for.
    double claimed(const std::vector<std::vector<double>>& shares, std::size_t h, std::uint32_t v) const {
        if (roundOf(v) < 0 || claims_.shells[v].weights.isZero(0)) return claims_.holder[v] == h;
        double share = 0;
        for (int k = 0; k < 3; ++k)
            share += claims_.shells[v].weights[k] * shares[h][claims_.shells[v].skin[k]];
        return share;
    }

    const TriangleMesh& skin_;
    const Claims& claims_;
    std::vector<int> place_;      ///< #V, in its round
    std::map<int, Round> rounds_; ///< -1: skin that has a seed
};

} // namespace

/// All by the one rule or all by the other, or one would reach farther than the next.
std::vector<std::vector<std::uint32_t>> seedsOf(const std::vector<SkinHolder>& holders) {
    std::vector<std::vector<std::uint32_t>> clear, seeds;
    bool all = true;
    for (std::size_t h = 0; h < holders.size(); ++h) {
        const std::vector<double> contrast = contrastOf(holders, h);
        seeds.push_back(mostContrasting(holders[h], contrast));
        const bool sized = std::isfinite(holders[h].size);
        clear.push_back(sized ? undisputed(holders[h], contrast) : seeds.back());
        all = all && !clear.back().empty();
    }
    return all ? clear : seeds;
}

std::vector<std::vector<double>> claimedShares(const TriangleMesh& skin, const SkinGraph& graph,
                                               const std::vector<SkinHolder>& holders,
                                               const SkinStrokes& strokes) {
    const std::size_t count = graph.vertices();
    std::vector<std::vector<double>> shares(holders.size(), std::vector<double>(count, 1));
    if (holders.size() < 2 || count == 0) return shares;
    const Claims claims = claim(skin, graph, holders);
    std::vector<double> stiffness(skin.triangles.size(), 1);
    ClaimSpread spread(skin, claims);
    spread.solve(stiffness, shares);
    for (int round = 0; round < steepRounds; ++round) {
        stiffen(skin, claims, shares, stiffness);
        spread.solve(stiffness, shares);
    }
    for (int round = 0; round < strokes.rounds && stiffenDrawn(skin, shares, strokes, stiffness); ++round) {
        std::vector<std::vector<double>> before = shares;
        spread.solve(stiffness, shares);
        for (const std::uint32_t v : claims.ends)
            if (shares[claims.holder[v]][v] < strokes.leastAtEnds) return before;
    }
    return shares;
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
