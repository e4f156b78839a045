// Skin over parts of the body whose bones are not named.
#include "bake/bind/SkinAttachment.h"
#include "bake/respond/SkinResponse.h"
#include "bake/respond/SkinRig.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <set>

using namespace tss;

namespace {

using Box = std::array<int, 6>; ///< x, y, z from, x, y, z to

/// The surface of all cells of size 1 in some boxes, wound outwards.
TriangleMesh surfaceOf(const std::vector<Box>& boxes) {
    const auto filled = [&](int x, int y, int z) {
        return std::any_of(boxes.begin(), boxes.end(), [&](const Box& b) {
            return x >= b[0] && y >= b[1] && z >= b[2] && x < b[3] && y < b[4] && z < b[5];
        });
    };
    TriangleMesh mesh;
    std::map<std::array<int, 3>, int> corners;
    const auto corner = [&](std::array<int, 3> at) {
        const auto [place, isNew] = corners.try_emplace(at, static_cast<int>(mesh.vertices.size()));
        if (isNew) mesh.vertices.emplace_back(at[0], at[1], at[2]);
        return place->second;
    };
    std::map<std::array<int, 3>, bool> done;
    for (const Box& b : boxes)
        for (int x = b[0]; x < b[3]; ++x)
            for (int y = b[1]; y < b[4]; ++y)
                for (int z = b[2]; z < b[5]; ++z) {
                    if (!done.try_emplace({x, y, z}, true).second) continue;
                    for (int k = 0; k < 6; ++k) {
                        const int axis = k / 2, up = k % 2;
                        std::array<int, 3> beyond{x, y, z};
                        beyond[axis] += up ? 1 : -1;
                        if (filled(beyond[0], beyond[1], beyond[2])) continue;
                        std::array<int, 3> o{x, y, z};
                        o[axis] += up;
                        auto p = o, q = o, r = o;
                        p[(axis + 1) % 3] += 1, r[(axis + 2) % 3] += 1;
                        q[(axis + 1) % 3] += 1, q[(axis + 2) % 3] += 1;
                        const int a = corner(o), c = corner(q);
                        const int d = corner(up ? p : r), e = corner(up ? r : p);
                        mesh.triangles.emplace_back(a, d, c);
                        mesh.triangles.emplace_back(a, c, e);
                    }
                }
    return mesh;
}

/// Each triangle with vertices of its own, as where textures or normals have seams.
TriangleMesh splitAt(const TriangleMesh& mesh) {
    TriangleMesh split;
    for (const Tri& t : mesh.triangles) {
        const auto first = static_cast<int>(split.vertices.size());
        for (int k = 0; k < 3; ++k) split.vertices.push_back(mesh.vertices[t[k]]);
        split.triangles.emplace_back(first, first + 1, first + 2);
    }
    return split;
}

/// A trunk along x with two legs below one end. The left one's bones are named.
const std::vector<Box> animal = {{-10, -6, 20, 40, 6, 30}, {30, 4, 0, 34, 8, 26}, {30, -8, 0, 34, -4, 26}};

std::shared_ptr<const MuscleDeformer> boneIn(const Vec3& from, const Vec3& to) {
    Muscle bone;
    bone.surface = surfaceOf({{0, 0, 0, 1, 1, 1}});
    for (Vec3& v : bone.surface.vertices) v = from + v.cwiseProduct(to - from);
    bone.activationUpper = 0;
    return std::make_shared<const MuscleDeformer>(std::move(bone));
}

/// Of the left leg.
std::shared_ptr<const MuscleDeformer> boneOf(double from, double to) {
    return boneIn(Vec3(31.3, 5.3, from), Vec3(32.7, 6.7, to));
}

struct Setting {
    bool inverted = false, split = false; ///< of the skin
    std::optional<Vec3> joint{};          ///< else at the upper end of the first bone that moves
    Vec3 axis = Vec3::UnitY();
    std::vector<Box> body = animal;
    double splay = 0;           ///< of the legs: how much wider they stand per unit further down
    std::optional<Vec3> neck{}; ///< about which the last bone turns by itself too, in a swing of its own
};

/// All bones from the first that moves on are turned by 60 degrees.
class Bent {
public:
    Bent(const std::vector<std::shared_ptr<const MuscleDeformer>>& bones, std::size_t firstMoving,
         const Setting& setting = {})
        : skin_(surfaceOf(setting.body)) {
        if (setting.inverted)
            for (Tri& t : skin_.triangles) std::swap(t[1], t[2]);
        if (setting.split) skin_ = splitAt(skin_);
        for (Vec3& v : skin_.vertices) v.y() *= 1 + setting.splay * std::max(0.0, 20 - v.z());
        const Eigen::AlignedBox3d box = bounds(bones[firstMoving]->muscle().surface);
        const Vec3 joint = setting.joint.value_or(Vec3(32, 6, box.max().z() + 0.5));
        const auto turnedAbout = [&](const Vec3& at) {
            return Pose(Eigen::Translation3d(at) * Eigen::AngleAxisd(M_PI / 3, setting.axis) *
                        Eigen::Translation3d(-at));
        };
        bend = turnedAbout(joint);
        std::vector<Pose> poses(bones.size(), Pose::Identity());
        for (std::size_t m = firstMoving; m < bones.size(); ++m) poses[m] = bend;
        SkinParameters parameters;
        parameters.swings = {{poses}};
        if (setting.neck) {
            std::vector<Pose> nod(bones.size(), Pose::Identity());
            nod.back() = turnedAbout(*setting.neck);
            parameters.swings.push_back({nod});
        }
        SkinTable nothingMet;
        nothingMet.table.rowOffsets = {0};
        const auto rig = makeSkinRig(skin_, bones, nothingMet, parameters);
        SkinResponse response(rig);
        response.update(std::vector<double>(bones.size(), 0), poses);
        now_ = skin_.vertices;
        for (std::size_t k = 0; k < rig->vertices.size(); ++k)
            now_[rig->vertices[k]] = response.positions()[k];
    }

