// Parts of a skin that meet only where several joints move at once.
#include "bake/bind/SkinParameters.h"
#include "bake/model/AddPair.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/ClosestPointQuery.h"
#include "bake/pipeline/Bake.h"
#include "bake/play/SkinSetup.h"
#include "bake/respond/SkinResponse.h"
#include "bake/respond/SkinRig.h"
#include "tests/Joints.h"
#include "tests/LevelSet.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

using namespace tss;
using namespace tss::test;

namespace {
namespace grasp {

constexpr double degree = M_PI / 180;
const Vec3 wrist(0, 0, 0), knuckle(2, 0, 0), middle(2.9, 0, 0), tip(3.8, 0, 0);

/// A palm and a finger of two phalanges under one skin. Neither joint by itself brings the finger's end to
/// the palm.
SceneModel handScene() {
    SceneModel scene;
    const auto add = [&](const std::string& name, const std::function<double(const Vec3&)>& f, double step) {
        Body body;
        body.path = "/Hand/" + name;
        body.mesh = levelSet(f, Vec3(-0.7, -0.7, -0.7), Vec3(4.3, 0.7, 0.7), step);
        scene.bodies.push_back(std::move(body));
    };
    const auto bone = [&](const std::string& name, const Vec3& from, const Vec3& to, double radius) {
        const Vec3 inset = 0.15 * (to - from).normalized();
        add(
            name, [=](const Vec3& x) { return fromSegment(x, from + inset, to - inset) - radius; }, 0.05);
    };
    bone("Palm", wrist, knuckle, 0.25);
    bone("Proximal", knuckle, middle, 0.1);
    bone("Distal", middle, tip, 0.1);
    add(
        "Skin",
        [](const Vec3& x) {
            return std::min(fromSegment(x, wrist, knuckle) - 0.4, fromSegment(x, knuckle, tip) - 0.2);
        },
        0.07);
    const auto hinge = [&](int from, int to, const Vec3& at, double most, const std::string& name) {
        Motion motion;
        motion.dofs = {joints::turn(at, -Vec3::UnitY(), 0, most * degree)};
        addJoints(scene, from, to, motion, name);
    };
    hinge(0, 1, knuckle, 100, "Knuckle");
    hinge(1, 2, middle, 110, "Middle");
    SkinModel skin;
    skin.path = "/Hand/Skin";
    skin.body = 3;
    skin.bones = {0, 1, 2};
    skin.selfContact = true;
    scene.skins = {skin};
    return scene;
}

/// How deep the skin of the finger's end is in that of the palm, at most.
double depthInPalm(const TriangleMesh& rest, const std::vector<Vec3>& now) {
    TriangleMesh palm;
    palm.vertices = now;
    for (const Tri& t : rest.triangles)
        if (rest.vertices[t[0]].x() < 1.9) palm.triangles.push_back(t);
    const ClosestPointQuery query(palm);
    double deepest = 0;
    for (std::size_t v = 0; v < now.size(); ++v) {
        if (rest.vertices[v].x() < 3.3) continue;
        const NearestPoint near = query.nearest(now[v], 1);
        if (near.triangle < 0) continue;
        const Vec3 normal = palm.areaNormal(static_cast<std::size_t>(near.triangle)).normalized();
        deepest = std::max(deepest, -normal.dot(now[v] - near.point));
    }
    return deepest;
}

} // namespace grasp
} // namespace

TEST_CASE("a finger that two joints bring to the palm meets it") {
    SceneModel scene = grasp::handScene();
    bake(scene);
    const TriangleMesh& mesh = scene.bodies[3].mesh;
    const SkinTable& table = *scene.skins[0].table;
    std::set<std::uint32_t> meetsPalm;
    for (std::size_t i = 0; i < table.table.a.size(); ++i)
        for (std::uint32_t k = table.table.rowOffsets[i]; k < table.table.rowOffsets[i + 1]; ++k)
            if (table.muscleOf[table.table.columns[k]] == 0) meetsPalm.insert(table.skinVertices[i]);
    CHECK(std::any_of(meetsPalm.begin(), meetsPalm.end(),
                      [&](std::uint32_t v) { return mesh.vertices[v].x() > 3.5; }));
    SkinResponse response(skinRig(scene, scene.skins[0]));
    scene.skins[0].table.reset();
    scene.skins[0].selfContact = false;
    SkinResponse carried(skinRig(scene, scene.skins[0]));
    double without = 0;
    for (const auto& [knuckle, middle] : {std::pair(100, 110), {100, 106}, {96, 110}, {98, 108}}) {
        const std::vector<double> q{knuckle * grasp::degree, middle * grasp::degree};
        const std::vector<Pose> poses = skinPoses(scene, scene.skins[0], posedBodies(scene, q));
        const auto depth = [&](SkinResponse& skin) {
            skin.update(std::vector<double>(3, 0), poses);
            std::vector<Vec3> now = mesh.vertices;
            for (std::size_t k = 0; k < skin.vertices().size(); ++k)
                now[skin.vertices()[k]] = skin.positions()[k];
            return grasp::depthInPalm(mesh, now);
        };
        const double alone = depth(carried), met = depth(response);
        INFO("knuckle " << knuckle << ", middle joint " << middle << ": deep by " << alone << " as carried, "
                        << met);
        CHECK(met <= std::max(0.02, 0.1 * alone));
        without = std::max(without, alone);
    }
    CHECK(without > 0.1);
}

TEST_CASE("of any three joint values that move a skin's bones all combinations of their ends are looked at") {
    for (const int count : {2, 3, 4, 5, 9}) {
        SceneModel scene;
        for (int b = 0; b <= count + 1; ++b) {
            scene.bodies.emplace_back();
            scene.bodies.back().path = "/Chain/B" + std::to_string(b);
            scene.bodies.back().mesh.vertices = {Vec3(b, 0, 0), Vec3(b + 0.5, 0, 0), Vec3(b, 0.1, 0.1)};
            scene.bodies.back().mesh.triangles = {Tri(0, 1, 2)};
        }
        SkinModel skin;
        skin.body = count + 1;
        for (int b = 0; b <= count; ++b) skin.bones.push_back(b);
        for (int j = 0; j < count; ++j) {
            Motion motion;
            motion.dofs = {joints::turn(Vec3(j + 1, 0, 0), Vec3::UnitZ(), -0.1, 0.2)};
            addJoints(scene, j, j + 1, motion, "J" + std::to_string(j));
        }
        scene.skins = {skin};
        const SkinParameters parameters = skinParameters(scene, skin);
        CHECK(parameters.swings.size() == 2u * count);
        // The end of a swing tells each joint's value: the turn of one bone against the one before.
        std::vector<std::vector<bool>> upper;
        for (const BoneSwing& swing : parameters.together) {
            upper.emplace_back();
            for (int j = 0; j < count; ++j) {
                const Pose turn = swing.back()[j].inverse() * swing.back()[j + 1];
                upper.back().push_back(turn(1, 0) > 0);
            }
        }
        for (int a = 0; a < count; ++a)
            for (int b = 0; b < a; ++b)
                for (int c = 0; c <= b; ++c) {
                    std::set<std::array<bool, 3>> seen;
                    for (const std::vector<bool>& row : upper) seen.insert({row[a], row[b], row[c]});
                    CHECK(seen.size() == (c == b ? 4 : 8));
                }
    }
}
