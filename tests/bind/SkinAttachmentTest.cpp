// How skin goes with the muscles below it.
#include "bake/bind/SkinAttachment.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

/// A flat sheet over [-40, 40]^2 in steps of 1.
TriangleMesh sheet() {
    TriangleMesh mesh;
    const int n = 80;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) mesh.vertices.emplace_back(i - n / 2, j - n / 2, 0);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, d = a + n + 1, c = d + 1;
            mesh.triangles.emplace_back(a, b, c);
            mesh.triangles.emplace_back(a, c, d);
        }
    return mesh;
}

/// A muscle along x, of any shape.
std::shared_ptr<const MuscleDeformer> muscleOf(TriangleMesh surface) {
    Muscle muscle;
    const Eigen::AlignedBox3d box = bounds(surface);
    muscle.surface = std::move(surface);
    muscle.fibre = {Vec3(box.min().x(), 0, box.center().z()), Vec3(box.max().x(), 0, box.center().z())};
    return std::make_shared<const MuscleDeformer>(std::move(muscle));
}

SkinAttachment attachmentOver(const TriangleMesh& surface) {
    const TriangleMesh skin = sheet();
    const std::vector<std::shared_ptr<const MuscleDeformer>> bodies{muscleOf(surface)};
    const SkinParameters parameters;
    return attachSkin(SkinAnatomy(skin, bodies, parameters), parameters);
}

/// How much the sheet goes with a muscle at (0, 0), (1, 0) and so on to (40, 0).
std::vector<double> sharesOver(const TriangleMesh& surface) {
    const SkinAttachment attachment = attachmentOver(surface);
    std::vector<double> shares;
    for (int x = 0; x <= 40; ++x) shares.push_back(attachment.muscles[0][40 * 81 + 40 + x]);
    return shares;
}

} // namespace

TEST_CASE("a muscle holds the skin over it through its tissue, hardly any beside it, none far above it") {
    // 1.4 is the length of this skin's foundation, an eightieth of its size.
    const std::vector<double> shares = sharesOver(boxMesh({-10, -10, -6}, {10, 10, -2}));
    CHECK(shares[0] > 0.99);
    CHECK(shares[13] > 0.1); // 2.1 lengths beside
    CHECK(shares[13] < 0.15);
    CHECK(sharesOver(boxMesh({-10, -10, -9}, {10, 10, -5}))[0] > 0.99); // 3.5 lengths below
    CHECK(sharesOver(boxMesh({-10, -10, -12}, {10, 10, -8}))[0] == 0);  // 5.7 lengths below
}

TEST_CASE(
    "skin that touches a muscle is held firmly, a thirtieth of the foundation's length above it much less") {
    // That is 0.047 of this skin's length of 1.41.
    const auto firmnessAt = [](double gap) {
        return attachmentOver(boxMesh({-10, -10, -6}, {10, 10, -gap})).firmness[40 * 81 + 40];
    };
    CHECK(firmnessAt(0.001) > 250);
    CHECK(firmnessAt(0.047) > 70);
    CHECK(firmnessAt(0.047) < 140);
    CHECK(firmnessAt(0.47) < 1.1);
}
