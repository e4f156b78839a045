#include "bake/respond/SkinFoundation.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Distance of the nodes, in lengths l: closer ones would resolve what the sheet smooths away.
constexpr double nodeSpacing = 0.8;
/// Radius of a node's weight function, in node spacings. More than 1, as every vertex is nearer than that to
/// some node; but so small that where every vertex is a node, six neighbours together weigh less than the
/// node itself, or nodes could move against each other without moving any vertex.
constexpr double nodeReach = 1.25;
/// A column is truncated where it is below this share of its peak, and fades out up to twice that.
constexpr double columnCut = 3e-3;
constexpr std::size_t nodesAPatch =
    48; ///< columns that are solved with one factorisation, on one patch of the skin

/// Chooses nodes at least `spacing` apart along the skin. Returns, nodes by vertices, the weights in each
/// vertex of the nodes around it, which fall off smoothly. near: #V, vertices that need nodes. at: receives
/// the nodes' vertices.
SparseMatrix chooseNodes(const SkinGraph& graph, const std::vector<bool>& near, double spacing,
                         std::vector<std::uint32_t>& at) {
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<double> distance(graph.vertices(), infinity), sums(graph.vertices(), 0);
    std::vector<bool> covered(graph.vertices(), false);
    for (std::uint32_t v = 0; v < graph.vertices(); ++v) {
        if (covered[v] || !near[v]) continue;
        for (const std::uint32_t w : lowerDistances(graph, std::span(&v, 1), nodeReach * spacing, distance)) {
            const double t = distance[w] / (nodeReach * spacing), weight = (1 - t * t) * (1 - t * t);
            if (distance[w] < spacing) covered[w] = true;
            distance[w] = infinity;
            if (!near[w] || !(t < 1)) continue;
            entries.emplace_back(static_cast<int>(at.size()), static_cast<int>(w), weight);
            sums[w] += weight;
        }
        at.push_back(v);
    }
    for (auto& e : entries) e = {e.row(), e.col(), e.value() / sums[static_cast<std::size_t>(e.col())]};
    SparseMatrix weights(static_cast<Eigen::Index>(at.size()), static_cast<Eigen::Index>(graph.vertices()));
    weights.setFromTriplets(entries.begin(), entries.end());
    return weights;
}

/// The sheet's matrix B, on nodes.
SparseMatrix sheetOn(const TriangleMesh& skin, const SkinGraph& graph, const SparseMatrix& weights,
                     const std::vector<double>& firmness, double length, double stretch, double bend) {
    Eigen::VectorXd mass = Eigen::VectorXd::Map(graph.area.data(), weights.cols());
    const SparseMatrix spread = weights.transpose(), bent = skinLaplacian(skin) * spread;
    SparseMatrix sheet = stretch * (weights * bent);
    sheet +=
        bend * length * length * SparseMatrix(bent.transpose() * mass.cwiseInverse().asDiagonal() * bent);
    mass.array() *= Eigen::ArrayXd::Map(firmness.data(), mass.size());
    sheet += SparseMatrix(weights * mass.asDiagonal() * spread) / (length * length);
    return sheet;
}

using Columns = std::vector<std::vector<std::pair<std::uint32_t, float>>>; ///< #nodes

/// Solves for the columns of some nodes on a patch around them all, with the rest of the skin fixed.
void solvePatch(const SparseMatrix& sheet, const std::vector<Vec3>& places,
                std::span<const std::uint32_t> wanted, double reach, Columns& columns) {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t n : wanted) box.extend(places[n]);
    std::vector<std::uint32_t> patch;
    std::vector<int> local(places.size(), -1);
    for (std::uint32_t n = 0; n < places.size(); ++n)
        if (box.squaredExteriorDistance(places[n]) < reach * reach) {
            local[n] = static_cast<int>(patch.size());
            patch.push_back(n);
        }
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t k = 0; k < patch.size(); ++k)
        for (SparseMatrix::InnerIterator it(sheet, static_cast<Eigen::Index>(patch[k])); it; ++it)
            if (local[it.row()] >= 0) entries.emplace_back(local[it.row()], static_cast<int>(k), it.value());
    const auto size = static_cast<Eigen::Index>(patch.size());
    SparseMatrix part(size, size);
    part.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<SparseMatrix> solver(part);
    for (const std::uint32_t n : wanted) {
        const Eigen::VectorXd x = solver.solve(Eigen::VectorXd::Unit(size, local[n]));
        const double peak = x.cwiseAbs().maxCoeff();
        for (std::size_t k = 0; k < patch.size(); ++k) {
            const double value = x[static_cast<Eigen::Index>(k)], above = std::abs(value) / peak - columnCut;
            if (!(above > 0)) continue;
            columns[n].emplace_back(patch[k], static_cast<float>(std::min(above / columnCut, 1.0) * value));
        }
    }
}

