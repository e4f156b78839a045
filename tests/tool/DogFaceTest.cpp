#include "bake/geometry/Import.h"
#include "bake/scene/SceneFile.h"
#include "tests/SharedMeshes.h"
#include "tests/tool/Shell.h"

#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

using Json = nlohmann::json;

namespace {

/// The frontal mask under the skin of the real dog's head, metres: contracts and relaxes in two seconds.
tss::SceneModel dogFace() {
    tss::SceneModel scene;
    scene.defaultPrim = "DogFace";
    scene.endTimeCode = 48;
    const auto add = [&](const char* name, const char* file, const tss::Vec3& color) {
        tss::Body body;
        body.path = std::string("/DogFace/") + name;
        body.mesh = tss::importMesh(sharedMesh(file));
        body.displayColor = color;
        scene.bodies.push_back(body);
    };
    add("Skin", "dog_face/skin_head.obj", {0.55, 0.40, 0.27});
    add("FrontalMask", "dog_face/orbicularis_oculi_frontal.obj", {0.55, 0.12, 0.10});

    tss::MuscleModel mask;
    mask.path = "/DogFace/Frontalis";
    mask.body = 1;
    mask.muscle.surface = scene.bodies[1].mesh;
    mask.muscle.form = tss::MuscleForm::Sheet;
    mask.muscle.fibre = {{0.300, 0, 0.743}, {0.330, 0, 0.740}, {0.360, 0, 0.733},
                         {0.375, 0, 0.724}, {0.390, 0, 0.705}, {0.420, 0, 0.689}};
    mask.muscle.maxContraction = 0.06;
    mask.activation = {{0, 24, 48}, {0, 1, 0}};
    scene.muscles.push_back(mask);

    tss::SkinModel skin;
    skin.path = "/DogFace/Skin";
    skin.body = 0;
    skin.muscles = {0};
    scene.skins.push_back(skin);
    return scene;
}

} // namespace

TEST_CASE("the skin of the real dog's head follows the frontal mask, and comes back to rest") {
    REQUIRE_SHARED_MESHES();
    const Folder folder;
    tss::saveScene(dogFace(), folder / "face.tss");
    const Ran baked = runTss("bake face.tss -o baked.tss --json", folder.path());
    INFO(baked.err);
    REQUIRE(baked.exit == 0);
    const Json skin = Json::parse(baked.out)["skins"][0];
    CHECK(skin["tests"].get<int>() > 0);
    CHECK(skin["usedA"].get<int>() < skin["spheresA"].get<int>());

    const Ran played =
        runTss("play baked.tss -o played.csv --mesh-out f_%02d.obj --timings --json", folder.path());
    REQUIRE(played.exit == 0);
    const Json costs = Json::parse(played.out)["skins"][0]["costs"];
    CHECK(costs["updates"] == 47); // at rest nothing is done
    CHECK(costs["lookUps"] > 47);
    for (const char* part : {"carry", "sort", "muscles", "pushes", "show"}) CHECK(costs[part] > 0);
    for (const char* part : {"bones", "folds"}) CHECK(costs[part] == 0);
    std::istringstream rows(readText(folder.path() / "played.csv"));
    std::string line;
    std::getline(rows, line);
    CHECK(line == "step,table_gap,status,residual_Skin");
    double worst = 0;
    int steps = 0;
    for (; std::getline(rows, line); ++steps)
        worst = std::max(worst, std::stod(line.substr(line.rfind(',') + 1)));
    CHECK(steps == 49);

    const std::string rest = readText(folder.path() / "f_00.obj");
    CHECK(rest == readText(folder.path() / "f_48.obj"));
    CHECK(rest != readText(folder.path() / "f_24.obj"));
    const auto rested = tss::importMesh(folder / "f_00.obj"), pushed = tss::importMesh(folder / "f_24.obj");
    REQUIRE(rested.vertices.size() == pushed.vertices.size());
    double farthest = 0;
    for (std::size_t k = 0; k < rested.vertices.size(); ++k)
        farthest = std::max(farthest, (rested.vertices[k] - pushed.vertices[k]).norm());
    std::cout << "dog face: " << skin["spheresA"] << " + " << skin["spheresB"] << " spheres -> "
              << skin["usedA"] << " + " << skin["usedB"] << ", " << skin["tests"]
              << " tests; skin or muscle moves " << 1000 * farthest << " mm, skin at most " << 1000 * worst
              << " mm deeper in the muscle than at rest\n";
    CHECK(farthest > 1e-3);
    CHECK(worst < 1e-3);
}
