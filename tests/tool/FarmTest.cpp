#include "bake/model/AddPair.h"
#include "bake/scene/SceneFile.h"
#include "tests/Shapes.h"
#include "tests/geometry/TestMeshes.h"
#include "tests/tool/Shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace tss;
using Json = nlohmann::json;

namespace {

int addBody(SceneModel& scene, const std::string& name, const TriangleMesh& mesh) {
    Body body;
    body.path = "/" + scene.defaultPrim + "/" + name;
    body.mesh = mesh;
    for (Vec3& v : body.mesh.vertices) v = v.cast<float>().cast<double>();
    scene.bodies.push_back(body);
    return static_cast<int>(scene.bodies.size()) - 1;
}

Motion hinge(const Vec3& origin, double lower, double upper) {
    Motion motion;
    Dof dof;
    dof.name = "turn";
    dof.origin = origin;
    dof.axis = Vec3::UnitZ();
    dof.lower = lower;
    dof.upper = upper;
    motion.dofs = {dof};
    return motion;
}

/// A ball with flaps about it, a hinge each, that close onto it; every fifth one stays away.
SceneModel flower(int petals) {
    SceneModel scene;
    scene.defaultPrim = "Flower";
    addBody(scene, "Ball", ballMesh({0, 0, 0}, 1, 2));
    for (int k = 0; k < petals; ++k) {
        const double turn = 2 * M_PI * k / petals, far = 1.5 + 0.1 * (k % 3);
        const Vec3 out(std::cos(turn), std::sin(turn), 0.02 * k), across(-std::sin(turn), std::cos(turn), 0);
        TriangleMesh petal = boxMesh({-0.1, 0.2, -0.1}, {0.1, 1.4, 0.1});
        for (Vec3& v : petal.vertices) v = far * out + v.x() * out + v.y() * across + Vec3(0, 0, v.z());
        const int body = addBody(scene, "Petal" + std::to_string(k), petal);
        addPair(scene, 0, body, hinge(far * out, k % 5 ? -0.2 : -0.3, k % 5 ? 1.2 : 0.1),
                "Hinge" + std::to_string(k));
    }
    return scene;
}

constexpr const char* settings = " --tolerance 0.05 --at-rest collide --quiet";

/// The paths that tss info --paths prints.
std::vector<std::string> paths(const std::string& scene, const Folder& folder) {
    std::istringstream lines(runTss("info " + scene + " --paths", folder.path()).out);
    std::vector<std::string> found;
    for (std::string line; std::getline(lines, line);) found.push_back(line);
    return found;
}

} // namespace

TEST_CASE("a scene of 50 pairs baked one by one and merged has the bytes of the plain bake") {
    const Folder folder;
    saveScene(flower(50), folder / "flower.tss");
    REQUIRE(runTss("bake flower.tss -o whole.tss" + std::string(settings), folder.path()).exit == 0);
    const auto pairs = paths("flower.tss", folder);
    REQUIRE(pairs.size() == 50);
    std::string parts;
    for (std::size_t k = pairs.size(); k-- > 0;) { // the order does not matter
        const std::string part = "part" + std::to_string(k) + ".tss";
        REQUIRE(
            runTss("bake flower.tss -o " + part + " --threads 1 --pair " + pairs[k] + settings, folder.path())
                .exit == 0);
        parts += " " + part;
    }
    REQUIRE(runTss("merge" + parts + " -o merged.tss", folder.path()).exit == 0);
    CHECK(readText(folder.path() / "merged.tss") == readText(folder.path() / "whole.tss"));
    const Json info = Json::parse(runTss("info merged.tss --json", folder.path()).out);
    int never = 0, tables = 0;
    for (const Json& pair : info["pairs"]) (pair["neverCollides"] == true ? never : tables) += 1;
    CHECK(never >= 10);
    CHECK(tables >= 20);
    CHECK(runTss("verify merged.tss --quiet", folder.path()).exit == 0);
}

TEST_CASE("the example script bakes the pairs with GNU parallel and gives the bytes of the plain bake") {
    if (std::system("command -v parallel >/dev/null") != 0) {
        WARN("skipped, no GNU parallel");
        return;
    }
    const Folder folder;
    saveScene(flower(12), folder / "flower.tss");
    REQUIRE(runTss("bake flower.tss -o whole.tss" + std::string(settings), folder.path()).exit == 0);
    const std::string command = "cd '" + folder.path().string() + "' && TSS='" TSS_PROGRAM "' bash '" +
                                OSGTSS_SOURCE_DIR "/examples/farm/parallel.sh' flower.tss merged.tss" +
                                settings + " >/dev/null 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
    CHECK(readText(folder.path() / "merged.tss") == readText(folder.path() / "whole.tss"));
    CHECK(fileCount(folder.path()) == 3); // no parts are left behind
}

