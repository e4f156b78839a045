#include "bake/bind/SkinShares.h"

#include "bake/base/Parallel.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <map>

namespace tss {
namespace {

/// A triangle gets twice as stiff where a share changes by this much over one size of the influence, without
/// a unit: so skin does not fold where two influences meet at a point, as at the corner of a mouth.
constexpr double steepShare = 3;
/// Of solves that see the slope of the one before: with one, a jaw that is shut with its muscles turns skin
/// over.
constexpr int steepRounds = 3;
/// A triangle that a motion would shrink below this share of its area, or flip, is made stiffer. The margin
/// is for muscles and contacts.
constexpr double leastArea = 0.15;
/// It is made as stiff as would leave it this share, if all others stayed as they are. Aimed at leastArea
/// itself, triangles would come ever nearer to that and not get there.
constexpr double wantedArea = 2 * leastArea;
/// Shares below this become 0, so that skin that hardly moves is not touched.
constexpr double leastShare = 1e-3;

/// Applies withoutLeast() to all shares of each vertex, and normalises them.
std::vector<std::vector<double>> usedShares(std::vector<std::vector<double>> shares) {
    for (std::size_t v = 0; v < shares[0].size(); ++v) {
        double sum = 0;
        for (std::vector<double>& list : shares) sum += list[v] = withoutLeast(list[v]);
        for (std::vector<double>& list : shares)
            if (sum > 0) list[v] /= sum;
    }
    return shares;
}

/// Sets the stiffness of each triangle by the gradients of the shares in it.
void stiffen(const TriangleMesh& skin, const SkinClaims& claims,
             const std::vector<std::vector<double>>& shares, std::vector<double>& stiffness) {
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

/// Which triangles any motion may bend: of the others all corners go with one and the same influence.
std::vector<std::uint32_t> bendable(const TriangleMesh& skin, const std::vector<std::vector<double>>& shares,
                                    std::span<const double> tether) {
    constexpr double whole = 1 - 1e-9;
    std::vector<std::size_t> wholly(shares[0].size(), shares.size()); // of each vertex, if any
    for (std::size_t h = 0; h < shares.size(); ++h)
        for (std::size_t v = 0; v < wholly.size(); ++v)
            if (shares[h][v] > whole && (tether.empty() || tether[v] == 0)) wholly[v] = h;
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < skin.triangles.size(); ++i) {
        const Tri& t = skin.triangles[i];
        if (wholly[t[0]] == shares.size() || wholly[t[0]] != wholly[t[1]] || wholly[t[0]] != wholly[t[2]])
            result.push_back(i);
    }
    return result;
}

/// Makes triangles stiffer that a motion shrinks too much or flips, each by as much as its shares change too
/// fast: what it loses of its area is in proportion to that. Returns whether there are any.
bool stiffenFolded(const TriangleMesh& skin, const std::vector<std::vector<double>>& shares,
                   const ShareOptions& options, std::vector<double>& stiffness) {
    const std::vector<std::uint32_t> triangles = bendable(skin, shares, options.tether);
    std::vector<char> bends(skin.vertices.size(), 0);
    for (const std::uint32_t i : triangles)
        for (const int v : skin.triangles[i]) bends[v] = 1;
    // Of each triangle's area what is left at worst, seen along its normal as turned at any of its corners.
    std::vector<double> left(skin.triangles.size(), 1);
    std::vector<Pose> poses(skin.vertices.size());
    for (const std::vector<DualPose>& motion : options.motions) {
        parallelFor(poses.size(), [&](std::size_t v) {
            if (!bends[v]) return;
            const double free = options.tether.empty() ? 1 : 1 - options.tether[v];
            PoseBlend blend(options.keepSigns);
            for (std::size_t h = 0; h < motion.size(); ++h)
                if (shares[h][v] > 0) blend.add(free * shares[h][v], motion[h]);
            poses[v] = blend.pose();
        });
        parallelFor(triangles.size(), [&](std::size_t k) {
            const std::uint32_t i = triangles[k];
            const Tri& t = skin.triangles[i];
            Vec3 rest[3], now[3];
            for (int c = 0; c < 3; ++c) now[c] = poses[t[c]] * (rest[c] = skin.vertices[t[c]]);
            const Vec3 before = (rest[1] - rest[0]).cross(rest[2] - rest[0]),
                       after = (now[1] - now[0]).cross(now[2] - now[0]);
            const double squared = before.squaredNorm();
            for (int c = 0; c < 3 && squared > 0; ++c)
                left[i] = std::min(left[i], after.dot(poses[t[c]].linear() * before) / squared);
        });
    }
    bool any = false;
    for (std::size_t i = 0; i < left.size(); ++i) {
        if (left[i] >= leastArea) continue;
        stiffness[i] *= (1 - left[i]) / (1 - wantedArea);
        any = true;
    }
    return any;
}

/// Solves for the shares from the claims. Shells bound in different rounds are not connected: each round is a
/// linear system of its own, solved after those that its vertices are bound to.
class ClaimSolver {
public:
    ClaimSolver(const TriangleMesh& skin, const SkinClaims& claims)
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
            parallelFor(shares.size(), [&, &round = round](std::size_t h) {
                Eigen::VectorXd right(size);
                for (const std::uint32_t v : round.vertices)
                    right[place_[v]] = claims_.weight[v] * claimed(shares, h, v);
                const Eigen::VectorXd solved = round.solver.solve(right);
                for (const std::uint32_t v : round.vertices)
                    shares[h][v] = std::clamp(solved[place_[v]], 0.0, 1.0);
            });
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
    const SkinClaims& claims_;
    std::vector<int> place_;      ///< #V: row in the system of its round
    std::map<int, Round> rounds_; ///< by number; -1: skin that is not of a shell
};

} // namespace

double withoutLeast(double share) {
    return share > leastShare ? (share - leastShare) / (1 - leastShare) : 0;
}

std::vector<std::vector<double>> claimedShares(const TriangleMesh& skin, const SkinGraph& graph,
                                               const std::vector<SkinInfluence>& influences,
                                               const ShareOptions& options) {
    const std::size_t count = graph.vertices();
    std::vector<std::vector<double>> shares(influences.size(), std::vector<double>(count, 1));
    if (influences.size() < 2 || count == 0) return shares;
    const SkinClaims claims = claimSkin(skin, graph, influences);
    std::vector<double> stiffness(skin.triangles.size(), 1);
    ClaimSolver solver(skin, claims);
    solver.solve(stiffness, shares);
    for (int round = 0; round < steepRounds; ++round) {
        stiffen(skin, claims, shares, stiffness);
        solver.solve(stiffness, shares);
    }
    std::vector<std::vector<double>> used = usedShares(shares);
    for (int round = 0; round < options.maxRounds && stiffenFolded(skin, used, options, stiffness); ++round) {
        solver.solve(stiffness, shares);
        used = usedShares(shares);
    }
    return used;
}

void unfoldShares(const TriangleMesh& skin, const SkinGraph& graph, double reach, const ShareOptions& options,
                  std::vector<std::vector<double>>& shares) {
    const auto rows = static_cast<Eigen::Index>(graph.vertices());
    Eigen::VectorXd mass(rows);
    for (Eigen::Index v = 0; v < rows; ++v) mass[v] = graph.area[v] / (reach * reach);
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
