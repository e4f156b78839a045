#include "SkinShapes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

using namespace tss;

namespace {

struct Sheet {
    TriangleMesh mesh = skins::vaultedSheet(16, 1, 0, 0.2);
    std::vector<float> masses = std::vector<float>(mesh.vertices.size(), 1);
    std::vector<Move> still = std::vector<Move>(mesh.vertices.size(), Move::Zero());
    std::vector<Vec3> places = mesh.vertices;

    std::size_t relax() {
        const SkinWeave weave = makeWeave(mesh.vertices, mesh.triangles, masses);
        return SkinStrain(weave).relax(mesh.vertices, {}, {}, still, {}, places);
    }
    double ratio(int i, int j) const {
        return (places[i] - places[j]).norm() / (mesh.vertices[i] - mesh.vertices[j]).norm();
    }
};

} // namespace

TEST_CASE("a skin within its limits is left alone, bit for bit") {
    Sheet sheet;
    for (Vec3& x : sheet.places) x = 1.2 * x + Vec3(0.1, 0, 0.3 * x.x());
    const std::vector<Vec3> before = sheet.places;
    CHECK(sheet.relax() == 0);
    CHECK(sheet.places == before);
}

TEST_CASE(
    "vertices that are torn out bring their neighbours along until nothing is stretched or turned over") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> any(-0.3, 0.3);
    for (int round = 0; round < 20; ++round) {
        Sheet sheet;
        double farthest = 0;
        for (int k = 0; k < 12; ++k) {
            const Vec3 move(any(random), any(random), any(random));
            sheet.places[random() % sheet.places.size()] += move;
        }
        for (std::size_t v = 0; v < sheet.places.size(); ++v)
            farthest = std::max(farthest, (sheet.places[v] - sheet.mesh.vertices[v]).norm());
        INFO("seed 5, round " << round);
        CHECK(sheet.relax() == 0);
        for (const Tri& t : sheet.mesh.triangles) {
            for (int k = 0; k < 3; ++k) {
                const double ratio = sheet.ratio(t[k], t[(k + 1) % 3]);
                CHECK(ratio > strain::shortestEdge * (1 - strain::slack) - 1e-9);
                CHECK(ratio < strain::longestEdge * (1 + strain::slack) + 1e-9);
            }
            const auto normal = [&](const std::vector<Vec3>& x) -> Vec3 {
                return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
            };
            CHECK(normal(sheet.places).dot(normal(sheet.mesh.vertices)) > 0);
        }
        for (std::size_t v = 0; v < sheet.places.size(); ++v)
            CHECK((sheet.places[v] - sheet.mesh.vertices[v]).norm() <= farthest);
    }
}

TEST_CASE("a triangle that is hardly turned too far hardly moves") {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 0.8, 0}};
    mesh.triangles = {{0, 1, 2}};
    const SkinWeave weave = makeWeave(mesh.vertices, mesh.triangles, {1, 1, 1});
    const std::vector<Move> still(3, Move::Zero());
    for (const double cosine : {0.0999, 0.09}) { // 0.1 is let be
        const Eigen::AngleAxisd turn(std::acos(cosine), Vec3(1, 0.3, 0).normalized());
        std::vector<Vec3> places;
        for (const Vec3& x : mesh.vertices) places.push_back(turn * x);
        const std::vector<Vec3> before = places;
        SkinStrain(weave).relax(mesh.vertices, {}, {}, still, {}, places);
        double moved = 0;
        for (int v = 0; v < 3; ++v) moved = std::max(moved, (places[v] - before[v]).norm());
        CHECK(moved > 0);
        CHECK(moved < 0.03);
    }
}

TEST_CASE("a contact that the limits of edges touch is pressed no less deep than the solve left it") {
    for (const double left : {0.05, 0.0}) {
        Sheet sheet;
        for (Vec3& x : sheet.places) x *= 1.503; // every edge a little too long
        const std::size_t v = sheet.places.size() / 2;
        std::vector<SheetPlane> planes(1);
        planes[0].normal = Move(0, 0, 1, 0);
        for (std::uint32_t& k : planes[0].vertex) k = static_cast<std::uint32_t>(v);
        planes[0].weight[0] = 1;
        planes[0].vertices = 1;
        planes[0].bound = static_cast<float>((sheet.places[v] - sheet.mesh.vertices[v]).z() + 0.05);
        planes[0].compliance = planes[0].inverse = 0.5f;
        planes[0].multiplier = static_cast<float>(left / 0.5);
        std::vector<std::uint32_t> patch(sheet.places.size());
        std::iota(patch.begin(), patch.end(), 0u);
        const Vec3 before = sheet.places[v];
        const SkinWeave weave = makeWeave(sheet.mesh.vertices, sheet.mesh.triangles, sheet.masses);
        SkinStrain(weave).relax(sheet.mesh.vertices, planes, patch, sheet.still, {}, sheet.places);
        const double moved = std::abs(sheet.places[v].z() - before.z());
        if (left > 0)
            CHECK(moved < 0.005);
        else
            CHECK(moved > 0.01); // what has come in meanwhile is pressed out
    }
}

