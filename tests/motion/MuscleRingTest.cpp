#include "bake/base/Error.h"
#include "bake/geometry/FibreLine.h"
#include "bake/motion/MuscleDeformer.h"
#include "bake/motion/MuscleVolume.h"
#include "tests/FloatTraps.h"

#include <catch2/catch.hpp>
#include <numbers>
#include <random>

using namespace tss;

namespace {

constexpr double turn = 2 * std::numbers::pi;

/// The middle line of a ring like that about a mouth: twice as long as high, and bent about the muzzle.
Vec3 mouthLine(double s) {
    const double x = 2 * std::cos(turn * s), y = std::sin(turn * s);
    return {x, y, -0.2 * x * x};
}

/// A tube of radius 0.15 about it.
Muscle mouthRing() {
    constexpr int around = 96, across = 16;
    Muscle muscle;
    for (int i = 0; i < around; ++i) {
        const double s = static_cast<double>(i) / around;
        const Vec3 at = mouthLine(s), ahead = (mouthLine(s + 1e-4) - mouthLine(s - 1e-4)).normalized(),
                   out = ahead.cross(Vec3::UnitZ()).normalized(), up = out.cross(ahead);
        for (int k = 0; k < across; ++k)
            muscle.surface.vertices.push_back(
                at + 0.15 * (std::cos(turn * k / across) * out + std::sin(turn * k / across) * up));
        for (int k = 0; k < across; ++k) {
            const int a = i * across + k, b = i * across + (k + 1) % across,
                      c = (i + 1) % around * across + k, d = (i + 1) % around * across + (k + 1) % across;
            muscle.surface.triangles.emplace_back(a, b, d);
            muscle.surface.triangles.emplace_back(a, d, c);
        }
    }
    if (enclosedVolume(muscle.surface.vertices, muscle.surface.triangles) < 0)
        for (Tri& t : muscle.surface.triangles) std::swap(t[1], t[2]);
    for (int k = 0; k < 16; ++k) muscle.fibre.push_back(mouthLine(k / 16.0));
    muscle.form = MuscleForm::Ring;
    muscle.maxContraction = 0.4;
    muscle.activationLower = -0.5;
    return muscle;
}

} // namespace

TEST_CASE("a ring of muscle keeps its volume at every activation, and its rest shape bit for bit") {
    const MuscleDeformer muscle(mouthRing());
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> activation(-0.5, 1);
    for (int i = 0; i < 50; ++i) {
        const double a = activation(random);
        CHECK(enclosedVolume(muscle.vertices(a), muscle.muscle().surface.triangles) ==
              Approx(muscle.restVolume()).epsilon(1e-12));
        CHECK(muscle.state(a).thickening == Approx(1).epsilon(0.05));
    }
    CHECK(muscle.vertices(0) == muscle.muscle().surface.vertices);
}

TEST_CASE("a ring of muscle narrows in its own plane and thickens about its line") {
    const MuscleDeformer muscle(mouthRing());
    const MuscleState tight = muscle.state(1);
    for (int k = 0; k < 16; ++k) {
        const Vec3 rest = mouthLine(k / 16.0), now = muscle.map(rest, 1);
        CHECK((now.head<2>() - 0.6 * rest.head<2>()).norm() < 0.02); // the plane's middle lies near the axis
        CHECK(std::abs(now.z() - rest.z()) < 0.02);
    }
    CHECK(muscle.thickness(0.3, tight) == Approx(1 / std::sqrt(0.6)).epsilon(0.02));
    // No place where it is torn: neighbours stay neighbours.
    const std::vector<Vec3> moved = muscle.vertices(tight);
    for (const Tri& t : muscle.muscle().surface.triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            const double before =
                (muscle.muscle().surface.vertices[a] - muscle.muscle().surface.vertices[b]).norm();
            CHECK((moved[a] - moved[b]).norm() < 1.5 * before);
            CHECK((moved[a] - moved[b]).norm() > 0.4 * before);
        }
}

