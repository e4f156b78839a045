// What `tss make` and the commands after it say of bodies that touch or overlap where the joints rest, and
// the tolerances that follow from their room there.
#include "bake/scene/SceneFile.h"
#include "tests/tool/Swing.h"

#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

using Json = nlohmann::json;

TEST_CASE("bodies that overlap at rest get a joint to paste, and what hangs on the one that is moved goes "
          "with it") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -2}, {1, 1, 0}), folder / "block.obj");
    writeObj(boxMesh({-0.5, -0.5, -0.1}, {0.5, 0.5, 2}), folder / "arm.obj");
    writeObj(boxMesh({-0.4, -0.4, 2.1}, {0.4, 0.4, 3}), folder / "hand.obj");
    const std::string bodies = "make -o out.tss --body block.obj --body arm.obj --body hand.obj "
                               "--joint 'wrist=arm,hand:rot:0,0,2.05:1,0,0:-2:2' --pairs neighbours --json ";
    const std::string first = "--joint 'shoulder=block,arm:rot:0,0,0:0,1,0:-2:2'";
    const Json overlaps = Json::parse(runTss(bodies + first, folder.path()).out);
    REQUIRE(overlaps["freeingMoves"].size() >= 1);
    const Json& move = overlaps["freeingMoves"][0];
    CHECK(move["pair"] == "/out/shoulder");
    CHECK(move["freePoses"] == move["poses"]);
    const std::string option = move["option"];
    INFO(option);
    REQUIRE(option.rfind("--offset arm=", 0) == 0);

    const Ran followed = runTss(bodies + first + " " + option, folder.path());
    INFO(followed.err);
    REQUIRE(followed.exit == 0);
    CHECK_FALSE(Json::parse(followed.out).contains("freeingMoves"));
    const tss::SceneModel scene = tss::loadScene(folder / "out.tss");
    const tss::Vec3 shift(move["shift"][0], move["shift"][1], move["shift"][2]);
    CHECK(shift.norm() > 0.1);
    for (const char* body : {"/out/arm", "/out/hand"})
        CHECK((scene.bodies[findBody(scene, body)].placement.translation() - shift).norm() < 1e-5);
    // The wrist is where it was in both.
    const tss::Motion wrist = pairMotion(scene, scene.pairs.at(1));
    CHECK((pose(wrist, std::vector{0.03}) * tss::Vec3(0, 0, 2.05) - tss::Vec3(0, 0, 2.05)).norm() < 1e-6);
}

TEST_CASE(
    "make gives each pair of a long chain's scene a tolerance by its bodies and their room at rest, and "
    "tells of parts that overlap untied") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 0}), folder / "block.obj");
    writeObj(boxMesh({-1, -1, 0.04}, {1, 1, 0.5}), folder / "lid.obj");       // 40 mm above it
    writeObj(boxMesh({0.8, -0.2, 0.4}, {1.4, 0.2, 0.8}), folder / "arm.obj"); // in the lid
    writeObj(boxMesh({1.2, -0.2, 0.81}, {1.8, 0.2, 1.1}), folder / "hand.obj");
    const std::string wrist = "--joint 'wrist=arm,hand:rot:1.3,0,0.85:0,0,1:-9:9;rot:1.3,0,0.85:1,0,0:-1:1' ",
                      bodies =
                          "make -o out.tss --body block.obj --body lid.obj --body arm.obj --body hand.obj "
                          "--joint 'lift=block,lid:trans:0,0,1:-0.1:0.5' "
                          "--joint 'elbow=lid,arm:rot:0.9,0,0.55:0,0,1:-9:9' --json ";
    const auto made = [&](const std::string& joints) {
        const Ran ran = runTss(bodies + joints, folder.path());
        INFO(ran.err);
        REQUIRE(ran.exit == 0);
        CHECK(ran.err.find("next: tss bake out.tss -o BAKED.tss") != std::string::npos);
        std::map<std::string, double> tolerances; // of the smaller body's diagonal
        const tss::SceneModel scene = tss::loadScene(folder / "out.tss");
        for (const tss::Pair& pair : scene.pairs) {
            const double smaller = std::min(tss::diagonal(scene.bodies[pair.bodyA].mesh),
                                            tss::diagonal(scene.bodies[pair.bodyB].mesh));
            const std::string name = tss::primName(scene.bodies[pair.bodyA].path) + " " +
                                     tss::primName(scene.bodies[pair.bodyB].path);
            const auto own = pair.settings.find("tolerance"); // in millimetres
            const double millimetres = own == pair.settings.end() ? 0 : std::stod(own->second);
            tolerances[name] = millimetres / 1000 / scene.metersPerUnit / smaller;
        }
        return tolerances;
    };
    auto share = made(wrist);
    CHECK(share["block hand"] ==
          Approx(1 / 30.0).epsilon(0.2));                  // a long chain: of the steps that pairs share
    CHECK(share["lid arm"] == Approx(0.01).epsilon(0.05)); // what is near the overlap is exempt
    CHECK(share["block lid"] * std::sqrt(8.2116) == Approx(0.012).epsilon(0.05)); // room of 40 mm
    writeObj(boxMesh({-1, -1, 1e-4}, {1, 1, 0.5}), folder / "lid.obj");
    CHECK(made(wrist)["block lid"] == Approx(1 / 500.0).epsilon(0.05)); // no finer than a bake by itself
    // Without a long chain they have what a bake takes by itself.
    for (const auto& [name, tolerance] : made("--joint 'wrist=arm,hand:rot:1.3,0,0.85:0,0,1:-9:9' "))
        CHECK(tolerance == 0);

    writeObj(boxMesh({1.2, -0.2, -0.5}, {1.8, 0.2, 0.3}), folder / "arm.obj");
    writeObj(boxMesh({0.9, -0.2, -0.6}, {1.1, 0.2, -0.2}), folder / "hand.obj"); // half in the block
    writeObj(boxMesh({-1, -1, 0.01}, {1, 1, 0.5}), folder / "lid.obj");
    const Json notes = Json::parse(runTss(bodies + wrist, folder.path()).out)["notes"];
    REQUIRE(notes.size() == 1);
    CHECK(notes[0].get<std::string>().starts_with("block and hand: touch or overlap where the joints rest"));
}

