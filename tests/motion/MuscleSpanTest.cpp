#include "bake/motion/MuscleSpan.h"
#include "bake/motion/MuscleVolume.h"
#include "tests/BentEllipsoid.h"
#include "tests/FloatTraps.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <random>

using namespace tss;

namespace {

using std::numbers::pi;

/// A muscle of length 4 along x, bent upwards, between two bones.
MuscleDeformer betweenBones(int rings = 40, int sectors = 32, double roughness = 0) {
    test::BentEllipsoid shape;
    shape.origin = {0, 0, 0};
    shape.insertion = {4, 0, 0};
    shape.bend = 0.5;
    shape.halfWidth = 0.5;
    shape.halfHeight = 0.4;
    shape.rings = rings;
    shape.sectors = sectors;
    Muscle muscle = test::bentEllipsoid(shape);
    muscle.spans = true;
    std::mt19937_64 random(3);
    std::normal_distribution<double> off(0, roughness);
    if (roughness > 0)
        for (Vec3& vertex : muscle.surface.vertices) vertex += Vec3(off(random), off(random), off(random));
    return MuscleDeformer(std::move(muscle));
}

/// The insertion's bone turns about a hinge across the muscle, below its middle.
Pose hinge(double degrees) {
    const Vec3 at(2, 0, -0.5);
    return Eigen::Translation3d(at) * Eigen::AngleAxisd(degrees * pi / 180, Vec3::UnitY()) *
           Eigen::Translation3d(-at);
}

} // namespace

TEST_CASE("a muscle between two bones keeps its volume, at every activation and pose of these") {
    const MuscleDeformer muscle = betweenBones();
    const MuscleSpan span(muscle);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int k = 0; k < 60; ++k) {
        const Pose far = Eigen::Translation3d(Vec3{unit(random), unit(random), unit(random)} * 0.5) *
                         hinge(-60 + 120 * unit(random)) *
                         Eigen::AngleAxisd(unit(random) - 0.5, Vec3::UnitX());
        std::vector<Vec3> places = muscle.vertices(unit(random));
        const double swell = span.carry({far}, places);
        CHECK(enclosedVolume(places, muscle.muscle().surface.triangles) ==
              Approx(muscle.restVolume()).epsilon(1e-9));
        CHECK(std::abs(swell) < 1);
    }
}

TEST_CASE("a muscle between two bones keeps its volume with its openings closed") {
    Muscle own = betweenBones().muscle();
    std::erase_if(own.surface.triangles, [](const Tri& t) { return t[0] % 53 == 0; });
    const MuscleDeformer muscle(std::move(own));
    REQUIRE(muscle.closedTriangles().size() > muscle.muscle().surface.triangles.size());
    std::vector<Vec3> places = muscle.vertices(1.0);
    MuscleSpan(muscle).carry({hinge(50)}, places);
    CHECK(enclosedVolume(places, muscle.closedTriangles()) == Approx(muscle.restVolume()).epsilon(1e-9));
}

TEST_CASE("a coarse or rough muscle between two bones keeps its volume as a fine one does") {
    struct Shape {
        int rings, sectors;
        double roughness;
    };
    for (const Shape shape : {Shape{6, 5, 0}, Shape{4, 4, 0}, Shape{3, 3, 0}, Shape{40, 32, 0.02}}) {
        CAPTURE(shape.rings, shape.roughness);
        const MuscleDeformer muscle = betweenBones(shape.rings, shape.sectors, shape.roughness);
        const MuscleSpan span(muscle);
        for (const double degrees : {-60, -20, 30, 90}) {
            CAPTURE(degrees);
            std::vector<Vec3> places = muscle.vertices(0);
            span.carry({hinge(degrees)}, places);
            CHECK(enclosedVolume(places, muscle.muscle().surface.triangles) ==
                  Approx(muscle.restVolume()).epsilon(1e-9));
        }
    }
}

