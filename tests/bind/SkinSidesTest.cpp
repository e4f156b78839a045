// Where a skin is parted between bones.
#include "bake/bind/SkinSides.h"
#include "tests/geometry/TestMeshes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace tss;

namespace {

constexpr int around = 24;

/// An open tube along x, 60 long, thinner about x = 40.
TriangleMesh vase() {
    TriangleMesh mesh;
    for (int x = 0; x <= 60; ++x)
        for (int k = 0; k < around; ++k) {
            const double angle = 2 * std::numbers::pi * k / around,
                         radius = std::clamp(0.5 * std::abs(x - 40), 2.0, 4.0);
            mesh.vertices.emplace_back(x, radius * std::cos(angle), radius * std::sin(angle));
        }
    for (int x = 0; x < 60; ++x)
        for (int k = 0; k < around; ++k) {
            const int a = x * around + k, b = x * around + (k + 1) % around;
            mesh.triangles.emplace_back(a, b, b + around);
            mesh.triangles.emplace_back(a, b + around, a + around);
        }
    return mesh;
}

std::vector<SkinSide> between(const TriangleMesh& mesh, double low, double high) {
    std::vector<SkinSide> sides;
    for (const Vec3& v : mesh.vertices)
        sides.push_back(v.x() <= low    ? SkinSide::Inside
                        : v.x() >= high ? SkinSide::Outside
                                        : SkinSide::Either);
    return sides;
}

/// The second of two influences turned by a right angle about the y axis through (x, 0, 0).
MovedGroup swing(double x) {
    const Eigen::Translation3d to(x, 0, 0);
    return {{0, 1}, {Pose(to * Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()) * to.inverse())}};
}

} // namespace

TEST_CASE("a skin is cut where it is thinnest, or where a cut costs less") {
    const TriangleMesh mesh = vase();
    const SkinGraph graph = skinGraph(mesh);
    std::vector<double> price(mesh.vertices.size(), 1);
    const SkinCut thin = SkinCutter(mesh, graph, price).cut(between(mesh, 10, 55));
    CHECK(thin.cost == Approx(4 * std::numbers::pi).epsilon(0.1));
    for (std::size_t v = 0; v < price.size(); ++v) {
        CHECK((mesh.vertices[v].x() < 36 ? thin.inside[v] : true));
        CHECK((mesh.vertices[v].x() > 44 ? !thin.inside[v] : true));
        price[v] = std::abs(mesh.vertices[v].x() - 25) < 2 ? 0.25 : 1;
    }
    const SkinCut cheap = SkinCutter(mesh, graph, price).cut(between(mesh, 10, 55));
    CHECK(cheap.cost == Approx(2 * std::numbers::pi).epsilon(0.1));
    for (std::size_t v = 0; v < price.size(); ++v)
        CHECK(bool(cheap.inside[v]) == (mesh.vertices[v].x() < 25.5 && cheap.inside[v]));
    std::vector<SkinSide> without = between(mesh, 10, 55);
    for (std::size_t v = 0; v < price.size(); ++v)
        if (std::abs(mesh.vertices[v].x() - 20) < 2) without[v] = SkinSide::Removed;
    const SkinCut free = SkinCutter(mesh, graph, price).cut(without);
    CHECK(free.cost == 0);
    CHECK(std::count(free.inside.begin(), free.inside.end(), 1) == 19 * around);
}

TEST_CASE("a part between two bones is attached beyond the joint, whether the skin is thin there or not") {
    const TriangleMesh mesh = vase();
    const SkinAnatomy anatomy(mesh, {}, {});
    std::vector<SkinInfluence> influences(2);
    for (const Vec3& v : mesh.vertices) {
        influences[0].distance.push_back(1 + std::max(0.0, v.x() - 12));
        influences[1].distance.push_back(1 + std::max(0.0, 50 - v.x()));
    }
    influences[0].size = influences[1].size = 10;
    const auto ring = [&](double low, double high) {
        std::vector<std::uint32_t> part;
        for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
            if (mesh.vertices[v].x() >= low && mesh.vertices[v].x() <= high) part.push_back(v);
        return part;
    };
    CHECK(SkinSides(anatomy, influences, {swing(20)}).ownersOf(ring(44, 46)) == std::vector<std::size_t>{1});
    CHECK(SkinSides(anatomy, influences, {swing(47)}).ownersOf(ring(26, 28)) == std::vector<std::size_t>{0});
}

TEST_CASE("seeds that lie far off by chance part no skin, and each bone has what is on its side of the cut") {
    const TriangleMesh mesh = vase();
    const SkinAnatomy anatomy(mesh, {}, {});
    std::vector<SkinInfluence> influences(2);
    for (const Vec3& v : mesh.vertices) {
        const bool odd = v.x() < 8; // nearer to the other one, as a foot of a crouching animal is
        influences[0].distance.push_back(odd ? 40 : 1 + std::abs(v.x() - 22));
        influences[1].distance.push_back(odd ? 20 : 1 + std::abs(v.x() - 50));
    }
    influences[0].size = influences[1].size = 10;
    SkinSides(anatomy, influences, {swing(30)}).assignCertain(influences);
    const auto sure = [&](std::size_t h, auto&& which) {
        return std::count_if(influences[h].certain.begin(), influences[h].certain.end(),
                             [&](std::uint32_t v) { return which(mesh.vertices[v].x()); });
    };
    CHECK(sure(0, [](double x) { return x < 25; }) == 25 * around);
    CHECK(sure(1, [](double x) { return x > 52; }) == 8 * around);
    CHECK(sure(0, [](double x) { return x > 42; }) + sure(1, [](double x) { return x < 30; }) == 0);
}

TEST_CASE("a shell on which one bone alone is sure of anything is that one's") {
    TriangleMesh mesh = vase();
    const std::size_t count = mesh.vertices.size();
    test::append(mesh, test::transformed(vase(), Eigen::Affine3d(Eigen::Translation3d(0, 20, 0))));
    const SkinAnatomy anatomy(mesh, {}, {});
    std::vector<SkinInfluence> influences(2);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const double x = mesh.vertices[v].x();
        influences[0].distance.push_back(v < count ? 1 + std::abs(x - 22) : 60);
        influences[1].distance.push_back(1 + std::abs(x - 50));
    }
    influences[0].size = influences[1].size = 10;
    SkinSides(anatomy, influences, {swing(30)}).assignCertain(influences);
    const auto second = [&](const SkinInfluence& h) {
        return std::count_if(h.certain.begin(), h.certain.end(), [&](std::uint32_t v) { return v >= count; });
    };
    CHECK(second(influences[0]) == 0);
    CHECK(second(influences[1]) == static_cast<std::ptrdiff_t>(count));
}
