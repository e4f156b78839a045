// What goes in and out beside scenes: glTF and other meshes, spheres for cuRobo, motions, and options that do
// nothing.
#include "bake/scene/SceneFile.h"
#include "tests/MeshFileTexts.h"
#include "tests/tool/Swing.h"

#include <nlohmann/json.hpp>
#include <sstream>

namespace {

/// Two tetrahedra, the second three up, twice as wide, and moving.
const char* const twoNodes = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"name":"lower","mesh":0},{"name":"upper","mesh":0,"translation":[0,3,0],"scale":[2,1,1]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"animations":[{"name":"wave","channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}],"samplers":[{"input":2,"output":3}]}],
"buffers":[{"byteLength":104,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAACAAEAAAABAAMAAAADAAIAAQACAAMAAAAAAAAAgD8AAAAAAABAQAAAAAAAAAAAAACAQAAAAAA="}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24},{"buffer":0,"byteOffset":72,"byteLength":8},{"buffer":0,"byteOffset":80,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"},{"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},{"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}]})";

std::string twoBoxes(const Folder& folder) {
    writeObj(boxMesh({-1, -1, -1}, {1, 1, 1}), folder / "a.obj");
    writeObj(boxMesh({2, -1, -1}, {4, 1, 1}), folder / "b.obj");
    return "make -o s.tss --a a.obj --b b.obj --dof rot:1.5,0,0:0,0,1:0:90 --meters-per-unit 0.1";
}

/// B beside A, and sliding.
const std::string aside = " --b-offset 5,0,0 --dof trans:1,0,0:0:1";

bool says(const Ran& ran, const std::string& words) {
    return ran.out.find(words) != std::string::npos;
}

} // namespace