TEST_CASE("its ends go with their bones, and nothing moves while these do not") {
    const MuscleDeformer muscle = betweenBones();
    const MuscleSpan span(muscle);
    const std::vector<Vec3> rest = muscle.vertices(0.4);
    std::vector<Vec3> places = rest;
    CHECK(span.carry({Pose::Identity()}, places) == 0);
    CHECK(places == rest);
    const Pose far = hinge(50);
    span.carry({far}, places);
    int first = 0, last = 0;
    double farthest = 0;
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const double s = muscle.surfacePoints()[v].s;
        if (s < 0.01) ++first, farthest = std::max(farthest, (places[v] - rest[v]).norm());
        if (s > 0.99) ++last, farthest = std::max(farthest, (places[v] - far * rest[v]).norm());
    }
    CHECK(first > 0);
    CHECK(last > 0);
    CHECK(farthest < 1e-3);
    // In between, neighbours move alike.
    for (const Tri& t : muscle.muscle().surface.triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            CHECK((places[a] - places[b]).norm() < 2 * (rest[a] - rest[b]).norm());
        }
}

TEST_CASE("between two bones an active muscle keeps its ends on them, wherever its anchor is") {
    for (const double anchor : {0.0, 0.4, 1.0}) {
        INFO("anchor " << anchor);
        Muscle own = betweenBones().muscle();
        own.anchor = anchor;
        const MuscleDeformer muscle(std::move(own));
        const std::vector<Vec3> active = muscle.vertices(1.0);
        double ends = 0, belly = 0;
        for (std::size_t v = 0; v < active.size(); ++v) {
            const MusclePoint& point = muscle.surfacePoints()[v];
            const double moved = (active[v] - point.rest).norm();
            (point.s < 0.01 || point.s > 0.99 ? ends : belly) =
                std::max(point.s < 0.01 || point.s > 0.99 ? ends : belly, moved);
            CHECK(muscle.bind(point.rest).share == Approx(point.share).margin(1e-9));
        }
        CHECK(ends < 1e-3);
        CHECK(belly > 0.05);
        CHECK(enclosedVolume(active, muscle.muscle().surface.triangles) ==
              Approx(muscle.restVolume()).epsilon(1e-9));
    }
}

TEST_CASE("pushed together until it folds, a muscle loses volume little by little and never jumps") {
    const MuscleDeformer muscle = betweenBones();
    const MuscleSpan span(muscle);
    const auto at = [&](double together) {
        std::vector<Vec3> places = muscle.vertices(0.0);
        const double swell = span.carry({Pose(Eigen::Translation3d(-together, 0, 0))}, places);
        CHECK(swell >= 0);
        CHECK(swell <= 2);
        return places;
    };
    constexpr double step = 0.01;
    std::vector<Vec3> before = at(0);
    for (double together = step; together < 3.9; together += step) {
        const std::vector<Vec3> now = at(together);
        double most = 0;
        for (std::size_t v = 0; v < now.size(); ++v) most = std::max(most, (now[v] - before[v]).norm());
        INFO("pushed together by " << together);
        CHECK(most < 3 * step);
        before = now;
    }
}

TEST_CASE("a muscle that its bones turn by more than half a turn goes on the way round that it is told") {
    Muscle own = betweenBones().muscle();
    own.sides = {{0, std::sin(55 * pi / 180), 0, std::cos(55 * pi / 180)}}; // of 110 degrees
    const MuscleDeformer muscle(std::move(own));
    const MuscleSpan span(muscle);
    std::vector<Vec3> before = muscle.vertices(0.0);
    for (double degrees = 1; degrees < 220; ++degrees) {
        std::vector<Vec3> now = muscle.vertices(0.0);
        span.carry({hinge(degrees)}, now);
        double most = 0;
        for (std::size_t v = 0; v < now.size(); ++v) most = std::max(most, (now[v] - before[v]).norm());
        INFO(degrees << " degrees");
        CHECK(most < 0.2);
        before = now;
    }
}

