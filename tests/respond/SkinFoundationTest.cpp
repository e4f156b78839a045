// The tabulated answer of a skin to pushes, against a dense inverse of the same sheet (METHOD 6.5).
#include "bake/respond/SkinFoundation.h"

#include "tests/respond/SkinShapes.h"

#include <Eigen/Dense>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace tss;

TEST_CASE("a column of the foundation is what the whole sheet does, to a hundredth of its peak") {
    const TriangleMesh sheet = skins::vaultedSheet(48, 1, 0, 0.2);
    const SkinGraph graph = skinGraph(sheet);
    const auto rows = static_cast<Eigen::Index>(graph.vertices());
    const double length = 0.06;
    const double bendCompliance = GENERATE(0.0, 3.0), bend = 1 / (1 + bendCompliance);
    const SkinFoundation foundation =
        skinFoundation(sheet, graph, std::vector<bool>(graph.vertices(), true),
                       std::vector<double>(graph.vertices(), 1), length, 0, bendCompliance);
    const auto nodes = static_cast<Eigen::Index>(foundation.nodes);
    CHECK(nodes < rows);
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(rows, nodes);
    for (Eigen::Index v = 0; v < rows; ++v)
        for (const SkinEntry& entry : foundation.weights[static_cast<std::size_t>(v)])
            weights(v, entry.index) = static_cast<double>(entry.value);
    CHECK((weights.rowwise().sum().array() - 1).abs().maxCoeff() < 1e-6);
    const Eigen::Map<const Eigen::VectorXd> mass(graph.area.data(), rows);
    const Eigen::MatrixXd bent = skinLaplacian(sheet) * weights;
    const Eigen::MatrixXd stiffness =
        bend * length * length * bent.transpose() * mass.cwiseInverse().asDiagonal() * bent +
        weights.transpose() * bent + weights.transpose() * mass.asDiagonal() * weights / (length * length);
    Eigen::MatrixXd answer = stiffness.inverse();
    answer /= answer.maxCoeff();
    double worst = 0;
    std::size_t most = 0;
    for (Eigen::Index n = 0; n < nodes; ++n) {
        Eigen::VectorXd column = Eigen::VectorXd::Zero(nodes);
        for (const SkinEntry& entry : foundation.columns[static_cast<std::size_t>(n)])
            column[entry.index] = static_cast<double>(entry.value);
        worst = std::max(worst, (column - answer.col(n)).cwiseAbs().maxCoeff());
        most = std::max(most, foundation.columns[static_cast<std::size_t>(n)].size());
    }
    CHECK(worst < 0.01);
    CHECK(most < static_cast<std::size_t>(nodes) / 2); // it is local
}
