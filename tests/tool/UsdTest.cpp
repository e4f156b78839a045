// A .usda becomes a scene, and a scene a .usda.
#include "bake/scene/SceneFile.h"
#include "tests/tool/Shell.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using Json = nlohmann::json;

#ifdef OSGTSS_HAVE_USDA

TEST_CASE("every command of docs/USD.md does what it says, one after the other") {
    const Folder folder;
    CHECK(runPage("USD.md", folder.path()).size() == 7);
    CHECK(readText(folder.path() / "again.tss") == readText(folder.path() / "baked.tss"));
    CHECK(readText(folder.path() / "arm_out.usda").find("physics:filteredPairs") != std::string::npos);
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

TEST_CASE("a stage reads no file outside of its folder, through links neither, and says which it is") {
    const Folder folder;
    writeText(folder.path() / "secret.usda", "#usda 1.0\ndef Cube \"B\" {}\n");
    std::filesystem::create_directories(folder.path() / "stage/parts");
    std::filesystem::create_symlink("../secret.usda", folder.path() / "stage/link.usda");
    writeText(folder.path() / "stage/parts/good.usda",
              "#usda 1.0\ndef Cube \"B\" ( references = @../own.usda@</C> ) {}\n");
    writeText(folder.path() / "stage/own.usda", "#usda 1.0\ndef Cube \"C\" {}\n");
    const auto made = [&](const std::string& file) {
        writeText(folder.path() / "stage/a.usda",
                  "#usda 1.0\ndef \"A\" ( references = @" + file + "@</B> ) {}\n");
        return runTss("make stage/a.usda -o a.tss", folder.path());
    };
    CHECK(made("parts/good.usda").exit == 0);
    for (const std::string file : {"../secret.usda", "link.usda", "parts/../../secret.usda", "/etc/passwd",
                                   "https://example.org/a.usda", "gone.usda", "parts"}) {
        const Ran ran = made(file);
        INFO(file << ": " << ran.err);
        CHECK(ran.exit == 1);
        CHECK(ran.err.find("@" + file + "@") != std::string::npos);
        CHECK(ran.err.find("line 2") != std::string::npos);
    }
    CHECK(made("../secret.usda").err.find("--package NAME=DIR") != std::string::npos);
    CHECK(runTss("make stage/a.usda -o a.tss --package all=.", folder.path()).exit == 0);
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
