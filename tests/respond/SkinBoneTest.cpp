#include "SkinShapes.h"
#include "tests/FloatTraps.h"
#include "tests/Shapes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

using namespace tss;

namespace {

/// A surface of revolution about z from points (r, z), outward where r falls as z rises; open at the first
/// one.
TriangleMesh revolved(const std::vector<std::pair<double, double>>& profile, int sides) {
    TriangleMesh mesh;
    const int rows = static_cast<int>(profile.size());
    for (const auto& [r, z] : profile)
        for (int k = 0; k < sides; ++k) {
            const double a = 2 * M_PI * k / sides;
            mesh.vertices.emplace_back(r * std::cos(a), r * std::sin(a), z);
        }
    const int top = static_cast<int>(mesh.vertices.size());
    mesh.vertices.emplace_back(0, 0, profile.back().second);
    for (int j = 0; j < rows; ++j)
        for (int k = 0; k < sides; ++k) {
            const int a = j * sides + k, b = j * sides + (k + 1) % sides;
            if (j + 1 == rows) {
                mesh.triangles.emplace_back(a, b, top);
                continue;
            }
            mesh.triangles.emplace_back(a, b, b + sides);
            mesh.triangles.emplace_back(a, b + sides, a + sides);
        }
    return mesh;
}

/// A finger of skin upright on a plate, over a bone that begins above the plate.
struct Finger {
    static constexpr double thickness = 0.2;
    skins::Couple couple;
    SkinParameters parameters;
    Pose swung = Pose::Identity();

    explicit Finger(double degrees) {
        std::vector<std::pair<double, double>> skin, bone;
        for (double r = 24; r > 1.4; r *= 0.9) skin.emplace_back(r, 0);
        for (double z = 0.1; z < 10; z += 0.25) skin.emplace_back(1.25, z);
        for (double a = 0; a < 1.4; a += 0.3) skin.emplace_back(1.25 * std::cos(a), 10 + 1.25 * std::sin(a));
        for (double a = -1.4; a < 0; a += 0.3) bone.emplace_back(std::cos(a), 2 + std::sin(a));
        for (double z = 2; z < 10; z += 0.25) bone.emplace_back(1, z);
        for (double a = 0; a < 1.4; a += 0.3) bone.emplace_back(std::cos(a), 10 + std::sin(a));
        Muscle muscle;
        muscle.surface = revolved(bone, 24);
        muscle.surface.vertices.emplace_back(0, 0, bone.front().second);
        for (int k = 0; k < 24; ++k)
            muscle.surface.triangles.emplace_back((k + 1) % 24, k,
                                                  static_cast<int>(muscle.surface.vertices.size()) - 1);
        muscle.fibre = {{0, 0, 1}, {0, 0, 11}};
        muscle.activationUpper = 0;
        couple = skins::couple(revolved(skin, 24), {muscle}, thickness);
        swung.linear() = Eigen::AngleAxisd(degrees * M_PI / 180, Vec3::UnitY()).toRotationMatrix();
        parameters.swings = {BoneSwing{{swung}}};
    }
};

} // namespace

TEST_CASE("a bone that swings wide takes its skin along as it turns; skin far from its root stays") {
    for (const double degrees : {20.0, 80.0, 135.0}) {
        INFO(degrees << " degrees");
        const Finger finger(degrees);
        const auto rig = finger.couple.rig(finger.parameters);
        SkinResponse response(rig);
        for (int f = 0; f < 40; ++f) response.update(std::vector<double>{0}, std::vector<Pose>{finger.swung});
        double behind = 0, strayed = 0;
        int carried = 0, far = 0;
        std::vector<bool> onBone(rig->rest.size(), false);
        for (std::size_t v = 0; v < rig->rest.size(); ++v) {
            const Vec3 rest = rig->rest[v], now = response.positions()[v];
            if (rest.z() > 4) {
                onBone[v] = true;
                ++carried;
                behind = std::max(behind, (now - finger.swung * rest).norm());
            } else if (rest.z() == 0 && rest.norm() > 12) {
                ++far;
                strayed = std::max(strayed, (now - rest).norm());
            }
        }
        CHECK(carried > 500);
        CHECK(behind < 0.6 * Finger::thickness);
        CHECK(strayed < Finger::thickness);
        // The plate beyond what may move at all is not in the rig.
        CHECK(far + 500 < static_cast<int>(finger.couple.skin.vertices.size()));
        double leastCosine = 1;
        for (const Tri& t : rig->triangles) {
            if (!onBone[t[0]] || !onBone[t[1]] || !onBone[t[2]]) continue;
            const auto normal = [&](const auto& x) -> Vec3 {
                return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).normalized();
            };
            leastCosine = std::min(
                leastCosine, normal(response.positions()).dot(finger.swung.linear() * normal(rig->rest)));
        }
        CHECK(leastCosine > 0.9);
    }
}

