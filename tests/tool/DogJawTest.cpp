#include "bake/scene/SceneFile.h"
#include "bake/table/Query.h"
#include "tests/GroundTruth.h"
#include "tests/SharedMeshes.h"
#include "tests/tool/Shell.h"

#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

using Json = nlohmann::json;

namespace {

/// The fitted joint of the real dog's jaw: yaw about Z outside, opening about Y inside.
std::string makeJaw() {
    return "make -o jaw.tss --a '" + sharedMesh("dog_jaw/skull.obj") + "' --b '" +
           sharedMesh("dog_jaw/mandible.obj") +
           "' --meters-per-unit 1 --dof rot:0.30549,0,0.68499:0,0,1:-4:4 --dof "
           "rot:0.30549,0,0.68499:0,1,0:-24:18 "
           "--b-offset=-0.001,0,-0.002";
}

} // namespace

TEST_CASE("the real dog's jaw: two meshes to a verified table that misses no contact of the meshes") {
    REQUIRE_SHARED_MESHES();
    const Folder folder;
    REQUIRE(runTss(makeJaw(), folder.path()).exit == 0);
    const Ran baked =
        runTss("bake jaw.tss -o baked.tss --tolerance 0.4mm --at-rest collide --json", folder.path());
    INFO(baked.err);
    REQUIRE(baked.exit == 0);
    const Json info = Json::parse(baked.out)["pairs"][0];
    CHECK(info["certified"] == true);
    CHECK(info["epsilon"] == 0);

    const tss::SceneModel scene = tss::loadScene(folder / "baked.tss");
    REQUIRE(scene.pairs.size() == 1);
    REQUIRE(scene.pairs[0].table);
    const tss::Table& table = *scene.pairs[0].table;
    const tss::Motion motion = pairMotion(scene, scene.pairs[0]);
    const GroundTruth truth(scene.bodies[scene.pairs[0].bodyA].mesh, scene.bodies[scene.pairs[0].bodyB].mesh);

    int hits = 0, missed = 0, early = 0;
    double worst = 0;
    const auto judge = [&](const std::vector<double>& q) {
        const tss::Pose pose = tss::pose(motion, q);
        const bool table_hit = query(table, pose).hit(), hit = truth.touches(pose);
        hits += hit;
        missed += hit && !table_hit;
        if (!hit && table_hit) {
            ++early;
            worst = std::max(worst, truth.distance(pose));
        }
    };
    for (const auto& q : randomPoses(motion, 10000, 1)) judge(q);
    const auto near = nearContactPoses(truth, motion, 400, 1e-6, 2);
    for (const auto& q : near) judge(q);
    std::cout << "dog jaw: " << info["spheresA"] << " + " << info["spheresB"] << " spheres, "
              << table.testCount() << " tests; 10000 random and " << near.size() << " near poses: " << hits
              << " contacts, " << missed << " missed, " << early << " early, at most " << 1000 * worst
              << " mm before contact; bound " << 1000 * table.boundEarly.value() << " mm\n";
    CHECK(hits > 100);
    CHECK(missed == 0);
    CHECK(table.boundMiss == 0);
    CHECK(worst <= table.boundEarly.value());
    CHECK(table.boundEarly <= 0.8e-3 + 1e-6);
}

