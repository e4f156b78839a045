#include "bake/base/Error.h"
#include "bake/check/VerifyPair.h"
#include "bake/geometry/PartSet.h"
#include "bake/pipeline/Bake.h"
#include "bake/pipeline/BakePair.h"
#include "bake/pipeline/FillPair.h"
#include "bake/search/NodePairs.h"
#include "bake/spheres/Patches.h"
#include "bake/table/Query.h"
#include "tests/GroundTruth.h"
#include "tests/pipeline/LumpyPair.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

SceneModel sceneOf(TriangleMesh a, TriangleMesh b, const Motion& motion) {
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "Scene";
    for (TriangleMesh* mesh : {&a, &b}) {
        Body body;
        body.path = scene.bodies.empty() ? "/Scene/A" : "/Scene/B";
        body.mesh = std::move(*mesh);
        scene.bodies.push_back(body);
    }
    addPair(scene, 0, 1, motion, "Joint");
    return scene;
}

/// Two lumpy balls `clearance` apart at rest (< 0: as much nearer than where they touch), B turning about its
/// own middle: what it turns towards A was away from it.
SceneModel bumpyPair(std::uint64_t seed, double clearance) {
    std::mt19937_64 random(seed);
    const TriangleMesh a = lumpyMesh(random, 3, 0.3), b = lumpyMesh(random, 3, 0.3);
    double near = 0, far = 4;
    for (int k = 0; k < 60; ++k) {
        const double middle = (near + far) / 2;
        Pose pose = Pose::Identity();
        pose.translation().x() = middle;
        (MeshQuery(a).distanceTo(MeshQuery(b), pose) > std::max(clearance, 1e-9) ? far : near) = middle;
    }
    const Vec3 centre(far + std::min(clearance, 0.0), 0, 0);
    Motion motion;
    motion.dofs = {joints::turn(centre, Vec3(0.3, 0, 1), -1.5, 1.5)};
    if (seed % 2) motion.dofs.push_back(joints::turn(centre, {0, 1, 0.2}, -0.6, 0.9));
    return sceneOf(a, transformed(b, Eigen::Affine3d(Eigen::Translation3d(centre))), motion);
}

Pair& bakedPair(SceneModel& scene, const BakeSettings& settings) {
    bake(scene, {settings, {}});
    return scene.pairs[0];
}

/// The mesh without some parts of it.
TriangleMesh without(const TriangleMesh& mesh, const std::vector<SurfacePart>& parts) {
    PartSet out;
    for (const SurfacePart& part : parts) out.insert(part);
    std::vector<SurfacePart> left;
    const auto add = [&](const auto& self, SurfacePart part) -> void {
        if (out.contains(part)) return;
        if (!out.reaches(part)) return left.push_back(part);
        for (const SurfacePart& half : halves(part)) self(self, half);
    };
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) add(add, {t, 1});
    return meshOf(mesh, left);
}

struct Judged {
    int contacts = 0, missed = 0, early = 0;
};

/// Asks FCL about all of the surfaces but for the region, at random poses and near where contact begins.
Judged judge(const SceneModel& scene, int count, std::uint64_t seed) {
    const Pair& pair = scene.pairs[0];
    const Table& table = *pair.table;
    const TriangleMesh &a = scene.bodies[0].mesh, &b = scene.bodies[1].mesh;
    const TriangleMesh restA = without(a, table.restRegion.a), restB = without(b, table.restRegion.b);
    const GroundTruth whole(a, b), first(restA.empty() ? a : restA, b), second(a, restB.empty() ? b : restB);
    const auto touches = [&](const Pose& at) {
        return (!restA.empty() && first.touches(at)) || (!restB.empty() && second.touches(at));
    };
    const Motion motion = pairMotion(scene, pair);
    auto poses = randomPoses(motion, static_cast<std::size_t>(count), seed);
    for (auto& q : nearContactPoses(touches, motion, static_cast<std::size_t>(count), 1e-3, seed + 1))
        poses.push_back(std::move(q));
    Judged judged;
    for (const auto& q : poses) {
        const Pose at = pose(motion, q);
        const bool hit = query(table, q).hit(), contact = touches(at);
        judged.contacts += contact;
        judged.missed += contact && !hit;
        judged.early += hit && whole.distance(at) > table.boundEarly.value() * (1 + 1e-9);
    }
    return judged;
}

bool freeAtRest(const SceneModel& scene) {
    return !query(*scene.pairs[0].table, restValues(pairMotion(scene, scene.pairs[0]))).hit();
}

} // namespace

