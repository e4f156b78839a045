#include "bake/verify/MeshVerify.h"
#include "tests/Joints.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace tss;

namespace {

/// The wall of a tube about Z, of two long triangles a side.
TriangleMesh wall(double radius, double length, int sides) {
    TriangleMesh mesh;
    for (int k = 0; k < sides; ++k) {
        const double angle = 2 * std::numbers::pi * k / sides;
        for (const double z : {0.0, length})
            mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    for (int k = 0; k < sides; ++k) {
        const int a = 2 * k, b = 2 * ((k + 1) % sides);
        mesh.triangles.push_back(Tri(a, b, b + 1));
        mesh.triangles.push_back(Tri(a, b + 1, a + 1));
    }
    return mesh;
}

} // namespace

TEST_CASE("walls of tubes that slide in each other are told apart by their planes at the poses tried first") {
    const TriangleMesh outer = wall(10, 150, 48), inner = wall(9.75, 150, 48);
    Motion motion;
    motion.dofs = {joints::slide(Vec3::UnitZ(), 0, 145)};
    NeverCollides proof;
    proof.clearance = 0.2;
    const MeshVerdict verdict = verifyOnMeshes(outer, inner, proof, motion);
    INFO(verdict.reason);
    CHECK(verdict.holds());
    INFO(verdict.work);
    CHECK(verdict.work < 6'500'000); // 7.4 million by balls about them alone, and four times as long
    proof.clearance = 0.3;
    CHECK_FALSE(verifyOnMeshes(outer, inner, proof, motion).holds());
}
