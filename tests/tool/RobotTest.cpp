// From a robot's file to a baked scene and back to what planners and simulators read.
#include "bake/scene/SceneFile.h"
#include "tests/tool/Swing.h"

#include <nlohmann/json.hpp>
#include <sys/stat.h>

using Json = nlohmann::json;

namespace {

/// Three boxes in a row: the first hinge never brings its neighbour to the base, the last box can hit it.
const char* arm = R"(<?xml version="1.0"?>
<robot name="arm">
  <link name="base"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="upper-arm"><collision><geometry><mesh filename="package://my_arm/upper.obj"/></geometry></collision></link>
  <link name="tool"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="camera"><collision><origin xyz="0 0 0.2"/><geometry><box size="0.02 0.02 0.02"/></geometry></collision></link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper-arm"/><origin xyz="0.3 0 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3.1"/>
  </joint>
  <joint name="elbow" type="revolute">
    <parent link="upper-arm"/><child link="tool"/><origin xyz="0.25 0 0"/><axis xyz="0 0 1"/><limit lower="-1" upper="1"/>
  </joint>
  <joint name="mount" type="fixed"><parent link="base"/><child link="camera"/></joint>
</robot>
)";

void writeArm(const Folder& folder) {
    std::filesystem::create_directories(folder.path() / "my_arm");
    writeText(folder.path() / "my_arm/arm.urdf", arm);
    writeObj(boxMesh({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}), folder / "my_arm/upper.obj");
}

Ran made(const std::string& arguments, const Folder& folder) {
    Ran ran = runTss("make " + arguments, folder.path());
    INFO(ran.err);
    CHECK(ran.exit == 0);
    return ran;
}

} // namespace

#ifdef OSGTSS_HAVE_URDF
TEST_CASE("frames and fixed joints of a robot are said together, the first of many by name") {
    const Folder folder;
    std::string robot = "<robot name='r'><link name='base'><visual><geometry><box size='1 1 1'/>"
                        "</geometry></visual></link>";
    for (int k = 0; k < 9; ++k) {
        const std::string name = "skin" + std::to_string(k);
        robot += "<link name='" + name + "'/><joint name='" + name +
                 "_tie' type='fixed'><parent link='base'/><child link='" + name + "'/></joint>";
    }
    writeText(folder.path() / "skins.urdf", robot + "</robot>");
    const Ran ran = made("skins.urdf -o skins.tss", folder);
    const std::string said = ran.out + ran.err;
    CHECK(said.find("\nno geometry: skin0, skin1, skin2, skin3, skin4, skin5 and 3 more\n") !=
          std::string::npos);
    CHECK(
        said.find("\nfixed: skin0_tie, skin1_tie, skin2_tie, skin3_tie, skin4_tie, skin5_tie and 3 more\n") !=
        std::string::npos);
}

TEST_CASE("bodies of an odd size are named together, each with its own") {
    const Folder folder;
    std::string robot = "<robot name='r'>";
    for (int k = 0; k < 6; ++k)
        robot += "<link name='l" + std::to_string(k) + "'><visual><geometry><box size='" +
                 std::to_string(20 + k) + " 0.1 0.1'/></geometry></visual></link>";
    writeText(folder.path() / "long.urdf", robot + "</robot>");
    const Ran ran = made("long.urdf -o long.tss", folder);
    CHECK((ran.out + ran.err)
              .find("note: how long bodies are if one unit of their meshes is 1 m: /r/l0 20 m, /r/l1 21 m, "
                    "/r/l2 22 m, /r/l3 23 m and 2 more; where that is wrong") != std::string::npos);
}

TEST_CASE("a link of a robot is moved at its joint, which stays, with what hangs on it") {
    const Folder folder;
    writeArm(folder);
    made("my_arm/arm.urdf -o arm.tss", folder);
    made("my_arm/arm.urdf -o moved.tss --offset upper-arm=0.1,0.2,0 --offset upper-arm=0,0,0.05", folder);
    const tss::SceneModel arm = tss::loadScene(folder / "arm.tss"),
                          moved = tss::loadScene(folder / "moved.tss");
    const tss::Vec3 by(0.1, 0.2, 0.05);
    for (std::size_t k = 0; k < arm.bodies.size(); ++k) {
        const std::string& path = arm.bodies[k].path;
        const bool goes = path.ends_with("upper_arm") || path.ends_with("tool");
        const tss::Vec3 moves =
            moved.bodies[k].placement.translation() - arm.bodies[k].placement.translation();
        INFO(path);
        CHECK((moves - (goes ? by : tss::Vec3::Zero())).norm() < 1e-6);
    }
    // The axis is where it was.
    for (const tss::Pair& pair : arm.pairs) {
        const tss::Motion before = pairMotion(arm, pair),
                          now = pairMotion(moved, moved.pairs[&pair - arm.pairs.data()]);
        if (pair.joints.size() != 1 || !arm.joints[pair.joints[0]].path.ends_with("shoulder")) continue;
        const std::vector<double> q{1.1};
        CHECK((pose(now, q).translation() - pose(before, q) * by).norm() < 1e-6);
    }
    CHECK(runTss("make my_arm/arm.urdf -o no.tss --offset base=1,0,0", folder.path()).exit == 1);
    const Ran unknown = runTss("make my_arm/arm.urdf -o no.tss --offset arm=1,0,0", folder.path());
    CHECK(unknown.exit == 1);
    CHECK(unknown.err.find("upper-arm") != std::string::npos);
    const Ran misspelt = runTss("make --a my_arm/upper.obj --bb 3 -o no.tss", folder.path());
    CHECK(misspelt.exit == 2);
    CHECK(misspelt.err.find("--bb") != std::string::npos);
    CHECK(runTss("make my_arm/arm.urdf --rest 3 -o no.tss", folder.path()).exit == 2);
}