TEST_CASE("the bake of all pairs sorts neighbours, chains and what never collides") {
    const Folder folder;
    SceneModel scene;
    scene.defaultPrim = "Arm";
    // A chain of four links; the joints' balls overlap at rest; the ends can fold onto each other.
    for (int k = 0; k < 4; ++k) {
        TriangleMesh link = boxMesh({k - 0.05, -0.1, -0.1}, {k + 1.05, 0.1, 0.1});
        addBody(scene, "Link" + std::to_string(k), link);
    }
    for (int k = 0; k < 3; ++k)
        addPair(scene, k, k + 1, hinge(Vec3(k + 1, 0, 0), 0, k == 1 ? 0.3 : 2.8),
                "Joint" + std::to_string(k));
    scene.pairs.clear();
    saveScene(scene, folder / "arm.tss");

    REQUIRE(runTss("bake arm.tss -o pairs.tss --all-pairs --pairs-only", folder.path()).exit == 0);
    CHECK(paths("pairs.tss", folder).size() == 6);
    CHECK(paths("arm.tss", folder).empty());
    CHECK(runTss("bake arm.tss -o no.tss --pairs-only", folder.path()).exit == 2);

    const Ran ran = runTss("bake arm.tss -o baked.tss --all-pairs --tolerance 0.05 --json", folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    const Json baked = Json::parse(ran.out);
    CHECK(baked["allPairs"]["added"].size() == 6);
    int never = 0, atRest = 0, others = 0;
    for (const Json& pair : baked["pairs"]) {
        CHECK(pair["certified"] == true);
        if (pair["neverCollides"] == true)
            ++never;
        else
            ++(pair["restRegion"].is_null() ? others : atRest);
        if (pair["path"] == "/Arm/Link0_Link3") CHECK(pair["dofs"] == 3);
    }
    CHECK(atRest == 3);         // the neighbours
    CHECK(never + others == 3); // over two and three joints
    CHECK(ran.err.find("never collide") != std::string::npos);
    REQUIRE(runTss("bake pairs.tss -o same.tss --tolerance 0.05 --quiet", folder.path()).exit == 0);
    CHECK(readText(folder.path() / "same.tss") == readText(folder.path() / "baked.tss"));
    CHECK(runTss("verify baked.tss --quiet", folder.path()).exit == 0);
}

TEST_CASE("a pair too coarse for its joint's clearance is baked again finer where that is asked for") {
    SceneModel scene;
    scene.defaultPrim = "Slides";
    // Blocks that slide above a floor against a wall, one close to it.
    TriangleMesh floor = boxMesh({0, 0, 0}, {3, 3, 1});
    const TriangleMesh wall = boxMesh({2.8, 0, 1}, {3, 3, 2});
    for (const Tri& t : wall.triangles)
        floor.triangles.emplace_back(t.array() + static_cast<int>(floor.vertices.size()));
    floor.vertices.insert(floor.vertices.end(), wall.vertices.begin(), wall.vertices.end());
    floor = test::quartered(floor, 2); // of a large triangle it is known at once how far it stays away
    const int still = addBody(scene, "Floor", floor);
    Motion slide = hinge({0, 0, 0}, -3, 2.5);
    slide.dofs[0].kind = DofKind::Translation;
    slide.dofs[0].axis = Vec3::UnitX();
    addPair(scene, still, addBody(scene, "Near", boxMesh({0, 0.2, 1.06}, {0.5, 0.8, 1.5})), slide, "One");
    addPair(scene, still, addBody(scene, "Far", boxMesh({0, 1.2, 1.5}, {0.5, 1.8, 1.9})), slide, "Two");
    const Folder folder;
    saveScene(scene, folder / "slides.tss");
    const auto baked = [&](const std::string& more) {
        const Ran ran =
            runTss("bake slides.tss -o baked.tss --json --tolerance 0.1 --again" + more, folder.path());
        INFO(ran.err);
        REQUIRE(ran.exit == 0);
        return Json::parse(ran.out)["pairs"];
    };
    const Json plain = baked(""), finer = baked(" --finer"), other = baked(" --finer --pair /Slides/Two");
    REQUIRE(plain[0]["earlyContact"]["coarse"] == true);
    REQUIRE(plain[1]["earlyContact"]["coarse"] == false);
    CHECK(finer[0]["earlyContact"]["coarse"] == false);
    CHECK(finer[0]["boundEarly"] < plain[0]["boundEarly"]);
    CHECK(finer[1]["boundEarly"] == plain[1]["boundEarly"]);
    CHECK(finer[1]["tests"] == plain[1]["tests"]);
    CHECK(other[0]["baked"] == false);
}