TEST_CASE("nodes of a glTF are bodies where they stand, Y is up, and what is left out is said") {
    const Folder folder;
    writeText(folder.path() / "two.gltf", twoNodes);
    const Ran ran = runTss("convert two.gltf two.tss", folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    CHECK(ran.out.find("left out of two.gltf: 1 animation") != std::string::npos);
    const tss::SceneModel scene = tss::loadScene(folder / "two.tss");
    CHECK(scene.upAxis == 'Y');
    REQUIRE(scene.bodies.size() == 2);
    CHECK(scene.bodies[0].path == "/two/lower");
    CHECK(scene.bodies[1].path == "/two/upper");
    CHECK(scene.bodies[1].placement.translation().isApprox(tss::Vec3(0, 3, 0)));
    CHECK(tss::bounds(scene.bodies[1].mesh).max().isApprox(tss::Vec3(2, 1, 1)));
    REQUIRE(runTss("make -o made.tss --body two.gltf", folder.path()).exit == 0);
    CHECK(tss::loadScene(folder / "made.tss").upAxis == 'Y');
    REQUIRE(runTss("make -o made.tss --body two.gltf --up-axis Z", folder.path()).exit == 0);
    CHECK(tss::loadScene(folder / "made.tss").upAxis == 'Z');
}

TEST_CASE("a file's own unit is remarked upon where another is given") {
    const Folder folder;
    writeText(folder.path() / "a.amf", tss::test::tetrahedronAmf(" unit=\"inch\""));
    const std::string make = "make -o s.tss --a a.amf --b a.amf" + aside;
    const Ran other = runTss(make, folder.path());
    INFO(other.out << other.err);
    CHECK(other.exit == 0);
    CHECK(
        says(other, "note: a.amf says that one of its units, as it is read, is 0.0254 m, and 1 m is taken"));
    CHECK_FALSE(says(runTss(make + " --meters-per-unit 0.0254", folder.path()), "a.amf says"));
    CHECK(says(runTss("make -o s.tss --body a.amf", folder.path()), "a.amf says that one of its units"));
    CHECK(says(runTss("convert a.amf c.tss", folder.path()), "a.amf says that one of its units"));
    // A robot's own scale is its word on the unit.
    const auto urdf = [&](const std::string& scale) {
        writeText(folder.path() / "r.urdf",
                  "<robot name=\"r\"><link name=\"a\"><collision><geometry><mesh filename=\"a.amf\"" + scale +
                      "/></geometry></collision></link></robot>");
        return runTss("make r.urdf -o r.tss", folder.path());
    };
    CHECK(says(urdf(""), "a.amf says that one of its units"));
    CHECK_FALSE(says(urdf(" scale=\"0.0254 0.0254 0.0254\""), "a.amf says that one of its units"));
}

TEST_CASE("which way is up is what two files say together, and nothing is turned") {
    const Folder folder;
    for (const char up : {'Y', 'Z'})
        writeText(folder.path() / (std::string(1, up) + ".dae"), tss::test::tetrahedronCollada(up));
    const auto make = [&](const std::string& a, const std::string& b) {
        return runTss("make -o s.tss --a " + a + ".dae --b " + b + ".dae" + aside, folder.path());
    };
    REQUIRE(make("Y", "Y").exit == 0);
    CHECK(tss::loadScene(folder / "s.tss").upAxis == 'Y');
    REQUIRE(make("Z", "Z").exit == 0);
    CHECK(tss::loadScene(folder / "s.tss").upAxis == 'Z');
    CHECK(says(make("Y", "Z"), "note: Y.dae says that Y is up, and Z.dae that Z is; nothing is turned"));
    for (const tss::Body& body : tss::loadScene(folder / "s.tss").bodies)
        CHECK(tss::bounds(body.mesh).sizes().isApprox(tss::Vec3(1, 2, 3)));
    REQUIRE(runTss("convert Y.dae c.tss", folder.path()).exit == 0);
    CHECK(tss::loadScene(folder / "c.tss").upAxis == 'Y');
}

TEST_CASE("an option that does nothing for the files at hand is refused") {
    const Folder folder;
    REQUIRE(runTss(twoBoxes(folder), folder.path()).exit == 0);
    for (const char* idle : {"convert s.tss s.usda --binary", "convert s.tss s.usda --buffers",
                             "convert s.tss t.tss --meters-per-unit 2", "convert s.tss t.tss --tolerance 1mm",
                             "convert s.tss s.srdf --binary", "convert a.obj a.tss --filtered-pairs"}) {
        INFO(idle);
        const Ran ran = runTss(idle, folder.path());
        CHECK(ran.exit == 2);
        CHECK(ran.err.find("it does nothing here") != std::string::npos);
    }
    CHECK(runTss("convert s.tss t.tss --binary", folder.path()).exit == 0);
    CHECK(runTss("convert s.tss s.tss", folder.path()).exit == 1); // would replace what is read
}

TEST_CASE("what is known of pairs is not asked of a body without a triangle") {
    const Folder folder;
    const std::string scene = OSGTSS_SOURCE_DIR "/scenes/extreme/mesh_one_vertex.tss";
    for (const char* to : {"o.srdf", "o.usda --filtered-pairs"}) {
        const Ran ran = runTss("convert " + scene + " " + to, folder.path());
        CHECK(ran.exit == 1);
        CHECK(ran.err.find("expected a mesh, the body has none") != std::string::npos);
    }
}

TEST_CASE("spheres for cuRobo hold each link's surface, in metres") {
    const Folder folder;
    REQUIRE(runTss(twoBoxes(folder), folder.path()).exit == 0);
    const Ran ran = runTss("convert s.tss s.yml --tolerance 2cm", folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    std::istringstream lines(readText(folder.path() / "s.yml"));
    std::vector<tss::Sphere> spheres;
    int links = 0;
    for (std::string line; std::getline(lines, line);) {
        tss::Sphere sphere;
        if (line.starts_with("  \"")) ++links;
        if (std::sscanf(line.c_str(), "    - \"center\": [%lf, %lf, %lf]", &sphere.centre.x(),
                        &sphere.centre.y(), &sphere.centre.z()) == 3 &&
            links == 1)
            spheres.push_back(sphere);
        if (links == 1 && !spheres.empty())
            std::sscanf(line.c_str(), "      \"radius\": %lf", &spheres.back().radius);
    }
    CHECK(links == 2);
    REQUIRE(spheres.size() > 4);
    // The first link is a cube of 20 cm: points of its surface are inside, and nothing is 2 cm out of it.
    for (int i = 0; i <= 20; ++i)
        for (int j = 0; j <= 20; ++j)
            for (int axis = 0; axis < 3; ++axis)
                for (double side : {-0.1, 0.1}) {
                    tss::Vec3 point;
                    point[axis] = side;
                    point[(axis + 1) % 3] = -0.1 + 0.01 * i;
                    point[(axis + 2) % 3] = -0.1 + 0.01 * j;
                    double least = 1;
                    for (const tss::Sphere& s : spheres)
                        least = std::min(least, (point - s.centre).norm() - s.radius);
                    CHECK(least <= 1e-9);
                }
    for (const tss::Sphere& s : spheres)
        CHECK((s.centre.cwiseAbs().array() + s.radius).maxCoeff() < 0.1 + 0.02);
}

TEST_CASE("a motion of one's own is the scene's, by the names of its joints") {
    const Folder folder;
    const std::string make = twoBoxes(folder);
    writeText(folder.path() / "m.csv", "time,Joint\n0,0\n0.5,60\n2,10\n");
    const Ran ran = runTss(make + " --motion m.csv", folder.path());
    INFO(ran.err);
    REQUIRE(ran.exit == 0);
    const tss::SceneModel scene = tss::loadScene(folder / "s.tss");
    CHECK(scene.endTimeCode == 48);
    REQUIRE(scene.joints[0].drives[0].times == std::vector<double>{0, 12, 48});
    CHECK(scene.joints[0].drives[0].values[1] == Approx(60 * 3.14159265358979 / 180));
    writeText(folder.path() / "m.csv", "time,Jiont\n0,0\n");
    const Ran misspelt = runTss(make + " --motion m.csv", folder.path());
    CHECK(misspelt.exit == 1);
    CHECK(misspelt.err.find("no joint or muscle is called \"Jiont\"; expected some of rot") !=
          std::string::npos);
    writeText(folder.path() / "m.csv", "step,Joint\n0,0\n0,1\n");
    CHECK(runTss(make + " --motion m.csv", folder.path()).err.find("times that rise") != std::string::npos);
}
