#include "tests/fill/Verdicts.h"
#include "tests/geometry/TestMeshes.h"

using namespace tss;
using namespace tss::test;
using namespace zone;

namespace {

/// A bar about Z of two long triangles a side, closed; with a bore a tube, without one triangles without an
/// area.
TriangleMesh bar(double radius, double bore, double from, double to) {
    constexpr int sides = 24;
    const auto at = [](double r, int k, double z) {
        const double angle = 2 * std::numbers::pi * k / sides;
        return Vec3(r * std::cos(angle), r * std::sin(angle), z);
    };
    TriangleMesh mesh;
    for (int k = 0; k < sides; ++k)
        for (const auto& [r, z] : {std::pair(radius, from), {radius, to}, {bore, to}, {bore, from}})
            mesh.vertices.push_back(at(r, k, z));
    for (int k = 0; k < sides; ++k)
        for (int side = 0; side < 4; ++side) {
            const int a = 4 * k + side, d = 4 * k + (side + 1) % 4;
            const int b = 4 * ((k + 1) % sides) + side, c = 4 * ((k + 1) % sides) + (side + 1) % 4;
            mesh.triangles.emplace_back(a, b, c);
            mesh.triangles.emplace_back(a, c, d);
        }
    return mesh;
}

double areaBelow(std::span<const Patch> zone, double height) {
    double sum = 0;
    for (const Patch& patch : zone) sum += patch.centre().z() < height ? patch.area() : 0;
    return sum;
}

} // namespace

TEST_CASE("walls of fitted parts that pass each other closely are no zone of contact") {
    // A block in a slot whose walls are 0.005 away, driven against the end of the slot.
    Scene scene{boxMesh({-1, 0, 0}, {3, 0.3, 1}), boxMesh({0.1, 0.305, 0.3}, {0.4, 0.695, 0.9}), {}};
    append(scene.a, boxMesh({-1, 0.7, 0}, {3, 1, 1}));
    append(scene.a, boxMesh({1.2, 0.3, 0}, {1.5, 0.7, 1}));
    scene.motion.dofs = {joints::slide(Vec3::UnitX(), 0, 1)};
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.005));
    REQUIRE_FALSE(fit.levels.empty());
    CHECK(fit.levels.front().areaA < 0.5); // of 2.4 that the walls have along the block's way
    checkVerdicts(scene.a, scene.b, scene.motion, fit, 0.005, 200);
}

TEST_CASE("neither is the bore of a hinge nor the pin in it, whose clearance is a quarter of the tolerance") {
    // An arm on the pin swings over the end of the bore, 0.005 off, and against a stop.
    Scene scene{bar(1, 0.505, 0, 1), bar(0.5, 0, -0.1, 1.1), {}};
    append(scene.a, boxMesh({1.5, 1, 0.5}, {2, 1.5, 1.5}));
    append(scene.b, boxMesh({0, -0.2, 1.005}, {2.5, 0.2, 1.3}));
    scene.motion.dofs = {turn(Vec3::Zero(), Vec3::UnitZ(), -1, 1)};
    const ContactZoneFit fit = fitContactZone(scene.a, scene.b, scene.motion, tolerance(0.02));
    REQUIRE_FALSE(fit.levels.empty());
    CHECK(areaBelow(fit.a.zone, 1.001) < 0.5); // of 3.2 in the bore, as on the pin, and 2.3 at its end
    CHECK(areaBelow(fit.b.zone, 1.001) < 0.2);
    checkVerdicts(scene.a, scene.b, scene.motion, fit, 0.02, 200);
}