TEST_CASE("a URDF is made, baked, and written as an SRDF that says Never only where it was proven") {
    const Folder folder;
    writeArm(folder);
    const Json robot = Json::parse(made("my_arm/arm.urdf -o arm.tss --json", folder).out);
    CHECK(robot["robot"] == "arm");
    CHECK(robot["links"].size() == 4);
    CHECK(robot["joints"].size() == 3);
    // camera and base do not move against each other
    CHECK(robot["pairs"].size() == 5);

    // Nothing is proven before it is baked.
    REQUIRE(runTss("convert arm.tss open.srdf --json", folder.path()).exit == 0);
    CHECK(readText(folder.path() / "open.srdf").find("Never") == std::string::npos);

    const Ran baked = runTss("bake arm.tss -o baked.tss --tolerance 5mm", folder.path());
    INFO(baked.err);
    REQUIRE(baked.exit == 0);
    const Ran ran = runTss("convert baked.tss arm.srdf --json", folder.path());
    REQUIRE(ran.exit == 0);
    const Json counts = Json::parse(ran.out);
    const std::string srdf = readText(folder.path() / "arm.srdf");
    INFO(srdf);
    CHECK(srdf.find("<robot name=\"arm\">") != std::string::npos);
    CHECK(srdf.find("link1=\"base\" link2=\"upper-arm\" reason=\"Adjacent\"") != std::string::npos);
    CHECK(srdf.find("link1=\"upper-arm\" link2=\"camera\" reason=\"Never\"") != std::string::npos);
    CHECK(srdf.find("link1=\"base\" link2=\"tool\"") == std::string::npos);
    CHECK(srdf.find("base, tool: stay on: the meshes meet, as at shoulder ") != std::string::npos);
    CHECK(srdf.find("base, upper-arm: joined; proven apart by at least ") != std::string::npos);
    CHECK(counts["adjacent"] == 3);
    CHECK(counts["never"].get<int>() >= 1);
    CHECK(counts["meets"].get<int>() >= 1);

    // What the SRDF switches off is left out when the robot is made again.
    const Json fewer = Json::parse(made("my_arm/arm.urdf -o fewer.tss --srdf arm.srdf --json", folder).out);
    const std::size_t off = counts["never"].get<std::size_t>() + 2; // two of the adjacent ones move
    CHECK(fewer["pairs"].size() == 5 - off);

    REQUIRE(runTss("convert baked.tss excludes.xml", folder.path()).exit == 0);
    const std::string excludes = readText(folder.path() / "excludes.xml");
    CHECK(excludes.find("<exclude body1=\"upper-arm\" body2=\"camera\"/>") != std::string::npos);
    CHECK(excludes.find("body1=\"base\" body2=\"tool\"") == std::string::npos);
    REQUIRE(runTss("convert baked.tss arm.usda --filtered-pairs", folder.path()).exit == 0);
    const std::string usda = readText(folder.path() / "arm.usda");
    CHECK(usda.find("PhysicsFilteredPairsAPI") != std::string::npos);
    CHECK(usda.find("rel physics:filteredPairs = ") != std::string::npos);
}

TEST_CASE("a stale proof is no proof: the SRDF is refused and names the pair") {
    const Folder folder;
    writeArm(folder);
    made("my_arm/arm.urdf -o arm.tss --pairs neighbours", folder);
    REQUIRE(runTss("bake arm.tss -o baked.tss --tolerance 5mm", folder.path()).exit == 0);
    std::string text = readText(folder.path() / "baked.tss");
    const auto at = text.find("physics:upperLimit");
    REQUIRE(at != std::string::npos);
    text.insert(text.find_first_of("0123456789", text.find("\"default\":", at)), 1, '1');
    writeText(folder.path() / "baked.tss", text);
    const Ran ran = runTss("convert baked.tss arm.srdf", folder.path());
    INFO(ran.err);
    CHECK(ran.exit == 1);
    CHECK(ran.err.find("baked.tss") != std::string::npos);
    CHECK(ran.err.find("limits") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "arm.srdf"));
}