    /// How far vertices are from where the motion has them, at most.
    template <class Which>
    double farthest(const Pose& from, const Which& which) const {
        double most = 0;
        int count = 0;
        for (std::size_t v = 0; v < now_.size(); ++v)
            if (which(skin_.vertices[v])) {
                most = std::max(most, (now_[v] - from * skin_.vertices[v]).norm());
                ++count;
            }
        REQUIRE(count > 20);
        return most;
    }

    /// Where each place is now.
    std::map<std::array<double, 3>, Vec3> places() const {
        std::map<std::array<double, 3>, Vec3> result;
        for (std::size_t v = 0; v < now_.size(); ++v) {
            const Vec3& x = skin_.vertices[v];
            const Vec3& there = result.try_emplace({x[0], x[1], x[2]}, now_[v]).first->second;
            CHECK(there == now_[v]);
        }
        return result;
    }

    Pose bend;

private:
    TriangleMesh skin_;
    std::vector<Vec3> now_;
};

bool isTrunk(const Vec3& x) {
    return x.x() < 26 && x.z() >= 20;
}
bool isHind(const Vec3& x) {
    return x.x() < -5;
}
/// Before the left leg.
bool isBreast(const Vec3& x) {
    return x.x() > 35 && x.y() > 4 && x.z() < 24;
}
bool isRightLeg(const Vec3& x) {
    return x.y() <= -4 && x.z() < 20;
}
bool isLeftFoot(const Vec3& x) {
    return x.y() >= 4 && x.z() < 6;
}

} // namespace

TEST_CASE("skin over parts whose bones are not named stays with the bone beside it that holds still") {
    for (const bool inverted : {false, true}) {
        const Bent bent({boneOf(20.5, 27), boneOf(1, 19.5)}, 1, {inverted});
        CHECK(bent.farthest(Pose::Identity(), isTrunk) < 1);
        CHECK(bent.farthest(Pose::Identity(), isHind) < 0.05);
        CHECK(bent.farthest(Pose::Identity(), isRightLeg) < 0.2);
        CHECK(bent.farthest(bent.bend, isLeftFoot) < 0.05);
    }
}

TEST_CASE("a foot that is far beyond its thigh, and behind it, goes with it and not with the trunk") {
    Setting crouching;
    crouching.body.insert(crouching.body.end(), {{8, 4, 0, 34, 8, 4}, {8, -8, 0, 34, -4, 4}});
    const Bent bent({boneIn(Vec3(20, -5, 22), Vec3(38, 5, 28)), boneOf(14, 19.5)}, 1, crouching);
    const auto isFoot = [](const Vec3& x) { return x.y() >= 4 && x.z() <= 4; };
    CHECK(bent.farthest(bent.bend, isFoot) < 0.05);
    CHECK(bent.farthest(Pose::Identity(), isHind) < 0.05);
    CHECK(bent.farthest(Pose::Identity(), isRightLeg) < 0.05);
}