/// Makes truncation symmetric: an entry missing in one of two columns is removed from the other too.
void symmetrise(Columns& columns) {
    const auto entryOf = [&](std::uint32_t column, std::uint32_t node) -> float* {
        auto& list = columns[column];
        const auto found = std::ranges::lower_bound(list, node, {}, [](const auto& e) { return e.first; });
        return found == list.end() || found->first != node ? nullptr : &found->second;
    };
    for (std::uint32_t n = 0; n < columns.size(); ++n)
        for (auto& [other, value] : columns[n]) {
            if (other == n || columns[other].empty()) continue;
            float* const back = entryOf(other, n);
            value = back == nullptr ? 0 : * back = std::min(value, *back);
        }
    for (auto& column : columns) std::erase_if(column, [](const auto& entry) { return entry.second == 0; });
}

/// The columns of the nodes that are needed.
Columns solveColumns(const SparseMatrix& sheet, const std::vector<Vec3>& places,
                     const std::vector<bool>& needed, double reach) {
    std::vector<std::uint32_t> wanted = alongCurve(places);
    std::erase_if(wanted, [&](std::uint32_t n) { return !needed[n]; });
    Columns columns(places.size());
    const std::size_t patches = (wanted.size() + nodesAPatch - 1) / nodesAPatch;
    parallelFor(patches, [&](std::size_t p) {
        const std::size_t first = p * nodesAPatch, last = std::min(first + nodesAPatch, wanted.size());
        solvePatch(sheet, places, std::span(wanted).subspan(first, last - first), reach, columns);
    });
    symmetrise(columns);
    return columns;
}

} // namespace

SkinFoundation skinFoundation(const TriangleMesh& skin, const SkinGraph& graph,
                              const std::vector<bool>& pushed, const std::vector<double>& firmness,
                              double length, double stretchCompliance, double bendCompliance) {
    SkinFoundation foundation;
    foundation.length = length;
    std::vector<std::uint32_t> sources;
    for (std::uint32_t v = 0; v < pushed.size(); ++v)
        if (pushed[v]) sources.push_back(v);
    std::vector<double> distance(graph.vertices(), infinity);
    lowerDistances(graph, sources, columnReach * length, distance);
    std::vector<bool> near;
    for (const double d : distance) near.push_back(std::isfinite(d));
    std::vector<std::uint32_t> at;
    const SparseMatrix weights = chooseNodes(graph, near, nodeSpacing * length, at);
    using Entries = SparseMatrix::InnerIterator;
    foundation.nodes = at.size();
    std::vector<bool> needed(at.size(), false);
    for (const std::uint32_t v : sources)
        for (Entries it(weights, v); it; ++it) needed[it.row()] = true;
    std::vector<Vec3> places;
    for (const std::uint32_t v : at) places.push_back(skin.vertices[v]);
    const SparseMatrix sheet = sheetOn(skin, graph, weights, firmness, length, 1 / (1 + stretchCompliance),
                                       1 / (1 + bendCompliance));
    const Columns columns = solveColumns(sheet, places, needed, columnReach * length);

    float peak = 0;
    for (const auto& column : columns)
        for (const auto& entry : column) peak = std::max(peak, entry.second);
    for (Eigen::Index v = 0; v < weights.cols(); ++v) {
        for (Entries it(weights, v); it; ++it)
            foundation.weights.push_back(
                {static_cast<std::uint32_t>(it.row()), static_cast<float>(it.value())});
        foundation.weights.endList();
    }
    for (const auto& column : columns) {
        for (const auto& [node, value] : column) foundation.columns.push_back({node, value / peak});
        foundation.columns.endList();
    }
    return foundation;
}

} // namespace tss
