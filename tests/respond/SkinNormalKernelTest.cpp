#include "SkinShapes.h"

#include "bake/bind/SkinNormals.h"
#include "bake/respond/SkinNormalKernel.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;

namespace {

/// A rough sheet with a hole and a rim of odd corners, two fans and a triangle that meet in one vertex only,
/// a vertex of no triangle and one of a triangle without area: an odd number of vertices.
TriangleMesh roughSkin() {
    TriangleMesh mesh = skins::vaultedSheet(6, 1, 0, 0.3);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-0.05, 0.05);
    for (Vec3& x : mesh.vertices) x += Vec3(any(random), any(random), any(random));
    mesh.triangles.erase(mesh.triangles.begin() + 20, mesh.triangles.begin() + 23);
    const auto fan = [&](int middle, int corners, double height) {
        const int first = static_cast<int>(mesh.vertices.size());
        for (int k = 0; k <= corners; ++k)
            mesh.vertices.push_back(mesh.vertices[middle] +
                                    Vec3(std::cos(k), std::sin(k), height + any(random)));
        for (int k = 0; k < corners; ++k) mesh.triangles.emplace_back(middle, first + k, first + k + 1);
    };
    fan(0, 3, 0.2);
    fan(0, 4, 0.4);
    fan(0, 1, -0.2);
    const int last = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {Vec3(2, 2, 2), Vec3(3, 0, 0), Vec3(3, 0, 1), Vec3(3, 0, 2)});
    mesh.triangles.emplace_back(last + 1, last + 2, last + 3);
    if (mesh.vertices.size() % 2 == 0) mesh.vertices.emplace_back(4, 4, 4);
    return mesh;
}

} // namespace

TEST_CASE("the normals of a skin are those by area, and the same bits by every kernel") {
    const TriangleMesh mesh = roughSkin();
    const std::size_t count = mesh.vertices.size();
    const Lists<std::uint32_t> rings = skinRings(mesh.triangles, count);
    std::vector<Eigen::Vector4f> places(count + 1, Eigen::Vector4f::Zero());
    for (std::size_t v = 0; v < count; ++v)
        places[v] << mesh.vertices[v].cast<float>(), 0.01f * static_cast<float>(v);
    const std::vector<Vec3> expected = skinNormals(mesh);
    std::vector<float> first;
    for (const KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                      KernelTarget::Avx512, KernelTarget::Neon}) {
        if (!available(target)) continue;
        CAPTURE(name(target));
        std::vector<float> normals(3 * (2 * rings.size()) + 1, 9);
        const SkinNormalKernel kernel = skinNormalKernel(target);
        CHECK_FALSE(kernel(rings, places[0].data(), -1, 0, rings.size(), normals.data()));
        std::size_t without = 0;
        for (std::size_t v = 0; v < count; ++v) {
            const Vec3 normal = Eigen::Vector3f::Map(&normals[3 * v]).cast<double>();
            CAPTURE(v);
            CHECK((normal + expected[v]).norm() < 1e-5);
            without += normal.isZero(0);
        }
        CHECK(without >= 4);
        CHECK(kernel(rings, places[0].data(), -1, 0, 20, normals.data()));
        normals.resize(3 * count);
        if (first.empty()) first = normals;
        CHECK(normals == first);
    }
}