TEST_CASE("the trunk behind a head stays with its skull when the jaw opens") {
    Setting open;
    open.body.insert(open.body.end(),
                     {{40, -3, 25, 60, 3, 35}, {40, -3, 20, 60, 3, 24}, {40, -3, 24, 46, 3, 25}});
    open.joint = Vec3(46, 0, 25);
    for (const double back : {44, 46}) {
        const Bent bent(
            {boneIn(Vec3(42, -2, 27), Vec3(58, 2, 33)), boneIn(Vec3(back, -2, 20.5), Vec3(58, 2, 23))}, 1,
            open);
        CHECK(bent.farthest(Pose::Identity(), [](const Vec3& x) { return x.x() < 38; }) < 3);
        CHECK(bent.farthest(bent.bend, [](const Vec3& x) { return x.x() > 58 && x.z() < 24; }) < 0.05);
    }
}

TEST_CASE("a part beside two bones that move is no end of either: it stays") {
    const Bent bent({boneOf(28.5, 29.5), boneOf(20.8, 27), boneOf(1, 19.5)}, 1);
    CHECK(bent.farthest(Pose::Identity(), isHind) < 0.05);
    CHECK(bent.farthest(Pose::Identity(), isRightLeg) < 0.2);
    CHECK(bent.farthest(Pose::Identity(), isBreast) < 8.5);
    CHECK(bent.farthest(bent.bend, isLeftFoot) < 0.05);
}

TEST_CASE("a leg whose bones are not named is the trunk's, though the bone of the other leg is nearer") {
    Setting splayed;
    splayed.splay = 0.005;
    const auto left = boneIn(Vec3(31, 5, 0.5), Vec3(33, 7, 20));
    const Bent bent({boneIn(Vec3(10, -4.5, 23), Vec3(32.5, 4.5, 25)), left}, 1, splayed);
    CHECK(bent.farthest(Pose::Identity(), isRightLeg) < 0.01);
    CHECK(bent.farthest(Pose::Identity(), isHind) < 0.01);
    CHECK(bent.farthest(bent.bend, isLeftFoot) < 0.01);
}

TEST_CASE("a face over a hollow goes with its head, though the bone that holds still is the one below") {
    // A skull with a cavity behind a wall that has a mouth: all ways from the wall to the bone cross the
    // cavity.
    Setting man;
    man.body = {{-6, -4, 0, 6, 4, 20},  {-3, -3, 20, 1, 3, 36}, {1, -3, 20, 6, -2, 36}, {1, 2, 20, 6, 3, 36},
                {1, -3, 34, 6, 3, 36},  {1, -3, 20, 6, 3, 22},  {5, -3, 22, 6, 3, 27},  {5, -3, 28, 6, 3, 34},
                {5, -3, 27, 6, -1, 28}, {5, 1, 27, 6, 3, 28}};
    man.joint = Vec3(0, 0, 28);
    const Bent bent(
        {boneIn(Vec3(-2, -2, 2), Vec3(2, 2, 6)), boneIn(Vec3(-1.5, -0.9, 28), Vec3(-0.5, 0.9, 34))}, 1, man);
    CHECK(bent.farthest(bent.bend, [](const Vec3& x) { return x.x() > 4 && x.z() > 24; }) < 2.5);
    CHECK(bent.farthest(Pose::Identity(), [](const Vec3& x) { return x.z() < 2; }) < 0.05);
}

TEST_CASE("a hook on a chest goes with it, though the ways from its end to the bone leave it") {
    Setting man;
    man.body = {{-6, -6, 0, 6, 6, 40}, {6, -1, 20, 12, 1, 22}, {11, -1, 12, 12, 1, 20}};
    man.joint = Vec3(0, 0, 16);
    const Bent bent({boneIn(Vec3(-2, -2, 2), Vec3(2, 2, 6)), boneIn(Vec3(-2, -2, 12), Vec3(2, 2, 36))}, 1,
                    man);
    CHECK(bent.farthest(bent.bend, [](const Vec3& x) { return x.x() > 10 && x.z() < 18; }) < 1);
    CHECK(bent.farthest(Pose::Identity(), [](const Vec3& x) { return x.z() < 2; }) < 0.5);
}

