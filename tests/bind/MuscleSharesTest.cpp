#include "bake/bind/MuscleShares.h"

#include "bake/motion/MuscleSpan.h"
#include "bake/motion/MuscleVolume.h"
#include "tests/BentEllipsoid.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

constexpr double degree = M_PI / 180;

/// Two bones along x that meet at 0, a fifth of their length high and as wide.
TriangleMesh boneAt(double from, double to) {
    const double half = std::abs(to - from) / 10;
    return boxMesh({std::min(from, to), -half, -2 * half}, {std::max(from, to), half, 0});
}

/// A muscle that lies with both ends on these bones, bulging upwards.
Muscle flexorOf(double length) {
    test::BentEllipsoid shape;
    shape.origin = {-length / 2, 0, 0};
    shape.insertion = {length / 2, 0, 0};
    shape.bend = length / 10;
    shape.halfWidth = shape.halfHeight = length / 20;
    shape.rings = 40;
    Muscle muscle = test::bentEllipsoid(shape);
    muscle.spans = true;
    return muscle;
}

/// Of the lower bone about y, in the middle of the bones' height: it closes over the muscle.
Pose closed(double degrees, double height) {
    const Vec3 at(0, 0, -height);
    return Eigen::Translation3d(at) * Eigen::AngleAxisd(-degrees * degree, Vec3::UnitY()) *
           Eigen::Translation3d(-at);
}

int turnedOver(const MuscleDeformer& muscle, const std::vector<Vec3>& now, const Pose& far) {
    const TriangleMesh& rest = muscle.muscle().surface;
    const auto normal = [](const std::vector<Vec3>& x, const Tri& t) -> Vec3 {
        return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
    };
    int count = 0;
    for (const Tri& t : rest.triangles) {
        double share = 0;
        for (const int v : t) share += muscle.chainShares()[v] / 3;
        const Pose here = ChainBlend({far}, {}).at(share);
        count += normal(now, t).dot(here.linear() * normal(rest.vertices, t)) < 0;
    }
    return count;
}

} // namespace

TEST_CASE("a muscle's ends are their bones' however short it is against them") {
    for (const double length : {25.0, 12.0, 6.0}) {
        INFO("length " << length << " between bones of 200");
        const Muscle muscle = flexorOf(length);
        const std::vector<double> shares = chainShares(
            muscle.surface, std::vector{boneAt(-200, -length / 6), boneAt(length / 6, 200)}, muscle.form);
        CHECK(shares.front() < 1e-3);
        CHECK(shares.back() > 1 - 1e-3);
    }
}

TEST_CASE("each half of a ring is its bone's however short it is against the two") {
    // A ring about a mouth in the x-z plane, a radius of 1, before the ends of two bones as lips before
    // teeth.
    TriangleMesh ring;
    const int around = 48, across = 8;
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) {
            const double u = 2 * M_PI * i / around, w = 2 * M_PI * k / across, r = 1 + 0.15 * std::cos(w);
            ring.vertices.emplace_back(r * std::cos(u), 0.15 * std::sin(w), r * std::sin(u));
            const int next = (i + 1) % around * across, here = i * across, beside = (k + 1) % across;
            ring.triangles.emplace_back(here + k, here + beside, next + k);
            ring.triangles.emplace_back(here + beside, next + beside, next + k);
        }
    for (const double length : {2.0, 10.0, 100.0}) {
        INFO("a ring of radius 1 before bones of " << length);
        const TriangleMesh upper = boxMesh({-1.2, 0.2, 0.1}, {1.2, length, 1.2}),
                           lower = boxMesh({-1.2, 0.2, -1.2}, {1.2, length, -0.1});
        const std::vector<double> shares = chainShares(ring, std::vector{upper, lower}, MuscleForm::Ring);
        for (std::size_t v = 0; v < shares.size(); ++v) {
            const double height = ring.vertices[v].z();
            if (std::abs(height) > 0.8) CHECK(shares[v] == Approx(height < 0).margin(0.02));
        }
    }
}

TEST_CASE("a muscle inside of a joint that closes turns nothing over and keeps its volume, active or not") {
    Muscle flexor = flexorOf(200);
    const std::vector<TriangleMesh> bones{boneAt(-205, -5), boneAt(5, 205)};
    std::vector<std::vector<DualPose>> motions;
    for (const double degrees : {32.0, 64.0, 96.0, 128.0}) motions.push_back({DualPose(closed(degrees, 20))});
    flexor.chainShares = chainShares(flexor.surface, bones, flexor.form, motions);
    const MuscleDeformer muscle(flexor);
    const MuscleSpan span(muscle);
    CHECK(muscle.chainShares().front() < 0.01);
    CHECK(muscle.chainShares().back() > 0.99);
    for (const double activation : {0.0, 1.0}) {
        std::vector<Vec3> before = muscle.vertices(activation);
        for (double degrees = 1; degrees <= 120; ++degrees) {
            INFO("activation " << activation << ", " << degrees << " degrees");
            std::vector<Vec3> now = muscle.vertices(activation);
            span.carry({closed(degrees, 20)}, now);
            CHECK(enclosedVolume(now, flexor.surface.triangles) == Approx(muscle.restVolume()).epsilon(1e-9));
            CHECK(turnedOver(muscle, now, closed(degrees, 20)) == 0);
            double most = 0;
            for (std::size_t v = 0; v < now.size(); ++v) most = std::max(most, (now[v] - before[v]).norm());
            CHECK(most < 4);
            before = now;
        }
    }
}

TEST_CASE("a muscle over the outside of a joint stays on its bone beside it, and keeps its volume") {
    test::BentEllipsoid shape; // lies on the upper bone and, past the joint at 0, on the lower one
    shape.origin = {-180, 0, 0};
    shape.insertion = {40, 0, 0};
    shape.bend = 30;
    shape.halfWidth = 15;
    shape.halfHeight = 12;
    shape.rings = 60;
    Muscle extensor = test::bentEllipsoid(shape);
    extensor.spans = true;
    const std::vector<TriangleMesh> bones{boneAt(-205, -5), boneAt(5, 205)};
    std::vector<std::vector<DualPose>> motions;
    for (const double degrees : {-32.0, -64.0, -96.0, -128.0})
        motions.push_back({DualPose(closed(degrees, 20))});
    extensor.chainShares = chainShares(extensor.surface, bones, extensor.form, motions);
    const MuscleDeformer muscle(extensor);
    const MuscleSpan span(muscle);
    for (const double degrees : {-60.0, -90.0, -128.0}) {
        INFO(degrees << " degrees");
        std::vector<Vec3> now = muscle.vertices(0.0);
        span.carry({closed(degrees, 20)}, now);
        CHECK(enclosedVolume(now, extensor.surface.triangles) == Approx(muscle.restVolume()).epsilon(1e-9));
        CHECK(turnedOver(muscle, now, closed(degrees, 20)) == 0);
        double away = 0; // from the bone, on average: what makes it thinner moves either side alike
        int count = 0;
        for (std::size_t v = 0; v < now.size(); ++v) {
            if (std::abs(extensor.surface.vertices[v].x() + 70) > 30)
                continue; // far beyond the joint's width
            away += now[v].z() - extensor.surface.vertices[v].z();
            ++count;
        }
        CHECK(std::abs(away / count) < 3.5); // of 70 from the joint; claims along the surface gave 5.1
    }
}
