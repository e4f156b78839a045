#include "bake/respond/SkinWalk.h"

#include "tests/Shapes.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;

namespace {

constexpr double rounding = 3e-6; ///< of places up to 2 in single precision

/// A ball with hills and hollows as large as its triangles.
TriangleMesh bumpyBall(std::mt19937_64& random) {
    std::uniform_real_distribution<double> radius(0.7, 1.3);
    TriangleMesh mesh = ballMesh(Vec3::Zero(), 1, 2);
    for (Vec3& v : mesh.vertices) v *= radius(random);
    return mesh;
}

double distance(const Vec3& x, const TriangleMesh& mesh, int t) {
    const Vec3 w = nearestOnTriangle(x, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
    return (x - w[0] * mesh.corner(t, 0) - w[1] * mesh.corner(t, 1) - w[2] * mesh.corner(t, 2)).norm();
}

} // namespace

TEST_CASE("a walk ends where no triangle around is nearer") {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> along(-1.6, 1.6);
    int corners = 0;
    for (int round = 0; round < 20; ++round) {
        const TriangleMesh mesh = bumpyBall(random);
        const std::vector<Tri> across = trianglesAcross(mesh.triangles);
        const auto count = static_cast<int>(mesh.triangles.size());
        const auto place = [&](int v) -> Eigen::Vector3f { return mesh.vertices[v].cast<float>(); };
        for (int i = 0; i < 500; ++i) {
            const Vec3 x{along(random), along(random), along(random)};
            const int start = static_cast<int>(random() % static_cast<unsigned>(count));
            const SurfacePoint hit =
                walkDownhill(x.cast<float>(), start, mesh.triangles, across, place, count);
            CHECK(std::sqrt(hit.squared) == Approx(distance(x, mesh, hit.triangle)).margin(rounding));
            const Tri& at = mesh.triangles[hit.triangle];
            if ((hit.weights.array() > 0).count() == 1) ++corners;
            for (int t = 0; t < count; ++t) {
                // All the corners that the point hangs on.
                bool around = true;
                for (int k = 0; k < 3; ++k)
                    around = around && (hit.weights[k] <= 0 || (mesh.triangles[t].array() == at[k]).any());
                if (around) CHECK(distance(x, mesh, t) >= std::sqrt(hit.squared) - rounding);
            }
        }
    }
    CHECK(corners > 1000);
}

TEST_CASE("a walk goes around a corner of a surface with a rim") {
    // Five triangles of a fan, from the middle three of which only the corner is near; the first and the last
    // rise from it to the rim.
    TriangleMesh fan;
    fan.vertices = {{0, 0, 0}};
    for (int k = 0; k < 6; ++k)
        fan.vertices.emplace_back(std::cos(0.5 * k), std::sin(0.5 * k), k == 0 || k == 5 ? 1 : -1);
    for (int k = 0; k < 5; ++k) fan.triangles.emplace_back(0, k + 1, k + 2);
    const std::vector<Tri> across = trianglesAcross(fan.triangles);
    const auto place = [&](int v) -> Eigen::Vector3f { return fan.vertices[v].cast<float>(); };
    const Vec3 x(-0.2 * std::cos(1.25), -0.2 * std::sin(1.25), 0.3);
    for (int start = 0; start < 5; ++start) {
        const SurfacePoint hit = walkDownhill(x.cast<float>(), start, fan.triangles, across, place, 8);
        CHECK((hit.triangle == 0 || hit.triangle == 4));
        CHECK(std::sqrt(hit.squared) == Approx(distance(x, fan, 0)).margin(rounding));
        CHECK(std::sqrt(hit.squared) < x.norm() - 0.01);
    }
}
