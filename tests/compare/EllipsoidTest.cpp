#include "bake/compare/Ellipsoid.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;
using namespace tss::compare;

namespace {

/// Distance from p to an axis-aligned ellipsoid at the origin by bisection of its Lagrange multiplier.
double distanceOutside(const Vec3& radii, const Vec3& p) {
    const auto inside = [&](double t) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += std::pow(radii[k] * p[k] / (t + radii[k] * radii[k]), 2);
        return sum < 1;
    };
    double low = 0, high = 100;
    for (int k = 0; k < 200; ++k) {
        const double middle = 0.5 * (low + high);
        (inside(middle) ? high : low) = middle;
    }
    Vec3 nearest;
    for (int k = 0; k < 3; ++k) nearest[k] = radii[k] * radii[k] * p[k] / (high + radii[k] * radii[k]);
    return (p - nearest).norm();
}

} // namespace

TEST_CASE("the characteristic polynomial says when a sphere and an ellipsoid touch") {
    const std::uint64_t seed = 4;
    INFO("seed " << seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> any(-1, 1), size(0.2, 2);
    int touched = 0;
    for (int round = 0; round < 3000; ++round) {
        BentEllipsoid ellipsoid;
        ellipsoid.radii = {size(random), size(random), size(random)};
        ellipsoid.axes = Eigen::Quaterniond(any(random), any(random), any(random), any(random))
                             .normalized()
                             .toRotationMatrix();
        ellipsoid.centre = {any(random), any(random), any(random)};
        const Vec3 local = 3 * Vec3(any(random), any(random), any(random));
        const double level = local.cwiseQuotient(ellipsoid.radii).squaredNorm();
        if (level <= 1) continue;
        const double distance = distanceOutside(ellipsoid.radii, local);
        for (const double share : {0.2, 0.99, 1.01, 2.0}) {
            const Sphere sphere{ellipsoid.centre + ellipsoid.axes * local, distance * share};
            CHECK(touches(ellipsoid, sphere) == (share > 1));
            touched += share > 1;
        }
    }
    CHECK(touched > 1000);
}

TEST_CASE("a sphere inside an ellipsoid touches it, whatever its size") {
    BentEllipsoid ellipsoid;
    ellipsoid.radii = {3, 1, 2};
    for (const double radius : {0.0, 1e-3, 0.5, 5.0}) CHECK(touches(ellipsoid, {Vec3(1, 0.2, -0.3), radius}));
}

TEST_CASE("a bent ellipsoid is met along its bend and not where it was straight") {
    BentEllipsoid ellipsoid;
    ellipsoid.radii = {2, 0.2, 0.2};
    ellipsoid.bend = 0.25;
    const double x = 1.5, along = 0.25 * x * x;
    CHECK(touches(ellipsoid, {Vec3(x, along, 0), 0.05}));
    CHECK_FALSE(touches(ellipsoid, {Vec3(x, 0, 0), 0.05}));
}

TEST_CASE("a test against an ellipsoid takes some ten times the products of a sphere's four") {
    BentEllipsoid ellipsoid;
    ellipsoid.radii = {2, 0.5, 0.7};
    ellipsoid.bend = 0.1;
    std::uint64_t products = 0;
    touches(ellipsoid, {Vec3(3, 1, 0.5), 0.2}, &products);
    CHECK(products > 30);
    CHECK(products < 80);
}

TEST_CASE("the ellipsoid fitted to a bent ball of triangles has its radii and its bend") {
    TriangleMesh mesh = ballMesh({0, 0, 0}, 1, 4);
    for (Vec3& v : mesh.vertices) {
        v = v.cwiseProduct(Vec3(3, 0.6, 0.9));
        v.y() += 0.05 * v.x() * v.x();
        v += Vec3(5, 6, 7);
    }
    const BentEllipsoid fit = fitEllipsoid(mesh);
    CHECK(fit.radii.x() == Approx(3).epsilon(0.02));
    CHECK(fit.radii.y() == Approx(0.6).epsilon(0.05));
    CHECK(fit.radii.z() == Approx(0.9).epsilon(0.05));
    CHECK(fit.bend == Approx(0.05).epsilon(0.05));
    CHECK(std::abs(fit.axes.col(0).x()) == Approx(1).epsilon(1e-3));
    CHECK(fit.axes.col(1).y() == Approx(1).epsilon(1e-2));
}