TEST_CASE("every kernel finds what is beyond its limits, and the same normals to the bit") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> any(-0.1, 0.1);
    Sheet sheet;
    for (Vec3& x : sheet.places) x += Vec3(any(random), any(random), any(random));
    SkinWeave weave = makeWeave(sheet.mesh.vertices, sheet.mesh.triangles, sheet.masses);
    for (const std::size_t left : {0u, 1u, 3u}) { // beyond the last four
        weave.links.resize(weave.links.size() / 4 * 4 - 4 + left);
        weave.triangles.resize(weave.triangles.size() / 4 * 4 - 4 + left);
        std::vector<SkinPlace> places(sheet.places.size(), SkinPlace::Constant(std::nan("")));
        std::vector<SkinPlace> normals(places.size(), SkinPlace::Zero());
        for (std::size_t v = 0; v < places.size(); ++v) places[v].head<3>() = sheet.places[v];
        std::vector<std::uint64_t> beyond((weave.links.size() + 63) / 64);
        std::vector<std::uint64_t> over((weave.triangles.size() + 63) / 64);
        std::size_t found = 0;
        const auto mark = [&](std::vector<std::uint64_t>& marks, std::size_t k) {
            marks[k / 64] |= std::uint64_t{1} << (k % 64);
            ++found;
        };
        for (std::size_t e = 0; e < weave.links.size(); ++e) {
            const SkinLink& l = weave.links[e];
            const double now = (sheet.places[l.i] - sheet.places[l.j]).squaredNorm();
            if (!strain::within(now, weave.squared[e])) mark(beyond, e);
        }
        for (std::size_t t = 0; t < weave.triangles.size(); ++t) {
            const Vec3 now = areaNormal(sheet.places, weave.triangles[t]);
            if (!strain::lies(now, weave.normals[t])) mark(over, t);
            for (int k = 0; k < 3; ++k) normals[weave.triangles[t][k]].head<3>() += now;
        }
        CHECK(found > 50);
        CHECK(found < weave.links.size());
        for (const KernelTarget target : {KernelTarget::Scalar, KernelTarget::Sse2, KernelTarget::Avx2,
                                          KernelTarget::Avx512, KernelTarget::Neon, KernelTarget::Best}) {
            if (!available(target)) continue;
            INFO(name(target));
            const SkinKernels& kernels = skinKernels(target);
            std::vector<std::uint64_t> links(beyond.size()), triangles(over.size());
            std::vector<SkinPlace> sums(places.size(), SkinPlace::Zero());
            kernels.links(weave, places.data(), links.data());
            kernels.triangles(weave, places.data(), triangles.data());
            kernels.normals(weave.triangles, places.data(), sums.data());
            CHECK(links == beyond);
            CHECK(triangles == over);
            for (std::size_t v = 0; v < sums.size(); ++v) REQUIRE(sums[v].head<3>() == normals[v].head<3>());
            sums[6].setZero(); // as where no triangle is
            std::vector<Vec3> units(sums.size() / 4 * 4 - 4 + left);
            kernels.normalise(sums.data(), units);
            CHECK(units[6] == Vec3::Zero());
            for (std::size_t v = 0; v < units.size(); ++v) {
                const Vec3 n = sums[v].head<3>();
                const double squared = n.x() * n.x() + (n.y() * n.y() + n.z() * n.z());
                REQUIRE(units[v] == (squared > 0 ? Vec3(n / std::sqrt(squared)) : n));
            }
        }
    }
}

TEST_CASE("what is fixed stays, its neighbours come to it") {
    Sheet sheet;
    for (int v = 0; v < 17; ++v) sheet.masses[v] = 0; // one side of the sheet
    for (std::size_t v = 17; v < sheet.places.size(); ++v) sheet.places[v] += Vec3(0, 0.25, 0);
    CHECK(sheet.relax() == 0);
    for (int v = 0; v < 17; ++v) CHECK(sheet.places[v] == sheet.mesh.vertices[v]);
    CHECK(sheet.ratio(0, 17) < strain::longestEdge * (1 + strain::slack));
    CHECK(sheet.places.back().y() > sheet.mesh.vertices.back().y() + 0.2);
}