TEST_CASE(
    "bodies a little apart at rest are free there, and no contact is missed however coarse the tolerance") {
    int contacts = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
        for (const char* atRest : {"offset", "ignore"}) {
            CAPTURE(seed, atRest);
            SceneModel scene = bumpyPair(seed, seed % 3 ? 0.004 : 0.0003);
            const Pair& pair = bakedPair(scene, {{"tolerance", "0.09"}, {"at-rest", atRest}});
            REQUIRE(pair.table);
            CHECK(pair.table->boundMiss == 0);
            CHECK(pair.table->restRegion.empty());
            CHECK(pair.table->restGaps.empty());
            CHECK(freeAtRest(scene));
            const Judged judged = judge(scene, 100, seed);
            CHECK(judged.missed == 0);
            CHECK(judged.early == 0);
            contacts += judged.contacts;
        }
    CHECK(contacts > 500);
}

TEST_CASE("bodies that overlap at rest are free there, and of all but the region no contact is missed") {
    int contacts = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
        for (const char* atRest : {"offset", "ignore"}) {
            CAPTURE(seed, atRest);
            SceneModel scene = bumpyPair(seed, -0.05);
            const Pair& pair = bakedPair(scene, {{"tolerance", "0.03"}, {"at-rest", atRest}});
            REQUIRE(pair.table);
            const RestRegion& region = pair.table->restRegion;
            CHECK(pair.table->boundMiss == 0);
            REQUIRE_FALSE(region.empty());
            CHECK((region.depth >= 0) == (atRest == std::string("offset")));
            CHECK(freeAtRest(scene));
            CHECK(area(scene.bodies[0].mesh, region.a) < 0.6 * area(scene.bodies[0].mesh));
            const Judged judged = judge(scene, 100, seed);
            CHECK(judged.missed == 0);
            CHECK(judged.early == 0);
            contacts += judged.contacts;
        }
    CHECK(contacts > 100);
}

TEST_CASE("a foot off the ground is not exempt with the one that stands in it, however coarse the spheres") {
    TriangleMesh stool = boxMesh({0, 0, -0.05}, {0.4, 1, 1});
    append(stool, boxMesh({1, 0, 0.12}, {1.4, 1, 1}));
    Motion motion;
    motion.dofs = {joints::slide({0, 0, 1}, -0.3, 0.3)};
    for (const char* tolerance : {"0.02", "0.1", "0.2"}) {
        CAPTURE(tolerance);
        SceneModel scene = sceneOf(boxMesh({-1, -1, -1}, {3, 2, 0}), stool, motion);
        const Pair& pair = bakedPair(scene, {{"tolerance", tolerance}, {"at-rest", "ignore"}});
        REQUIRE(pair.table);
        const RestRegion& region = pair.table->restRegion;
        CHECK(bounds(meshOf(scene.bodies[1].mesh, region.b)).max().x() < 0.5);
        CHECK(freeAtRest(scene));
        CHECK(query(*pair.table, std::vector{-0.13}).hit());
        const PairVerdict verdict = verifyPair(scene, pair);
        INFO(verdict.reason);
        CHECK(verdict.holds());
        const Judged judged = judge(scene, 100, 1);
        CHECK(judged.contacts > 10);
        CHECK(judged.missed == 0);
        CHECK(judged.early == 0);
    }
}

TEST_CASE("a bake says so where nearly all of a body is exempt, and only there") {
    Motion motion;
    motion.dofs = {joints::slide({1, 0, 0}, -0.01, 0.01)};
    for (const double deep : {0.1, 0.99}) { // of the smaller box in the larger
        SceneModel scene = sceneOf(boxMesh({-2, -2, -2}, {0, 2, 2}),
                                   boxMesh({-deep, -0.5, -0.5}, {1 - deep, 0.5, 0.5}), motion);
        const auto reports = bake(scene, {{{"tolerance", "0.02"}}, {}});
        const auto told = [&](const PairReport& report) {
            return std::any_of(report.notes.begin(), report.notes.end(), [](const std::string& note) {
                return note.find("/Scene/B") == 0 && note.find("is exempt") != std::string::npos;
            });
        };
        CHECK(std::any_of(reports.begin(), reports.end(), told) == (deep > 0.5));
    }
}

TEST_CASE("a table with a tolerance is free at rest, or refused where the clearance is less") {
    SceneModel scene = bumpyPair(2, 0.02);
    const Pair& pair = bakedPair(scene, {{"tolerance", "0.09"}, {"epsilon", "0.01"}});
    REQUIRE(pair.table);
    CHECK(pair.table->boundMiss == 0);
    CHECK(freeAtRest(scene));
    CHECK(judge(scene, 100, 1).missed == 0);
    CHECK_THROWS_WITH(bakedPair(scene, {{"tolerance", "0.09"}, {"epsilon", "0.03"}}),
                      Catch::Contains("apart at rest") && Catch::Contains("smaller epsilon"));
}