TEST_CASE("skin that all its bones take along together goes all the way, by weights found or given") {
    const TriangleMesh skin = revolved({{1, 0}, {1, 1}, {1, 2}, {1, 3}, {1, 4}, {1, 5}, {0.5, 6}}, 16);
    std::vector<std::shared_ptr<const MuscleDeformer>> bones;
    SkinParameters parameters;
    for (int k = 0; k < 4; ++k) {
        bones.push_back(skins::boneOf(boxMesh({-0.3, -0.3, 1.5 * k}, {0.3, 0.3, 1.5 * k + 1})));
        parameters.frames.push_back(k);
    }
    SkinTable nothingMet;
    nothingMet.table.rowOffsets = {0};
    const Pose slid(Eigen::Translation3d(100, 0, 0));
    for (const bool given : {false, true}) {
        INFO(given);
        SkinParameters own = parameters;
        // Each bone by itself, so that none is known to move with another.
        for (int k = 1; k < 4; ++k) {
            std::vector<Pose> swing(4, Pose::Identity());
            for (int j = k; j < 4; ++j) swing[j] = Pose(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
            own.swings.push_back({swing});
        }
        if (given) own.shares.assign(4, std::vector<double>(skin.vertices.size(), 0.25));
        SkinResponse response(makeSkinRig(skin, bones, nothingMet, own));
        response.update(std::vector<double>(4, 0), std::vector<Pose>(4, slid));
        REQUIRE(response.vertices().size() == skin.vertices.size());
        for (std::size_t k = 0; k < response.vertices().size(); ++k)
            CHECK((response.positions()[k] - slid * skin.vertices[response.vertices()[k]]).norm() < 1e-4);
    }
}

TEST_CASE("where every bone moves, skin within half a bone's size of them goes along") {
    const TriangleMesh skin = revolved({{0.8, 0.1}, {0.8, 1}, {0.8, 2}, {0.8, 3}, {0.8, 4}, {0.4, 4.5}}, 16);
    std::vector<std::shared_ptr<const MuscleDeformer>> bones;
    for (int k = 0; k < 3; ++k)
        bones.push_back(skins::boneOf(boxMesh({-0.3, -0.3, 1.5 * k}, {0.3, 0.3, 1.5 * k + 1.2})));
    const Pose slid(Eigen::Translation3d(1, 0, 0));
    SkinParameters parameters;
    parameters.swings = {{std::vector<Pose>(3, slid)}}; // a root
    SkinTable nothingMet;
    nothingMet.table.rowOffsets = {0};
    SkinResponse response(makeSkinRig(skin, bones, nothingMet, parameters));
    response.update(std::vector<double>(3, 0), std::vector<Pose>(3, slid));
    REQUIRE(response.vertices().size() == skin.vertices.size());
    double behind = 0;
    for (std::size_t k = 0; k < response.vertices().size(); ++k)
        behind += (response.positions()[k] - slid * skin.vertices[response.vertices()[k]]).norm();
    CHECK(behind < 0.05 * static_cast<double>(skin.vertices.size()));
}

TEST_CASE("a bone that another joint has left at rest is met by its own front, whatever was tried before") {
    const TriangleMesh skin = skins::vaultedSheet(32, 1, 0.2, 0);
    const std::vector<std::shared_ptr<const MuscleDeformer>> bones{
        skins::boneOf(boxMesh({-0.4, -0.4, -0.6}, {0.4, 0.4, 0})),
        skins::boneOf(boxMesh({0.7, -0.1, -0.6}, {0.9, 0.1, 0}))};
    // The skin follows the second bone, down to just before the first one, which may turn upside down.
    const Pose turned(Eigen::Translation3d(0, 0, -0.3) * Eigen::AngleAxisd(M_PI, Vec3::UnitX()) *
                      Eigen::Translation3d(0, 0, 0.3)),
        lowered(Eigen::Translation3d(0, 0, -0.196));
    const BoneSwing turn{{turned, Pose::Identity()}}, lower{{Pose::Identity(), lowered}};
    const auto metWith = [&](std::vector<BoneSwing> swings) {
        SkinParameters parameters;
        parameters.swings = std::move(swings);
        parameters.shares = {std::vector<double>(skin.vertices.size(), 0),
                             std::vector<double>(skin.vertices.size(), 1)};
        SkinTable nothingMet;
        nothingMet.table.rowOffsets = {0};
        const auto rig = makeSkinRig(skin, bones, nothingMet, parameters);
        return std::ranges::count_if(rig->rows, [](const SkinRow& row) { return row.body == 0; });
    };
    CHECK(metWith({lower}) == 4); // the corners of its upper side
    CHECK(metWith({turn, lower}) == 4);
}

TEST_CASE("a vertex of no triangle changes nothing of a skin") {
    TriangleMesh skin = revolved({{1, 0}, {1, 1}, {1, 2}, {1, 3}, {1, 4}, {1, 5}, {0.5, 6}}, 16);
    const std::vector<std::shared_ptr<const MuscleDeformer>> bones{
        skins::boneOf(boxMesh({-0.3, -0.3, 0}, {0.3, 0.3, 2.5})),
        skins::boneOf(boxMesh({-0.3, -0.3, 3}, {0.3, 0.3, 5.5}))};
    const Pose bent(Eigen::Translation3d(0, 0, 2.75) * Eigen::AngleAxisd(0.6, Vec3::UnitY()) *
                    Eigen::Translation3d(0, 0, -2.75));
    SkinParameters parameters;
    parameters.swings = {{{Pose::Identity(), bent}}};
    SkinTable nothingMet;
    nothingMet.table.rowOffsets = {0};
    const auto moved = [&] {
        SkinResponse response(makeSkinRig(skin, bones, nothingMet, parameters));
        response.update(std::vector<double>{0, 0}, std::vector<Pose>{Pose::Identity(), bent});
        std::vector<Vec3> places = skin.vertices;
        for (std::size_t k = 0; k < response.vertices().size(); ++k)
            places[response.vertices()[k]] = response.positions()[k];
        return places;
    };
    const std::vector<Vec3> without = moved();
    skin.vertices.emplace_back(500, 0, 0);
    const std::vector<Vec3> with = moved();
    for (std::size_t v = 0; v < without.size(); ++v) CHECK(with[v] == without[v]);
}

TEST_CASE("a bone that is thrown out of all bounds, or is no number, leaves its skin at rest") {
    const FloatTrapsOff traps;
    const Finger finger(20);
    const auto rig = finger.couple.rig(finger.parameters);
    SkinResponse response(rig);
    for (const double far : {1e12, 1e21, 1e200, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
        Pose thrown = finger.swung;
        thrown.translation().x() = far;
        for (int f = 0; f < 3; ++f) response.update(std::vector<double>{0}, std::vector<Pose>{thrown});
        for (const Vec3& x : response.positions()) REQUIRE(x.allFinite());
        if (!(far < 1e15)) CHECK(std::ranges::equal(response.positions(), rig->rest));
    }
    response.update(std::vector<double>{0}, std::vector<Pose>{Pose::Identity()});
    CHECK(std::ranges::equal(response.positions(), rig->rest));
}