TEST_CASE(
    "bodies that a joint of two DOFs ties get moves too, where they overlap at rest, and where they do not") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -2}, {1, 1, 0}), folder / "block.obj");
    writeObj(boxMesh({-0.5, -0.5, -0.1}, {0.5, 0.5, 2}), folder / "arm.obj");
    const std::string make = "make -o out.tss --body block.obj --body arm.obj --joint "
                             "'lift=block,arm:rot:-1,0,0:0,1,0:-90:1;rot:0,0,2:1,0,0:-1:1' --json ";
    const Ran first = runTss(make, folder.path());
    INFO(first.err);
    const Json overlaps = Json::parse(first.out);
    REQUIRE(overlaps.contains("freeingMoves"));
    CHECK(first.err.find("(tss:rest -90 of lift1, 0 of lift2)") != std::string::npos);
    const std::string option = overlaps["freeingMoves"][0]["option"];
    const Ran followed = runTss(make + option, folder.path());
    INFO(option << followed.err);
    REQUIRE(followed.exit == 0);
    CHECK_FALSE(Json::parse(followed.out).contains("freeingMoves"));
}

TEST_CASE(
    "a jaw that rests where it is free, and overlaps elsewhere, gets there by what make prints, twice") {
    const Folder folder;
    // A lever whose foot is sunk into a block once it turns a little.
    writeObj(boxMesh({-1, -1, -2}, {1, 1, 0}), folder / "block.obj");
    writeObj(boxMesh({-0.9, -0.5, 0.05}, {0.9, 0.5, 2}), folder / "lever.obj");
    const std::string make = "make -o out.tss --a block.obj --b lever.obj --dof rot:0,0,1:0,1,0:-1:20 ";
    const Ran first = runTss(make, folder.path());
    const auto at = first.out.find("--rest=");
    INFO(first.out);
    REQUIRE(at != std::string::npos);
    const std::string rest = first.out.substr(at, first.out.find(')', at) - at);
    const Json second = Json::parse(runTss(make + rest + " --json", folder.path()).out);
    REQUIRE(second["freeingMoves"].size() >= 1);
    CHECK(second["freeingMoves"][0]["freePoses"] == second["freeingMoves"][0]["poses"]);
    const std::string option = second["freeingMoves"][0]["option"];
    const std::string dof = option.find("--dof") == option.npos ? "--dof rot:0,0,1:0,1,0:-1:20 " : "";
    const Json third = Json::parse(
        runTss("make -o out.tss --a block.obj --b lever.obj " + dof + option + " --json", folder.path()).out);
    CHECK(third["freeingMoves"].empty());
}

TEST_CASE("info says of what overlaps at rest and is left out that it is") {
    const Folder folder;
    writeObj(boxMesh({-1, -1, -2}, {1, 1, 0}), folder / "block.obj");
    writeObj(boxMesh({-0.5, -0.5, -0.1}, {0.5, 0.5, 2}), folder / "arm.obj");
    REQUIRE(
        runTss("make -o out.tss --a block.obj --b arm.obj --dof trans:0,0,1:-0.5:0.5", folder.path()).exit ==
        0);
    REQUIRE(runTss("bake out.tss -o out.tss --tolerance 0.1 --at-rest ignore --quiet", folder.path()).exit ==
            0);
    const Ran text = runTss("info out.tss", folder.path());
    CHECK(text.out.find("which overlap at rest: never told") != std::string::npos);
    const Json json = Json::parse(runTss("info out.tss --json", folder.path()).out);
    CHECK(json["pairs"][0]["restRegion"]["depth"].is_null());
}

TEST_CASE("of many joints that overlap at rest only the best move of each is said") {
    const Folder folder;
    std::string bodies, joints;
    for (int k = 0; k < 5; ++k) {
        const std::string name = "b" + std::to_string(k);
        writeObj(boxMesh({2.0 * k, -0.2, -0.2}, {2.0 * k + 2.02, 0.2, 0.2}), folder / (name + ".obj"));
        bodies += "--body " + name + ".obj ";
        if (k > 0) joints += fmt::format("--joint 'j{}=b{},b{}:rot:{},0,0:0,1,0:-3:40' ", k, k - 1, k, 2 * k);
        if (k < 1) continue;
        const Ran ran = runTss("make -o row.tss --json " + bodies + joints, folder.path());
        INFO(ran.err);
        REQUIRE(ran.exit == 0);
        std::size_t said = 0;
        for (auto at = ran.err.find(" elsewhere, free at "); at != std::string::npos;
             at = ran.err.find(" elsewhere, free at ", at + 1))
            ++said;
        const std::size_t all = Json::parse(ran.out)["freeingMoves"].size();
        CHECK(all > static_cast<std::size_t>(k));
        CHECK(said == (k > 3 ? 4 : all));
    }
}