TEST_CASE("bodies that overlap wherever they are never 'never collide'") {
    Motion still;
    still.dofs = {joints::turn({0, 0, 0}, {0, 0, 1}, 0, 0)};
    for (const char* atRest : {"offset", "ignore", "collide"}) {
        CAPTURE(atRest);
        SceneModel scene =
            sceneOf(boxMesh({0, 0, 0}, {1, 1, 1}), boxMesh({0.9, 0.1, 0.1}, {2, 0.8, 0.8}), still);
        const Pair& pair = bakedPair(scene, {{"tolerance", "0.02"}, {"at-rest", atRest}});
        CHECK_FALSE(pair.proof);
        REQUIRE(pair.table);
        CHECK(pair.table->restRegion.empty() == (atRest == std::string("collide")));
        CHECK(freeAtRest(scene) == (atRest != std::string("collide")));
    }
}

TEST_CASE("a ball in a socket that is a little too small turns freely") {
    // Between two spheres, open to +z.
    const auto bowl = [](double inner, double outer, int rings, int around) {
        TriangleMesh mesh;
        const auto ring = [&](double radius, double angle) {
            for (int k = 0; k < around; ++k) {
                const double turn = 2 * M_PI * k / around;
                mesh.vertices.push_back(radius * Vec3(std::sin(angle) * std::cos(turn),
                                                      std::sin(angle) * std::sin(turn), -std::cos(angle)));
            }
        };
        std::vector<double> radii, angles;
        for (int k = 0; k < rings; ++k) radii.push_back(inner), angles.push_back(1.7 * (k + 1) / rings);
        for (int k = rings; k-- > 0;) radii.push_back(outer), angles.push_back(1.7 * (k + 1) / rings);
        for (std::size_t r = 0; r < radii.size(); ++r) ring(radii[r], angles[r]);
        const int inside = static_cast<int>(mesh.vertices.size()), outside = inside + 1;
        mesh.vertices.emplace_back(0, 0, -inner);
        mesh.vertices.emplace_back(0, 0, -outer);
        const int count = static_cast<int>(radii.size());
        for (int k = 0; k < around; ++k) {
            const int next = (k + 1) % around;
            mesh.triangles.emplace_back(inside, k, next);
            for (int r = 0; r + 1 < count; ++r) {
                const int x = r * around, y = x + around;
                mesh.triangles.emplace_back(x + k, y + k, x + next);
                mesh.triangles.emplace_back(x + next, y + k, y + next);
            }
            const int last = (count - 1) * around;
            mesh.triangles.emplace_back(last + k, outside, last + next);
        }
        return mesh;
    };
    Motion motion;
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
        motion.dofs.push_back(joints::turn({0, 0, 0}, axis, -0.6, 0.6));
    for (const char* atRest : {"offset", "ignore"}) {
        CAPTURE(atRest);
        SceneModel scene = sceneOf(bowl(0.98, 1.3, 10, 32), ballMesh(Vec3::Zero(), 1, 3), motion);
        const Pair& pair = bakedPair(scene, {{"tolerance", "0.02"}, {"at-rest", atRest}});
        REQUIRE(pair.table);
        REQUIRE_FALSE(pair.table->restRegion.empty());
        CHECK(freeAtRest(scene));
        int stopped = 0;
        for (const auto& q : randomPoses(motion, 300, 5)) stopped += query(*pair.table, q).hit();
        CHECK(stopped == 0);
    }
}

TEST_CASE("meshes that overlap over more surface than the usual tolerance can fill get a coarser one, not "
          "one asked for") {
    // A small block sunk into a long bar, along which it slides.
    Motion motion;
    motion.dofs = {joints::slide({1, 0, 0}, -0.4, 0.4)};
    const SceneModel scene = sceneOf(boxMesh({-1, -0.1, -0.2}, {1, 0.1, 0}),
                                     boxMesh({-0.2, -0.2, -0.05}, {0.2, 0.2, 0.3}), motion);
    BakeOptions options;
    const double usual = diagonal(scene.bodies[1].mesh) / 500;
    options.mostPatches = 60'000;
    const PairSpheres spheres = fillPair(scene, scene.pairs[0], motion, options);
    CHECK(spheres.protrusions > 2 * usual);
    CHECK(spheres.protrusions < 16 * usual);
    CHECK(spheres.a.note.find("instead of") != std::string::npos);
    options.tolerance = usual;
    CHECK_THROWS_AS(fillPair(scene, scene.pairs[0], motion, options), TooFine);
}
