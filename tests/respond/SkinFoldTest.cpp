#include "SkinShapes.h"
#include "tests/Shapes.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <map>

using namespace tss;

namespace {

constexpr double gap = 1.2, thickness = 0.3,
                 closing = 1.4; // of the flaps; the lower bone comes nearer by that much

/// Quads between rows of points that all have the same length.
void addRows(TriangleMesh& mesh, const std::vector<std::vector<Vec3>>& rows) {
    const int first = static_cast<int>(mesh.vertices.size()), length = static_cast<int>(rows[0].size());
    for (const auto& row : rows) mesh.vertices.insert(mesh.vertices.end(), row.begin(), row.end());
    for (int j = 0; j + 1 < static_cast<int>(rows.size()); ++j)
        for (int i = 0; i + 1 < length; ++i) {
            const int a = first + j * length + i, b = a + 1, c = b + length, d = a + length;
            mesh.triangles.emplace_back(a, c, b);
            mesh.triangles.emplace_back(a, d, c);
        }
}

/// A point every `step` from one place to another, both included.
std::vector<double> spaced(double from, double to, double step) {
    std::vector<double> result;
    const int count = static_cast<int>(std::lround(std::abs(to - from) / step));
    for (int i = 0; i <= count; ++i) result.push_back(from + (to - from) * i / count);
    return result;
}

/// Along y, at every place of a profile in x and z.
std::vector<std::vector<Vec3>> extruded(const std::vector<std::pair<double, double>>& profile, double half) {
    std::vector<std::vector<Vec3>> rows;
    for (const auto& [x, z] : profile) {
        rows.emplace_back();
        for (const double y : spaced(-half, half, 0.25)) rows.back().emplace_back(x, y, z);
    }
    return rows;
}

/// A mouth: two flaps that lie one over the other and hang together at one side, their outsides towards each
/// other.
TriangleMesh mouth() {
    std::vector<std::pair<double, double>> profile;
    for (const double x : spaced(6, 0, 0.25)) profile.emplace_back(x, gap / 2);
    for (double a = 0.35; a < M_PI - 0.2; a += 0.35)
        profile.emplace_back(-gap / 2 * std::sin(a), gap / 2 * std::cos(a));
    for (const double x : spaced(0, 6, 0.25)) profile.emplace_back(x, -gap / 2);
    TriangleMesh mesh;
    addRows(mesh, extruded(profile, 2.5));
    return mesh;
}

/// A bone behind a flap: a slab between two heights, in quads.
Muscle slab(double low, double high) {
    constexpr double step = 0.25;
    const Vec3 lower(1, -3, low), upper(7, 3, high);
    Muscle bone;
    std::map<std::array<int, 3>, int> known;
    const auto at = [&](const Vec3& x) {
        const Vec3 cell = ((x - lower) / (step / 4)).array().round();
        const auto [found, isNew] = known.try_emplace(
            {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())},
            static_cast<int>(bone.surface.vertices.size()));
        if (isNew) bone.surface.vertices.push_back(x);
        return found->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const bool top : {false, true}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const std::vector<double> us = spaced(lower[u], upper[u], step),
                                      vs = spaced(lower[v], upper[v], step);
            for (std::size_t i = 0; i + 1 < us.size(); ++i)
                for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
                    int corner[4];
                    for (int k = 0; k < 4; ++k) {
                        Vec3 x;
                        x[axis] = (top ? upper : lower)[axis];
                        x[u] = us[i + (k == 1 || k == 2)];
                        x[v] = vs[j + (k >= 2)];
                        corner[k] = at(x);
                    }
                    if (!top) std::swap(corner[1], corner[3]);
                    bone.surface.triangles.emplace_back(corner[0], corner[1], corner[2]);
                    bone.surface.triangles.emplace_back(corner[0], corner[2], corner[3]);
                }
        }
    bone.fibre = {{1, 0, (low + high) / 2}, {7, 0, (low + high) / 2}};
    bone.activationUpper = 0;
    return bone;
}

struct Mouth {
    skins::Couple couple = skins::couple(mouth(), {slab(1.05, 1.85), slab(-1.85, -1.05)}, thickness);
    SkinParameters parameters;
    std::vector<Pose> closed{Pose::Identity(), Pose(Eigen::Translation3d(0, 0, closing))};

    explicit Mouth(bool selfContact) {
        parameters.selfContact = selfContact;
        BoneSwing swing;
        for (int s = 1; s <= 8; ++s)
            swing.push_back({Pose::Identity(), Pose(Eigen::Translation3d(0, 0, closing * s / 8))});
        parameters.swings = {swing};
    }
};