TEST_CASE("its normals are those of its surface as it is bent") {
    const MuscleDeformer muscle = betweenBones();
    const MuscleSpan span(muscle);
    for (const double degrees : {-40.0, 25.0, 60.0}) {
        TriangleMesh mesh = muscle.muscle().surface;
        std::vector<Vec3> normals = vertexNormals(mesh);
        const std::vector<Vec3> before = normals;
        const double swell = span.carry({hinge(degrees)}, mesh.vertices, normals);
        INFO(degrees << " degrees, swell " << swell);
        const std::vector<Vec3> now = vertexNormals(mesh);
        double mean = 0, unbent = 0;
        for (std::size_t v = 0; v < now.size(); ++v) {
            CHECK(normals[v].norm() == Approx(1));
            mean +=
                std::acos(std::clamp(normals[v].dot(now[v]), -1.0, 1.0)) / static_cast<double>(now.size());
            unbent +=
                std::acos(std::clamp(before[v].dot(now[v]), -1.0, 1.0)) / static_cast<double>(now.size());
        }
        CHECK(mean < 0.04); // what swelling turns is left out
        CHECK(unbent > 5 * mean);
    }
}

TEST_CASE("a ring between two bones is split where its line says") {
    Muscle ring;
    ring.form = MuscleForm::Ring;
    ring.spans = true;
    ring.maxContraction = 0.2;
    constexpr int around = 64, across = 12;
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) {
            const double u = 2 * pi * i / around, w = 2 * pi * k / across, r = 1 + 0.15 * std::cos(w);
            ring.surface.vertices.emplace_back(r * std::sin(u), 0.15 * std::sin(w), r * std::cos(u));
        }
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) {
            const int a = i * across + k, b = i * across + (k + 1) % across,
                      c = (i + 1) % around * across + k, d = (i + 1) % around * across + (k + 1) % across;
            ring.surface.triangles.emplace_back(a, b, d);
            ring.surface.triangles.emplace_back(a, d, c);
        }
    if (enclosedVolume(ring.surface.vertices, ring.surface.triangles) < 0)
        for (Tri& t : ring.surface.triangles) std::swap(t[1], t[2]);
    for (int k = 0; k < 12; ++k)
        ring.fibre.emplace_back(std::sin(2 * pi * k / 12), 0, std::cos(2 * pi * k / 12)); // first on top
    const MuscleDeformer muscle(ring);
    CHECK(muscle.chainShare({0, 0, 1}) == Approx(0).margin(0.01));
    CHECK(muscle.chainShare({0, 0, -1}) == Approx(1).margin(0.01));
    CHECK(muscle.chainShare({1, 0, 0}) == Approx(0.5).margin(0.02));
    const MuscleSpan span(muscle);
    std::vector<Vec3> places = muscle.vertices(0.0);
    const Pose down = Pose(Eigen::Translation3d(0, 0, -0.5)); // a mouth that opens
    span.carry({down}, places);
    CHECK(enclosedVolume(places, ring.surface.triangles) == Approx(muscle.restVolume()).epsilon(1e-9));
    const Eigen::AlignedBox3d box = bounds({places, ring.surface.triangles});
    CHECK(box.max().z() == Approx(1.15).margin(0.05));
    CHECK(box.min().z() == Approx(-1.65).margin(0.05));
}

TEST_CASE("a flat muscle that is drawn together across its line swells to its sides and not over itself") {
    test::BentEllipsoid shape;
    shape.halfWidth = 1.5;
    shape.halfHeight = 0.2;
    shape.sectors = 48;
    Muscle flat = test::bentEllipsoid(shape);
    flat.spans = true;
    for (const Vec3& v : flat.surface.vertices) {
        const double t = std::clamp((v.y() + 1) / 2, 0.0, 1.0);
        flat.chainShares.push_back(t * t * (3 - 2 * t));
    }
    const MuscleDeformer muscle(flat);
    std::vector<Vec3> places = muscle.vertices(0.0);
    MuscleSpan(muscle).carry({Pose(Eigen::Translation3d(0, -1, 0))}, places);
    CHECK(enclosedVolume(places, flat.surface.triangles) == Approx(muscle.restVolume()).epsilon(1e-9));
    for (const Tri& t : flat.surface.triangles) {
        const auto normal = [&](const std::vector<Vec3>& x) {
            return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).normalized();
        };
        const Vec3 before = normal(flat.surface.vertices);
        if (std::abs(before.z()) > 0.5) CHECK(normal(places).z() * before.z() > 0);
    }
}