TEST_CASE("a ring's line is found from its mesh") {
    Muscle ring = mouthRing();
    const std::vector<Vec3> line = ringLine(ring.surface);
    CHECK(line.size() == 16);
    for (const Vec3& p : line) {
        double nearest = 1;
        for (int k = 0; k < 1000; ++k) nearest = std::min(nearest, (mouthLine(k / 1000.0) - p).norm());
        CHECK(nearest < 0.06); // the slices are wide
    }
    ring.fibre = line;
    CHECK(MuscleDeformer(ring).state(1).thickening == Approx(1).epsilon(0.1));
}

TEST_CASE("a wide ring may narrow until it meets in its middle, and no more") {
    constexpr int around = 48, across = 24;
    Muscle muscle;
    muscle.form = MuscleForm::Ring;
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) {
            const double u = turn * i / around, r = 20 + 15 * std::cos(turn * k / across);
            muscle.surface.vertices.emplace_back(r * std::cos(u), r * std::sin(u),
                                                 2.5 * std::sin(turn * k / across));
            const int a = i * across + k, b = i * across + (k + 1) % across,
                      c = (i + 1) % around * across + k, d = (i + 1) % around * across + (k + 1) % across;
            muscle.surface.triangles.emplace_back(a, d, b);
            muscle.surface.triangles.emplace_back(a, c, d);
        }
    if (enclosedVolume(muscle.surface.vertices, muscle.surface.triangles) < 0)
        for (Tri& t : muscle.surface.triangles) std::swap(t[1], t[2]);
    muscle.fibre = ringLine(muscle.surface);
    muscle.maxContraction = 0.1;
    CHECK_NOTHROW(MuscleDeformer(muscle));
    muscle.maxContraction = 0.4;
    CHECK_THROWS_WITH(MuscleDeformer(muscle), Catch::Contains("its own middle"));
}

TEST_CASE("the line of a ring that is higher than wide goes round where it is open") {
    constexpr int around = 48, across = 24;
    TriangleMesh ring;
    for (int i = 0; i < around; ++i)
        for (int k = 0; k < across; ++k) {
            const double u = turn * i / around, r = 10 + 3 * std::cos(turn * k / across);
            ring.vertices.emplace_back(r * std::cos(u), r * std::sin(u), 15 * std::sin(turn * k / across));
            const int a = i * across + k, b = i * across + (k + 1) % across,
                      c = (i + 1) % around * across + k, d = (i + 1) % around * across + (k + 1) % across;
            ring.triangles.emplace_back(a, d, b);
            ring.triangles.emplace_back(a, c, d);
        }
    for (const Vec3& p : ringLine(ring)) {
        CHECK(p.z() == Approx(0).margin(0.5));
        CHECK(p.head<2>().norm() == Approx(10).margin(1));
    }
}

TEST_CASE("rings of muscle that cannot be served are refused") {
    const FloatTrapsOff traps; // what is not a number is handed over on purpose
    Muscle muscle = mouthRing();
    SECTION("two points") {
        muscle.fibre.resize(2);
    }
    SECTION("a line without area") {
        muscle.fibre = {Vec3::Zero(), Vec3::UnitX(), 2 * Vec3::UnitX()};
    }
    SECTION("there and back") {
        std::swap(muscle.fibre[3], muscle.fibre[4]);
    }
    SECTION("twice round") {
        const std::vector<Vec3> once = muscle.fibre;
        muscle.fibre.insert(muscle.fibre.end(), once.begin(), once.end());
    }
    SECTION("its first point again at the end") {
        muscle.fibre.push_back(muscle.fibre.front());
    }
    SECTION("a point that is not a number") {
        muscle.fibre[2].x() = std::nan("");
    }
    SECTION("narrowed to nothing") {
        muscle.maxContraction = 0.96;
    }
    CHECK_THROWS_AS(MuscleDeformer(std::move(muscle)), InputError);
}