/// How deep the flaps are in each other, seen along z at places well inside: the mean heights around them.
double overlap(const SkinRig& rig, std::span<const Vec3> positions) {
    double deepest = -1e9;
    for (const double x : spaced(2, 5, 0.5)) {
        double upper = 0, lower = 0;
        int uppers = 0, lowers = 0;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            const Vec3& rest = rig.rest[v];
            if (std::abs(rest.y()) > 1 || std::abs(positions[v].x() - x) > 0.3 || rest.x() < 0) continue;
            (rest.z() > 0 ? upper : lower) += positions[v].z();
            ++(rest.z() > 0 ? uppers : lowers);
        }
        REQUIRE(uppers > 0);
        REQUIRE(lowers > 0);
        deepest = std::max(deepest, lower / lowers - upper / uppers);
    }
    return deepest;
}

std::ptrdiff_t foldsOf(const SkinRig& rig) {
    return std::count_if(rig.rows.begin(), rig.rows.end(),
                         [](const SkinRow& row) { return row.kind == SkinContactKind::SkinOnSkin; });
}

} // namespace

TEST_CASE("two parts of one skin that come to touch keep out of each other where that is asked for") {
    const std::vector<double> none{0, 0};
    double without = 0;
    for (const bool selfContact : {false, true}) {
        const Mouth mouth(selfContact);
        const auto rig = mouth.couple.rig(mouth.parameters);
        CHECK((foldsOf(*rig) == 0) == !selfContact);
        SkinResponse response(rig);
        SkinUpdate update;
        for (int f = 0; f < 40; ++f) update = response.update(none, mouth.closed);
        const double deep = overlap(*rig, response.positions());
        INFO("overlap " << deep << ", " << foldsOf(*rig) << " folds, " << update.contacts << " contacts");
        if (!selfContact) {
            without = deep;
            CHECK(deep > 0.15);
            continue;
        }
        CHECK(without > 0);
        CHECK(deep < 0.1 * without);
        CHECK(deep > -0.1 * thickness); // and not farther apart than need be
        // Both give way.
        double up = 0, down = 0;
        for (std::size_t v = 0; v < rig->rest.size(); ++v) {
            const double asked = rig->rest[v].z() > 0 ? 0 : closing;
            const double moved = response.positions()[v].z() - rig->rest[v].z() - asked;
            up = std::max(up, moved);
            down = std::min(down, moved);
        }
        CHECK(up > 0.05);
        CHECK(down < -0.05);
        update = response.update(none);
        CHECK(update.rest);
        for (std::size_t v = 0; v < rig->rest.size(); ++v) CHECK(response.positions()[v] == rig->rest[v]);
    }
}

TEST_CASE("a skin whose parts never come near each other has no contact with itself") {
    skins::Couple usual = skins::usual();
    SkinParameters parameters;
    parameters.selfContact = true;
    CHECK(foldsOf(*usual.rig(parameters)) == 0);
}

TEST_CASE("a bone that goes into another limb is not taken for one that comes out of it from within") {
    // Two limbs side by side, each a ball about a ball of bone; one goes through the other.
    TriangleMesh skin = ballMesh({-1.5, 0, 0}, 1, 3);
    const TriangleMesh other = ballMesh({1.5, 0, 0}, 1, 3);
    const auto first = static_cast<int>(skin.vertices.size());
    skin.vertices.insert(skin.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Tri& t : other.triangles) skin.triangles.push_back(t.array() + first);
    std::vector<Muscle> bones(2);
    bones[0].surface = ballMesh({-1.5, 0, 0}, 0.9, 3);
    bones[1].surface = ballMesh({1.5, 0, 0}, 0.3, 3);
    for (Muscle& bone : bones) bone.activationUpper = 0;
    const skins::Couple limbs = skins::couple(skin, bones, 0.1);
    SkinParameters parameters;
    parameters.frames = {0, 1};
    const auto moved = [](double by) {
        return std::vector<Pose>{Pose::Identity(), Pose(Eigen::Translation3d(-by, 0, 0))};
    };
    BoneSwing swing;
    for (int s = 1; s <= 36; ++s) swing.push_back(moved(0.1 * s));
    parameters.swings = {swing};
    SkinResponse response(limbs.rig(parameters));
    for (double by = 0.5; by < 4; by += 0.1) {
        const SkinUpdate update = response.update(std::vector<double>(2, 0), moved(by));
        INFO("moved by " << by);
        CHECK(update.contacts == 0);
        for (std::size_t v = 0; v < response.positions().size(); ++v) {
            const Vec3& rest = response.rig().rest[v];
            const Vec3 carried = rest - (rest.x() > 0 ? by : 0) * Vec3::UnitX();
            REQUIRE((response.positions()[v] - carried).norm() < 1e-6);
        }
    }
}
