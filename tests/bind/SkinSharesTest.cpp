// How fast shares change along the skin.
#include "bake/bind/SkinShares.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace tss;

namespace {

/// A sheet over [-n, n]^2 in steps of 1, slit along y = 0 for x < 0 like a mouth up to its corner at 0.
TriangleMesh slitSheet(int n) {
    TriangleMesh mesh;
    const int row = 2 * n + 1;
    for (int y = -n; y <= n; ++y)
        for (int x = -n; x <= n; ++x) mesh.vertices.emplace_back(x, y, 0);
    for (int x = -n; x < 0; ++x) mesh.vertices.emplace_back(x, 0, 0); // of the upper side
    const auto at = [&](int x, int y, bool upper) {
        return y == 0 && upper && x < 0 ? row * row + x + n : (y + n) * row + x + n;
    };
    for (int y = -n; y < n; ++y)
        for (int x = -n; x < n; ++x) {
            const bool upper = y >= 0;
            const int a = at(x, y, upper), b = at(x + 1, y, upper), c = at(x + 1, y + 1, upper),
                      d = at(x, y + 1, upper);
            mesh.triangles.emplace_back(a, b, c);
            mesh.triangles.emplace_back(a, c, d);
        }
    return mesh;
}

} // namespace

TEST_CASE("around the corner of a mouth shares change slowly, the more so the larger its bones are") {
    const int n = 20;
    const TriangleMesh skin = slitSheet(n);
    std::vector<SkinInfluence> influences(2);
    for (std::size_t v = 0; v < skin.vertices.size(); ++v) {
        const Vec3& p = skin.vertices[v];
        const bool upper = p.y() > 0 || v >= (2 * n + 1) * (2 * n + 1), lip = p.x() < -1;
        influences[0].distance.push_back(lip && upper ? 0.1 : 20);
        influences[1].distance.push_back(lip && !upper ? 0.1 : 20);
    }
    const auto steepest = [&](double size) {
        influences[0].size = influences[1].size = size;
        const std::vector<double> upper = claimedShares(skin, skinGraph(skin), influences)[0];
        double most = 0;
        for (const Tri& t : skin.triangles)
            for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(upper[t[k]] - upper[t[(k + 1) % 3]]));
        return most;
    };
    CHECK(steepest(20) == Approx(0.32).margin(0.01)); // 0.33 by the claims alone
    CHECK(steepest(80) == Approx(0.235).margin(0.02));
}

TEST_CASE(
    "skin between two bones that come together by far more than there is between them is not turned over") {
    const int n = 30;
    const TriangleMesh skin = slitSheet(n);
    std::vector<SkinInfluence> influences(2);
    for (const Vec3& p : skin.vertices) {
        influences[0].distance.push_back(p.x() < -1 ? 1 : 40);
        influences[1].distance.push_back(p.x() > 1 ? 1 : 40);
    }
    for (SkinInfluence& influence : influences) influence.size = 30;
    for (const double closing : {4.0, 8.0, 16.0}) {
        ShareOptions options;
        const Pose moved(Eigen::Translation3d(-closing, 0, 0));
        options.motions = {{DualPose(), DualPose(moved)}};
        const std::vector<double> share = claimedShares(skin, skinGraph(skin), influences, options)[1];
        int turnedOver = 0;
        for (const Tri& t : skin.triangles) {
            const auto at = [&](int k) -> Vec3 {
                return skin.vertices[t[k]] - closing * share[t[k]] * Vec3::UnitX();
            };
            turnedOver += (at(1) - at(0)).cross(at(2) - at(0)).z() <= 0;
        }
        INFO("by " << closing);
        CHECK(turnedOver == 0);
        for (std::size_t v = 0; v < share.size(); ++v) // no more of it gives way than needs to
            if (std::abs(skin.vertices[v].x()) > 1.5 * closing)
                CHECK(share[v] == Approx(skin.vertices[v].x() > 0).margin(0.02));
    }
}

TEST_CASE("a claim fades fast towards where two meet") {
    const int n = 20;
    const TriangleMesh skin = slitSheet(n);
    const auto at = [&](int x) { return static_cast<std::size_t>((10 + n) * (2 * n + 1) + x + n); }; // y = 10
    std::vector<SkinInfluence> influences(2);
    for (const Vec3& p : skin.vertices) {
        influences[0].distance.push_back(p.x() < -10 ? 1 : 40);
        influences[1].distance.push_back(p.x() > 10 ? 1 : 40);
    }
    for (SkinInfluence& influence : influences) influence.size = 20;
    const SkinClaims claims = claimSkin(skin, skinGraph(skin), influences);
    CHECK(claims.influence[at(-9)] == 0);
    CHECK(claims.influence[at(5)] == 1);
    // At 9 the seeds are 2 and 20 away along the skin, at 5 these are 6 and 16.
    CHECK(claims.weight[at(5)] / claims.weight[at(-9)] == Approx(0.009).epsilon(0.1));
}

TEST_CASE("neither a sliver nor a vertex without triangles upsets a system over the skin") {
    TriangleMesh skin{{{0, 0, 0}, {1, 0, 0}, {0, 100, 0}, {0, 1, 0}, {9, 9, 9}}, {{0, 1, 3}, {0, 2, 1}}};
    SparseMatrix laplacian = skinLaplacian({skin.vertices, {skin.triangles[1]}});
    CHECK(laplacian.coeff(0, 1) ==
          Approx(-10)); // across a needle of 0.6 degrees, half of whose cotangent is 50
    skin.vertices[2] = {0, 10, 0};
    laplacian = skinLaplacian({skin.vertices, {skin.triangles[1]}});
    CHECK(laplacian.coeff(0, 1) == Approx(-5)); // 5.7 degrees: as it is
    const SkinGraph graph = skinGraph({skin.vertices, {skin.triangles[0]}});
    CHECK(graph.area[4] > 0.0006); // of 0.1 a vertex
    CHECK(graph.area[4] < 0.0018);
}