TEST_CASE("convert makes of a robot's file the very scene that make does, and refuses what is none") {
    const Folder folder;
    writeArm(folder);
    made("my_arm/arm.urdf -o made.tss", folder);
    const Ran ran = runTss("convert my_arm/arm.urdf converted.tss", folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    CHECK(readText(folder.path() / "converted.tss") == readText(folder.path() / "made.tss"));
    std::filesystem::create_directories(folder.path() / "alone");
    writeText(folder.path() / "alone/arm.urdf", arm);
    std::filesystem::rename(folder.path() / "my_arm", folder.path() / "moved");
    CHECK(runTss("convert alone/arm.urdf a.usda", folder.path()).exit == 1);
    CHECK(runTss("convert alone/arm.urdf a.usda --package my_arm=moved", folder.path()).exit == 0);
    writeText(folder.path() / "config.xml", "<config/>");
    CHECK(runTss("convert config.xml c.tss", folder.path()).err.find("cannot be read as a mesh") !=
          std::string::npos);
    CHECK(runTss("convert made.tss again.tss --srdf x.srdf", folder.path()).exit == 2); // does nothing
}

TEST_CASE("what a robot's file needs and has not is exit 1 with the place, and leaves no scene") {
    const Folder folder;
    writeArm(folder);
    const auto refused = [&](const std::string& arguments, int exit, const std::string& words) {
        const Ran ran = runTss("make " + arguments, folder.path());
        INFO(arguments << "\n" << ran.err);
        CHECK(ran.exit == exit);
        CHECK(ran.err.find(words) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(folder.path() / "out.tss"));
    };
    std::filesystem::create_directories(folder.path() / "alone");
    writeText(folder.path() / "alone/arm.urdf", arm);
    refused("alone/none.urdf -o out.tss", 1, "alone/none.urdf");
    REQUIRE(mkfifo((folder / "pipe.urdf").c_str(), 0600) == 0);
    refused("pipe.urdf -o out.tss", 1, "expected a regular file"); // and not waited for
    writeText(folder.path() / "config.xml", "<?xml version='1.0'?>\n<!-- <robot> -->\n<config/>\n");
    refused("config.xml -o out.tss", 1,
            "config.xml: expected the <robot> of a URDF or the <mujoco> of an MJCF, found <config>");
    writeText(folder.path() / "part.xml", "<mujocoinclude/>");
    refused("part.xml -o out.tss", 1, "found <mujocoinclude>, a part of one: take the file that includes it");
    writeText(folder.path() / "model.sdf", "<?xml version='1.0'?>\n<sdf version='1.7'/>");
    refused("model.sdf -o out.tss", 1, "found <sdf>, of Gazebo; sdf2mjcf of gz-mujoco makes an MJCF of it");
    writeText(folder.path() / "wide.urdf", std::string("\xFF\xFE<\0r\0o\0b\0o\0t\0/\0>\0", 18)); // UTF-16
    refused("wide.urdf -o out.tss", 1, "wide.urdf: expected text in UTF-8");
    writeText(folder.path() / "large.urdf",
              "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n");
    refused("large.urdf -o out.tss", 1, "large.urdf: is a pointer of Git LFS");
    std::filesystem::rename(folder.path() / "my_arm", folder.path() / "moved");
    refused("alone/arm.urdf -o out.tss", 1,
            "alone/arm.urdf: line 4 (<link upper-arm>): file \"package://my_arm/upper.obj\"");
    refused("alone/arm.urdf -o out.tss", 1, "--package my_arm=DIR");
    const Ran without = runTss("make alone/arm.urdf -o without.tss --package my_arm=", folder.path());
    CHECK(without.exit == 0);
    CHECK(without.out.find("its package is left out") != std::string::npos);
    CHECK(runTss("make alone/arm.urdf -o found.tss --package my_arm=moved", folder.path()).exit == 0);
    refused("alone/arm.urdf -o out.tss --package my_arm=nowhere", 1, "there is no folder nowhere");
    refused("alone/arm.urdf -o alone/arm.urdf --package my_arm=moved", 1, "ends in .tss");
    refused("moved/upper.obj -o out.tss", 1,
            "is a mesh; expected a robot's file, or two meshes as --a and --b");
    refused("alone/arm.urdf -o out.tss --meters-per-unit 1mm", 2, "--meters-per-unit");
    refused("without.tss -o out.tss", 1, "is a scene already");
    refused("alone/arm.urdf -o out.tss --pairs some", 2, "neighbours");
    refused("alone/arm.urdf -o out.tss --a moved/upper.obj", 2, "--a");
    refused("-o out.tss --b moved/upper.obj --dof rot:0,0,0:0,0,1:0:1", 2, "--a");
    refused("-o out.tss --a moved/upper.obj --b moved/upper.obj", 2, "--dof");
    CHECK(runTss("convert moved/upper.obj out.srdf", folder.path()).err.find("expected a baked scene") !=
          std::string::npos);
    CHECK(
        runTss("info alone/arm.urdf", folder.path()).err.find("of a robot's file `tss make` makes a scene") !=
        std::string::npos);
    CHECK(runTss("bake moved/upper.obj -o x.tss", folder.path()).err.find("of a mesh `tss convert`") !=
          std::string::npos);
    const Ran spaced =
        runTss("make alone/arm.urdf -o \"it's an arm.tss\" --package my_arm=moved", folder.path());
    CHECK(spaced.out.find("next: tss bake 'it'\\''s an arm.tss' -o BAKED.tss") != std::string::npos);
}
#endif
