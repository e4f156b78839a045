#include "bake/robot/MeshFiles.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/robot/ReadMsh.h"
#include "bake/robot/ReadRobot.h"
#include "tests/robot/Robots.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <unistd.h>

using namespace tss;
namespace fs = std::filesystem;

namespace {

/// A folder with files, removed with the object.
class Tree {
public:
    Tree() {
        std::string pattern = (fs::temp_directory_path() / "tss-robot-XXXXXX").string();
        REQUIRE(mkdtemp(pattern.data()));
        root = fs::canonical(pattern);
    }
    ~Tree() {
        std::error_code none;
        fs::remove_all(root, none);
    }
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;
    std::string write(const std::string& name, const std::string& text = "x") const {
        fs::create_directories((root / name).parent_path());
        std::ofstream(root / name) << text;
        return (root / name).string();
    }
    fs::path root;
};

} // namespace

TEST_CASE("the reference of a mesh counts before its scale") {
    const Tree tree;
    const std::string file = tree.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n"
                                                 "f 2 3 4\nf 1 4 3\n");
    Robot robot;
    robot.name = "r";
    RobotLink link;
    link.name = "a";
    RobotShape shape;
    shape.file = file;
    shape.size = Vec3(0.1, 0.2, 0.3);
    shape.unscaled.rotate(Eigen::AngleAxisd(-std::acos(0.0), Vec3::UnitZ())).translate(Vec3(-1, 0, 0));
    link.collision = {shape};
    robot.links = {link};
    const RobotScene scene = sceneOf(robot, {}, [](const std::string& name) { return name; });
    const Eigen::AlignedBox3d box = bounds(scene.scene.bodies[0].mesh);
    CHECK((box.min() - Vec3(0, 0, 0)).norm() < 1e-9);
    CHECK((box.max() - Vec3(0.1, 0.2, 0.3)).norm() < 1e-9);
}

TEST_CASE("a mesh of a package is found upwards by folder, by package.xml, or where it was said to be") {
    const Tree tree;
    const std::string mesh = tree.write("my_arm/meshes/a.stl"), urdf = tree.write("my_arm/urdf/arm.urdf");
    CHECK(meshesOf(urdf, {})("package://my_arm/meshes/a.stl") == mesh);
    CHECK(meshesOf(urdf, {})("model://my_arm/meshes/a.stl") == mesh);
    CHECK(meshesOf(urdf, {})("package:///my_arm/meshes/a.stl") == mesh); // as Pinocchio takes it
    const std::string other = tree.write("my_hand/b.stl");
    CHECK(meshesOf(urdf, {})("package://my_hand/b.stl") == other); // beside the package

    tree.write("checkout/package.xml", "<package><name> renamed </name></package>");
    const std::string named = tree.write("checkout/c.stl"), inside = tree.write("checkout/deep/er/arm.urdf");
    CHECK(meshesOf(inside, {})("package://renamed/c.stl") == named);

    const Packages given = parsePackages({"elsewhere=" + (tree.root / "my_hand").string()});
    CHECK(meshesOf(inside, given)("package://elsewhere/b.stl") == other);
    CHECK(refusal([&] {
              meshesOf(inside, {})("package://elsewhere/b.stl");
          }).find("--package elsewhere=DIR") != std::string::npos);
    tree.write("copied/arm/meshes/a.stl");
    CHECK(refusal([&] {
              meshesOf(tree.write("copied/arm/urdf/a.urdf"), {})("package://elsewhere/meshes/a.stl");
          }).find("--package elsewhere=" + (tree.root / "copied/arm").string() + " where such a file is") !=
          std::string::npos);
    CHECK(refusal([&] { parsePackages({"nonsense"}); }).find("NAME=DIR") != std::string::npos);
    CHECK(refusal([&] { parsePackages({"a=/no/such/folder"}); }).find("no folder") != std::string::npos);
}

TEST_CASE("MuJoCo's binary mesh is read whole or refused for what is wrong with it") {
    const auto bytes = [](std::vector<std::int32_t> counts, std::vector<float> numbers,
                          std::vector<std::int32_t> corners) {
        std::string text;
        const auto add = [&](const auto& of) {
            text.append(reinterpret_cast<const char*>(of.data()), of.size() * 4);
        };
        add(counts), add(numbers), add(corners);
        return text;
    };
    // A tetrahedron with a normal and texture coordinates in between, and its first vertex once more.
    const std::vector<float> numbers = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, /**/ 0, 0, 1, /**/ 5, 6};
    const std::vector<std::int32_t> corners = {0, 2, 1, 0, 1, 3, 4, 3, 2, 1, 2, 3};
    const TriangleMesh mesh = readMsh(bytes({5, 1, 1, 4}, numbers, corners), "a.msh");
    CHECK(mesh.vertices.size() == 4);
    CHECK(mesh.triangles.size() == 4);
    CHECK(auditMesh(mesh).signedVolume == Approx(1.0 / 6));
    const auto refused = [&](const std::string& text, const std::string& words) {
        const std::string found = refusal([&] { readMsh(text, "a.msh"); });
        INFO(found);
        CHECK(found.find("a.msh") != std::string::npos);
        CHECK(found.find(words) != std::string::npos);
    };
    refused("", "16 bytes");
    refused(bytes({5, 1, 1, 4}, numbers, {0, 2, 1}), "bytes by its counts");
    refused(bytes({-1, 1, 1, 4}, numbers, corners), "counts of 0 or more");
    refused(bytes({2147483647, 2147483647, 2147483647, 2147483647}, {}, {}), "bytes by its counts");
    refused(bytes({5, 1, 1, 4}, numbers, {0, 2, 5, 0, 1, 3, 4, 3, 2, 1, 2, 3}), "face 0 names a vertex");
    refused(bytes({1, 0, 0, 0}, {0, 0, NAN}, {}), "finite coordinates at vertex 0");
    refused(bytes({0, 0, 0, 0}, {}, {}), "no triangle");
}