TEST_CASE("the real dog's jaw stops before its teeth meet when it closes") {
    REQUIRE_SHARED_MESHES();
    const Folder folder;
    REQUIRE(runTss(makeJaw(), folder.path()).exit == 0);
    REQUIRE(runTss("bake jaw.tss -o baked.tss --tolerance 0.4mm --quiet", folder.path()).exit == 0);
    std::string motion;
    for (int step = 0; step <= 48; ++step) motion += "0," + std::to_string(10 - 34.0 * step / 48) + "\n";
    writeText(folder.path() / "close.csv", motion);
    REQUIRE(runTss("play baked.tss --motion close.csv -o played.csv", folder.path()).exit == 0);

    const tss::SceneModel scene = tss::loadScene(folder / "baked.tss");
    const tss::Motion pairMotion_ = pairMotion(scene, scene.pairs[0]);
    const GroundTruth truth(scene.bodies[scene.pairs[0].bodyA].mesh, scene.bodies[scene.pairs[0].bodyB].mesh);
    std::istringstream rows(readText(folder.path() / "played.csv"));
    std::string line, last;
    std::getline(rows, line);
    int touching = 0, steps = 0;
    double open = 0;
    while (std::getline(rows, line)) {
        std::istringstream cells(line);
        double step, askedYaw, askedOpen, yaw;
        char comma;
        cells >> step >> comma >> askedYaw >> comma >> askedOpen >> comma >> yaw >> comma >> open;
        const double q[] = {yaw * M_PI / 180, open * M_PI / 180};
        touching += truth.touches(pose(pairMotion_, q));
        ++steps;
        last = line;
    }
    INFO(last);
    CHECK(steps == 49);
    CHECK(touching == 0);
    CHECK(open < -17);   // it does close ...
    CHECK(open > -21.5); // ... and stops where the canines meet, between -20 and -21 degrees
}

TEST_CASE(
    "a jaw that overlaps its skull where it rests bites and opens by the first advice that make prints") {
    REQUIRE_SHARED_MESHES();
    // The hinge as published, whose condyles overlap, with the jaw moved farther into the skull, metres.
    for (const char* into : {"0", "0.0005", "0.003"}) {
        INFO("moved by " << into << " m");
        const Folder folder;
        const std::string meshes = "make -o jaw.tss --a '" + sharedMesh("dog_jaw/skull.obj") + "' --b '" +
                                   sharedMesh("dog_jaw/mandible.obj") + "' ";
        const std::string hinge = "--dof rot:0.31299,0,0.68249:0,1,0:-15:20";
        const Ran first = runTss(meshes + hinge + " --b-offset=0,0," + into + " --json", folder.path());
        REQUIRE(first.exit == 0);
        const Json advice = Json::parse(first.out)["freeingMoves"][0];
        CHECK(advice["stops"].get<int>() + advice["freePoses"].get<int>() == advice["poses"].get<int>());
        // Where it would meet nothing, make prints limits that go past contact.
        std::string option = advice["option"];
        if (!advice["beyond"].is_null()) option = advice["beyond"]["option"];
        if (option.find("--dof") == std::string::npos) option += " " + hinge;
        const Ran made = runTss(meshes + option + " --json", folder.path());
        INFO(option);
        REQUIRE(made.exit == 0);
        CHECK(Json::parse(made.out)["freeingMoves"].empty());
        std::string tolerance = advice["tolerance"];
        if (!tolerance.empty()) tolerance = " --tolerance " + tolerance;
        REQUIRE(runTss("bake jaw.tss -o baked.tss --quiet" + tolerance, folder.path()).exit == 0);
        REQUIRE(runTss("play baked.tss -o played.csv --quiet", folder.path()).exit ==
                0); // through its limits
        std::istringstream rows(readText(folder.path() / "played.csv"));
        std::string row;
        std::getline(rows, row);
        CHECK(row.rfind("step,asked_Joint:rot,Joint:rot,", 0) == 0);
        double askedLow = 0, askedHigh = 0, low = 0, high = 0;
        while (std::getline(rows, row)) {
            double asked = 0, value = 0;
            REQUIRE(std::sscanf(row.c_str(), "%*d,%lf,%lf", &asked, &value) == 2);
            askedLow = std::min(askedLow, asked), askedHigh = std::max(askedHigh, asked);
            low = std::min(low, value), high = std::max(high, value);
        }
        std::cout << "dog jaw, " << into << " m into the skull: " << option << ", limits " << askedLow
                  << " to " << askedHigh << ", goes from " << low << " to " << high << " degrees\n";
        CHECK(low > askedLow + 0.1); // teeth stop it
        CHECK(low < -10);
        CHECK(high > 19.9);
    }
}