TEST_CASE("a hook on the axis of a neck goes with the body, not with a bone that holds still elsewhere") {
    Setting hooked;
    hooked.body = {{0, -2, -2, 110, 2, 2}, {41, 2, -1, 43, 12, 1}, {41, 10, 1, 43, 12, 12}};
    hooked.joint = Vec3(0, 0, 0);
    hooked.neck = Vec3(42, 0, 0);
    const Bent bent({boneIn(Vec3(0, -1, -42), Vec3(2, 1, -40)), boneIn(Vec3(5, -1, -1), Vec3(34, 1, 1)),
                     boneIn(Vec3(42.2, -1, -1), Vec3(109, 1, 1))},
                    1, hooked);
    CHECK(bent.farthest(bent.bend, [](const Vec3& x) { return x.z() > 5; }) < 0.05);
}

TEST_CASE("where no bone holds still the trunk stays, and the smaller end of a limb goes along") {
    const Bent bent({boneOf(10, 19.5)}, 0);
    CHECK(bent.farthest(Pose::Identity(), isTrunk) < 1);
    CHECK(bent.farthest(Pose::Identity(), isRightLeg) < 0.2);
    CHECK(bent.farthest(bent.bend, isLeftFoot) < 0.5);
}

TEST_CASE("a part beside a moving bone that lies aside of where the bone goes stays") {
    const Bent bent({boneIn(Vec3(-9, -1, 24), Vec3(-6, 1, 26)), boneOf(1, 27)}, 1);
    CHECK(bent.farthest(Pose::Identity(), isHind) < 0.05);
    CHECK(bent.farthest(Pose::Identity(), isRightLeg) < 0.2);
    CHECK(bent.farthest(bent.bend, isLeftFoot) < 0.05);
}

TEST_CASE("skin on a short bone in a thick part of the body is its own") {
    const Bent bent({boneOf(1, 19.5), boneIn(Vec3(10, -0.2, 24.8), Vec3(11, 0.2, 25.2)),
                     boneIn(Vec3(-8, -0.2, 24.8), Vec3(-7, 0.2, 25.2))},
                    2);
    CHECK(bent.farthest(bent.bend, [](const Vec3& x) { return x.x() < -8; }) < 6);
    CHECK(bent.farthest(Pose::Identity(), isRightLeg) < 0.2);
}

TEST_CASE("vertices that seams repeat stay together, and the skin is as without seams") {
    const std::vector<std::shared_ptr<const MuscleDeformer>> bones = {boneOf(20.5, 27), boneOf(1, 19.5)};
    const auto whole = Bent(bones, 1).places(), split = Bent(bones, 1, {false, true}).places();
    REQUIRE(whole.size() == split.size());
    for (const auto& [rest, now] : whole) CHECK((split.at(rest) - now).norm() < 0.01);
}

TEST_CASE("lips that touch vertex on vertex at rest are two, rims at one place are one") {
    TriangleMesh lips = surfaceOf({{0, 0, 0, 4, 4, 2}});
    test::append(lips, surfaceOf({{0, 0, 2, 4, 4, 4}}));
    const SkinAnatomy apart(lips, {}, {}), seamed(splitAt(lips), {}, {});
    for (std::uint32_t v = 0; v < apart.first.size(); ++v) CHECK(apart.first[v] == v);
    CHECK(std::set(seamed.first.begin(), seamed.first.end()).size() < lips.vertices.size());
    // Where floats have rounded them apart as well.
    TriangleMesh rounded = splitAt(lips);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> off(-2e-7, 2e-7);
    for (Vec3& v : rounded.vertices) v += Vec3{off(random), off(random), off(random)};
    CHECK(SkinAnatomy(rounded, {}, {}).first == seamed.first);
}

TEST_CASE("rims at one place that the scene's weights, tethers or attachments tell apart are two") {
    const TriangleMesh lips = splitAt(surfaceOf({{0, 0, 0, 4, 4, 2}}));
    const std::size_t count = lips.vertices.size();
    const std::vector<std::uint32_t> seamed = SkinAnatomy(lips, {}, {}).first;
    std::uint32_t twin = 0;
    while (twin < count && seamed[twin] == twin) ++twin;
    REQUIRE(twin < count);
    std::vector<double> list(count, 0.5);
    list[twin] = 0.4;
    SkinParameters tethered, attached, weighted;
    tethered.tether = attached.attach = list;
    weighted.shares = {list};
    for (const SkinParameters& p : {tethered, attached, weighted}) {
        const std::vector<std::uint32_t> first = SkinAnatomy(lips, {}, p).first;
        for (std::uint32_t v = 0; v < count; ++v) CHECK(first[v] == (v == twin ? v : seamed[v]));
    }
}