TEST_CASE("plain paths stay within the package or the parent of the file's folder, through links too") {
    const Tree tree;
    const std::string urdf = tree.write("robot/urdf/arm.urdf"), mesh = tree.write("robot/meshes/a.stl");
    const std::string secret = tree.write("secret.stl");
    const FindMesh find = meshesOf(urdf, {});
    CHECK(find("../meshes/a.stl") == mesh);
    CHECK(find("file://" + mesh) == mesh);
    CHECK(refusal([&] { find("../../secret.stl"); }).find("lies outside") != std::string::npos);
    CHECK(refusal([&] { find(secret); }).find("lies outside") != std::string::npos);
    const std::string beside = tree.write("robot/urdf/b.stl");
    CHECK(find("package://b.stl") == beside);                       // as onshape-to-robot writes it
    CHECK(find("file:///no/such/file.stl") == "/no/such/file.stl"); // its link has its other shapes
    CHECK(refusal([&] { find("package://robot/../secret.stl"); }).find("lies outside") != std::string::npos);
    CHECK(refusal([&] { find("package://../secret.stl"); }).find("package://NAME/PATH") != std::string::npos);
    CHECK(refusal([&] { find("http://example.org/a.stl"); }).find("no other place") != std::string::npos);
    CHECK(meshesOf(urdf, parsePackages({"gone="}))("package://gone/a.stl").empty());
    fs::create_symlink(secret, tree.root / "robot/meshes/link.stl");
    CHECK(refusal([&] { find("../meshes/link.stl"); }).find("lies outside") != std::string::npos);
    CHECK(meshesOf(urdf, parsePackages({"all=" + tree.root.string()}))("../../secret.stl") == secret);
}

TEST_CASE("plain paths stay within the checkout too, and may be those from its or the package's folder") {
    const Tree tree;
    const std::string urdf = tree.write("all/robots/assembly/both/both.urdf"),
                      mesh = tree.write("all/robots/arms/a.stl");
    CHECK(refusal([&] { meshesOf(urdf, {})("../../arms/a.stl"); })
              .find("lies outside of " + (tree.root / "all/robots/assembly").string() +
                    "; expected it within, or in the folder of a --package NAME=DIR, as --package all=" +
                    (tree.root / "all/robots").string()) != std::string::npos);
    tree.write("all/.git/HEAD");
    CHECK(meshesOf(urdf, {})("../../arms/a.stl") == mesh);
    CHECK(meshesOf(urdf, {})("robots/arms/a.stl") == mesh);
    tree.write("x");
    CHECK(refusal([&] { meshesOf(urdf, {})("../../../../x"); }).find("lies outside") != std::string::npos);
    const std::string packed = tree.write("all/pack/urdf/arm.urdf"),
                      own = tree.write("all/pack/meshes/b.stl");
    tree.write("all/pack/package.xml", "<package><name>p</name></package>");
    CHECK(meshesOf(packed, {})("meshes/b.stl") == own);
    CHECK(meshesOf(packed, {})("../../robots/arms/a.stl") == mesh);
    const std::string beside = tree.write("all/pack/urdf/meshes/b.stl");
    CHECK(meshesOf(packed, {})("meshes/b.stl") == beside);
}

#ifdef OSGTSS_HAVE_MJCF

TEST_CASE("a mesh without a name is called as its file, whichever way its path is written") {
    for (const std::string path : {"else/where/part.stl", "C:\\else\\part.stl"})
        for (const std::string type : {"mesh", "sdf"}) {
            const std::string text = "<mujoco><compiler strippath='true' meshdir='m'/><asset><mesh file='" +
                                     path + "'/></asset><worldbody><body><geom type='" + type +
                                     "' mesh='part'/></body></worldbody></mujoco>";
            const Robot robot = readMjcf(text, "arm.xml", [](const std::string&) { return ""; });
            CHECK(robot.links[0].collision[0].file == "m/part.stl");
            CHECK(hasNote(robot.notes, "sdf geoms, which are taken as the meshes") == (type == "sdf"));
        }
}

#endif
