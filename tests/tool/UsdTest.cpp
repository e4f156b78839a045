// A .usda becomes a scene, and a scene a .usda.
#include "bake/scene/SceneFile.h"
#include "tests/tool/Shell.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

using Json = nlohmann::json;

#ifdef OSGTSS_HAVE_USDA

TEST_CASE("every command of docs/USD.md does what it says, one after the other") {
    const Folder folder;
    const std::vector<Ran> commands = runPage("USD.md", folder.path());
    REQUIRE(commands.size() == 10);
    CHECK(commands[1].out.find("wrote glove.tss: 6 parts, 5 joints, 4 pairs") != std::string::npos);
    // The glove's fingers meet before they are as its animation has them.
    CHECK(commands[3].out.find("slid") != std::string::npos);
    CHECK(readText(folder.path() / "again.tss") == readText(folder.path() / "baked.tss"));
    CHECK(readText(folder.path() / "arm_out.usda").find("physics:filteredPairs") != std::string::npos);
}

TEST_CASE("bones that an animation has in each other half of the time or more are no pair, by name") {
    const Folder folder;
    std::string glove = readText(OSGTSS_SOURCE_DIR "/examples/arm/glove.usda");
    const auto first = glove.find("                0: [("), closed = glove.find("                24: [(");
    const auto end = glove.find("                36: [(");
    REQUIRE(end != glove.npos);
    const std::string keys = glove.substr(closed + 20, end - closed - 20);
    glove.replace(first + 19, closed - first - 19, keys); // it begins as closed as it comes to be
    std::ofstream(folder / "glove.usda") << glove;
    const Ran made = runTss("make glove.usda -o glove.tss", folder.path());
    INFO(made.out << made.err);
    CHECK(made.out.find(
              "no pair: bones that the animation has in each other half of the time or more, by which "
              "they would be held: LeftTip and RightTip\n") != std::string::npos);
    CHECK(made.out.find("5 joints, 3 pairs") != std::string::npos);
}

TEST_CASE("pairs of a character are of bones that its animation has near each other, unless all are wanted") {
    const Folder folder;
    const std::string make = "make " OSGTSS_SOURCE_DIR "/examples/arm/glove.usda -o ";
    const Ran near = runTss(make + "near.tss", folder.path());
    CHECK(near.out.find("left out: 2 pairs of bones that the animation never has nearer") !=
          std::string::npos);
    REQUIRE(runTss(make + "all.tss --pairs all", folder.path()).exit == 0);
    const auto pairsOf = [&](const char* file) {
        std::set<std::string> paths;
        for (const tss::Pair& pair : tss::loadScene(folder / file).pairs) paths.insert(pair.path);
        return paths;
    };
    const std::set<std::string> some = pairsOf("near.tss"), all = pairsOf("all.tss");
    CHECK(some.size() == 4);
    CHECK(all.size() == 6);
    CHECK(std::ranges::includes(all, some));
}

#ifdef OSGTSS_HAVE_URDF
TEST_CASE("the arm is the same from its URDF and from UsdPhysics") {
    const Folder folder;
    const std::string arm = OSGTSS_SOURCE_DIR "/examples/arm/";
    REQUIRE(runTss("make " + arm + "arm.usda -o usd.tss", folder.path()).exit == 0);
    REQUIRE(runTss("make " + arm + "arm.urdf -o urdf.tss", folder.path()).exit == 0);
    const tss::SceneModel usd = tss::loadScene(folder / "usd.tss"),
                          urdf = tss::loadScene(folder / "urdf.tss");
    REQUIRE(usd.bodies.size() == urdf.bodies.size());
    for (const tss::Body& body : urdf.bodies) {
        INFO(body.path);
        const int other = tss::findBody(usd, body.path);
        REQUIRE(other >= 0);
        const Eigen::AlignedBox3d a = tss::bounds(body.mesh), b = tss::bounds(usd.bodies[other].mesh);
        CHECK((a.min() - b.min()).norm() < 1e-6);
        CHECK((a.max() - b.max()).norm() < 1e-6);
        CHECK((body.placement.translation() - usd.bodies[other].placement.translation()).norm() < 1e-6);
    }
    CHECK(usd.pairs.size() == urdf.pairs.size());
}
#endif

TEST_CASE("a stage reads files where a robot's meshes may lie, no others, and says which it is") {
    const Folder folder;
    const auto robot = folder.path() / "all/robot";
    std::filesystem::create_directories(robot / "parts");
    writeText(folder.path() / "secret.usda", "#usda 1.0\ndef Cube \"B\" {}\n");
    writeText(folder.path() / "all/hand.usda", "#usda 1.0\ndef Cube \"B\" {}\n");
    std::filesystem::create_symlink("../../secret.usda", robot / "link.usda");
    writeText(robot / "parts/good.usda", "#usda 1.0\ndef Cube \"B\" ( references = @../own.usda@</C> ) {}\n");
    writeText(robot / "own.usda", "#usda 1.0\ndef Cube \"C\" {}\n");
    const auto made = [&](const std::string& file, const std::string& options = "") {
        writeText(robot / "a.usda",
                  "#usda 1.0\ndef \"A\" ( references = @" + file + "@</B> ) {}\ndef Cube \"rest\" {}\n");
        return runTss("make all/robot/a.usda -o a.tss" + options, folder.path());
    };
    for (const std::string file : {"parts/good.usda", "../hand.usda"}) CHECK(made(file).exit == 0);
    const auto expectNamed = [&](const Ran& ran, const std::string& file, int exit) {
        INFO(file << ": " << ran.out << ran.err);
        CHECK(ran.exit == exit);
        CHECK((ran.out + ran.err).find("line 2 (</A>): @" + file + "@: ") != std::string::npos);
    };
    for (const std::string file :
         {"../../secret.usda", "link.usda", "parts/../../../secret.usda", "/etc/passwd"})
        expectNamed(made(file), file, 1);
    for (const std::string file : {"https://example.org/a.usda", "../../gone.usda", "parts"})
        expectNamed(made(file), file, 0); // the rest comes in
    const std::string hint = " --package all=" + std::filesystem::canonical(folder.path()).string();
    CHECK_THAT(made("../../secret.usda").err, Catch::Contains(hint));
    CHECK(made("../../secret.usda", hint).exit == 0);
}

TEST_CASE("a .usda with --srdf or as a mesh's name is refused, and a skin comes back by convert") {
    const Folder folder;
    const std::string scene = OSGTSS_SOURCE_DIR "/scenes/dog_lips.tss";
    REQUIRE(runTss("convert " + scene + " lips.usda", folder.path()).exit == 0);
    const Ran back = runTss("make lips.usda -o lips.tss --json", folder.path());
    INFO(back.err);
    REQUIRE(back.exit == 0);
    CHECK(Json::parse(back.out)["skins"].size() == tss::loadScene(scene).skins.size());
    CHECK(readText(folder.path() / "lips.tss") == readText(scene));
    CHECK(runTss("make lips.usda -o x.tss --srdf lips.usda", folder.path()).exit == 2);
    const Ran bake = runTss("bake lips.usda -o x.tss", folder.path());
    CHECK(bake.exit == 1);
    CHECK(bake.err.find("makes a scene of it, a .tss") != std::string::npos);
}

#endif