TEST_CASE(
    "beyond a bone that turns about its middle is what it has on the far side of one that holds still") {
    const auto still = boneIn(Vec3(6, -1, 24), Vec3(8, 1, 26)),
               turning = boneIn(Vec3(9, -1, 24), Vec3(11, 1, 26));
    for (const bool back : {false, true}) {
        Setting aboutMiddle;
        aboutMiddle.joint = bounds((back ? still : turning)->muscle().surface).center();
        const Bent bent(back ? std::vector{turning, still} : std::vector{still, turning}, 1, aboutMiddle);
        CHECK(bent.farthest(Pose::Identity(), [&](const Vec3& x) { return back ? x.x() > 30 : x.x() < -5; }) <
              0.05);
        CHECK(bent.farthest(bent.bend, [&](const Vec3& x) { return back ? x.x() < -5 : x.x() > 30; }) < 3);
    }
}

TEST_CASE("a trunk that goes on on both sides of two vertebrae near its back is parted between them") {
    for (const double end : {28.0, 29.4}) { // deep and just below the back
        const auto still = boneIn(Vec3(9.2, -0.6, end - 1.2), Vec3(10.4, 0.6, end)),
                   turning = boneIn(Vec3(7.8, -0.6, end - 1.2), Vec3(9, 0.6, end));
        Setting between;
        between.joint = Vec3(8.6, 0, end - 0.6);
        const Bent bent({still, turning}, 1, between);
        CHECK(bent.farthest(Pose::Identity(), [](const Vec3& x) { return x.x() > 26; }) < 0.5);
        CHECK(bent.farthest(bent.bend, [](const Vec3& x) { return x.x() < -5; }) < 0.5);
    }
}

TEST_CASE("of a trunk on both sides of a row of vertebrae what is clearly beyond the last goes with it") {
    // The first holds still, the second turns, the third turns about its own joint as well.
    const auto vertebra = [](double x) { return boneIn(Vec3(x, -0.6, 28.2), Vec3(x + 1.2, 0.6, 29.4)); };
    const std::vector bones{vertebra(9.2), vertebra(7.8), vertebra(6.4)};
    const auto turn = [](double x) {
        const Vec3 joint(x, 0, 28.8);
        return Pose(Eigen::Translation3d(joint) * Eigen::AngleAxisd(M_PI / 9, Vec3::UnitY()) *
                    Eigen::Translation3d(-joint));
    };
    const Pose one = turn(8.6), other = turn(7.2), stay = Pose::Identity();
    SkinParameters parameters;
    parameters.swings = {{{stay, one, one}}, {{stay, stay, other}}};
    SkinTable nothingMet;
    nothingMet.table.rowOffsets = {0};
    SkinResponse response(makeSkinRig(surfaceOf(animal), bones, nothingMet, parameters));
    response.update(std::vector<double>(3, 0), std::vector<Pose>{stay, one, one * other});
    double front = 0, back = 0;
    for (std::size_t k = 0; k < response.positions().size(); ++k) {
        const Vec3 &rest = response.rig().rest[k], &now = response.positions()[k];
        if (rest.x() > 26) front = std::max(front, (now - rest).norm());
        if (rest.x() < -5) back = std::max(back, (now - one * other * rest).norm());
    }
    CHECK(front < 0.5);
    CHECK(back < 0.5);
}

TEST_CASE(
    "beyond a bone that twists is what it has on the far side of what it hangs on, also beside a limb that "
    "moves") {
    // A head on a short bone, somewhat beside the axis about which it turns, and an arm.
    Setting man;
    man.body = {{-6, -4, 0, 6, 4, 20}, {6, -2, 14, 20, 2, 18}, {-3, -3, 20, 3, 3, 36}};
    man.joint = Vec3::Zero();
    man.axis = Vec3::UnitZ();
    const auto pelvis = boneIn(Vec3(-2, -2, 2), Vec3(2, 2, 6)),
               arm = boneIn(Vec3(4, -0.5, 17), Vec3(13, 0.5, 18));
    for (const double aside : {-0.5, 0.5})
        for (const bool both : {false, true}) {
            std::vector bones{pelvis, boneIn(Vec3(aside - 0.3, -0.3, 21), Vec3(aside + 0.3, 0.3, 22))};
            if (both) bones.push_back(arm);
            const Bent bent(bones, 1, man);
            CHECK(bent.farthest(bent.bend, [](const Vec3& x) { return x.z() > 30; }) < 0.3);
            CHECK(bent.farthest(Pose::Identity(), [](const Vec3& x) { return x.z() < 2; }) < 0.05);
        }
}
