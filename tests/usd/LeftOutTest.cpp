// What of a stage of UsdPhysics is left out or taken otherwise, by name.
#include "tests/usd/Stages.h"

using namespace tss;

TEST_CASE("a joint with limits the wrong way round is left out by name, and the rest comes in") {
    std::string reversed = hinge;
    reversed.replace(reversed.find("lowerLimit = -30"), 16, "lowerLimit = 120");
    const RobotScene made = robotScene(twoBoxes(reversed));
    CHECK(made.scene.bodies.size() == 2);
    CHECK(made.scene.joints.empty());
    CHECK(hasNote(made.notes, "a lower limit above their upper one, which tie nothing: /R/j"));
}

TEST_CASE("a joint that cannot be read is left out by name, and the rest comes in") {
    const auto note = [](const std::string& was, const std::string& is, const std::string& words) {
        std::string wrong = hinge;
        wrong.replace(wrong.find("\"j\""), 3, "\"wrong\"").replace(wrong.find(was), was.size(), is);
        const RobotScene made = robotScene(twoBoxes(wrong + hinge));
        CHECK(made.scene.bodies.size() == 2);
        REQUIRE(made.scene.joints.size() == 1);
        CHECK(made.scene.joints[0].path == "/R/j");
        INFO(words);
        CHECK(hasNote(made.notes, "joints that cannot be read, which tie nothing: /R/wrong (" + words));
    };
    note("token physics:axis = \"Z\"", "token physics:axis = \"W\"",
         "physics:axis: expected one of X, Y, Z, found \"W\")");
    note("token physics:axis = \"Z\"", "string physics:axis = \"Z\"", "physics:axis: expected type token");
    note("</R/b>", "</R/nobody>", "expected the paths of bodies that are there, found \"/R/nobody\")");
    note("</R/b>", "[</R/b>, </R/a>]", "physics:body1: expected one path, found 2)");
    note("rel physics:body1 = </R/b>", "string physics:body1 = \"/R/b\"", "physics:body1: expected a rel");
    note("upperLimit = 90", "upperLimit = nan", "physics:upperLimit: expected a number, found nan)");
    note("(2, 0, 0)", "(2, inf, 0)", "physics:localPos0: expected a finite number, found inf)");
    note("point3f physics:localPos0 = (2, 0, 0)", "double3 physics:localPos0 = (1e300, 0, 0)",
         "physics:localPos0: expected type point3f, found \"double3\")");
    note("uniform token physics:axis", "quatf physics:localRot0 = (0, 0, 0, 0)\nuniform token physics:axis",
         "physics:localRot0: expected a quaternion");
}

TEST_CASE("a body without a place costs its own shapes and joints, by name, and the rest comes in") {
    const std::string lost = R"usda(def Xform "lost" ( prepend apiSchemas = ["PhysicsRigidBodyAPI"] ) {
        double3 xformOp:translate = (0, nan, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        def Cube "c" ( prepend apiSchemas = ["PhysicsCollisionAPI"] ) {}
    }
    def PhysicsFixedJoint "toLost" { rel physics:body0 = </R/a>
        rel physics:body1 = </R/lost> })usda";
    const RobotScene made = robotScene(twoBoxes(hinge + lost));
    REQUIRE(made.scene.joints.size() == 1);
    CHECK(made.scene.joints[0].path == "/R/j");
    CHECK(made.scene.pairs.size() == 1);
    for (const Body& body : made.scene.bodies) CHECK(body.mesh.empty() == (body.path == "/R/lost"));
    CHECK(hasNote(made.notes,
                  "bodies without a place, of which neither shapes nor joints can be had: /R/lost "
                  "(/R/lost.xformOp:translate: expected a finite number, found nan)"));
    CHECK(hasNote(made.notes, "joints that cannot be read, which tie nothing: /R/toLost (/R/lost.xformOp"));
}

TEST_CASE("faces that are holes are surface, and it is said") {
    const auto square = [](const std::string& holes) {
        return robotScene("def Mesh \"m\" { uniform token subdivisionScheme = \"none\"\n" + holes +
                          "point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]\n"
                          "int[] faceVertexCounts = [3, 3]\nint[] faceVertexIndices = [0, 1, 2, 0, 2, 3] }");
    };
    const RobotScene made = square("int[] holeIndices = [1]\n");
    CHECK(made.scene.bodies.at(0).mesh.triangles.size() == 2);
    CHECK(hasNote(made.notes, "faces that are holes (holeIndices), taken as surface"));
    CHECK_FALSE(hasNote(square("int[] holeIndices = []\n").notes, "holeIndices"));
}

TEST_CASE("joints that time or somebody else changes tie nothing, by name") {
    std::string timed = hinge, moved = twoBoxes(hinge);
    timed.replace(timed.find("float physics:upperLimit = 90"), 29,
                  "float physics:upperLimit.timeSamples = { 0: 10, 24: 90 }");
    const RobotScene later = robotScene(twoBoxes(timed));
    CHECK(later.scene.joints.empty());
    CHECK(hasNote(later.notes, "change in time, which tie nothing here: /R/j"));
    for (const char* body : {"\"a\"", "\"b\""}) {
        const auto at = moved.find("{", moved.find(std::string("Xform ") + body));
        moved.insert(at + 1, "\nuniform bool physics:kinematicEnabled = 1\n");
        const RobotScene robot = robotScene(moved);
        const bool both = body == std::string("\"b\"");
        CHECK(robot.scene.joints.empty() == both); // where one is, the other is moved by the joint
        CHECK(hasNote(robot.notes, "kinematicEnabled), which tie nothing: /R/j") == both);
    }
}

TEST_CASE("a shape without a place costs its own body alone, and nothing where it is only seen") {
    const auto sizeOf = [](const std::string& shape) {
        const RobotScene made = robotScene(twoBoxes(hinge, shape));
        CHECK(made.scene.joints.size() == 1);
        const TriangleMesh& mesh = made.scene.bodies.at(1).mesh;
        CHECK(hasNote(made.notes, "/R/b/x.xformOp") == mesh.empty());
        return mesh.empty() ? 0 : bounds(mesh).sizes().x();
    };
    for (const std::string api : {"", "( prepend apiSchemas = [\"PhysicsCollisionAPI\"] )"}) {
        const double size = api.empty() ? 2 : 0;
        const std::string def = "def Xform \"x\" {\nuniform token[] xformOpOrder = ";
        const std::string below = "\ndef Cube \"y\" " + api + " {} }\n";
        CHECK(sizeOf(def + "[\"xformOp:scale\"]\nfloat3 xformOp:scale = (0, 0, 0)" + below) == size);
        CHECK(sizeOf(def + "[\"xformOp:translate\"]\ndouble3 xformOp:translate = (nan, 0, 0)" + below) ==
              size);
        CHECK(sizeOf(def +
                     "[\"xformOp:transform\"]\nmatrix4d xformOp:transform = ((1, 0, 0, 0), (0, 1, 0, 0), "
                     "(0, 0, 1, 2), (0, 0, 0, 1))" +
                     below) == size);
    }
    CHECK(hasNote(robotScene("def Cube \"a\" {}\ndef Cube \"b\" {\nfloat3 xformOp:scale = (1, 0, 1)\n"
                             "uniform token[] xformOpOrder = [\"xformOp:scale\"] }")
                      .notes,
                  "left out: meshes without a place: /b.xformOp:scale: expected scales that are not 0"));
}

TEST_CASE("a joint whose leader is not there moves by itself, and it is said") {
    const std::string api = "( prepend apiSchemas = [\"PhysxMimicJointAPI:rotZ\"] ) ";
    std::string coupled = hinge;
    coupled.insert(coupled.find('{'), api);
    coupled.insert(coupled.find("uniform"), "rel physxMimicJoint:rotZ:referenceJoint = </R/gone>\n");
    CHECK(hasNote(robotScene(twoBoxes(coupled)).notes,
                  "joint j (/R/j) mimics \"/R/gone\", which is no joint that turns or slides within limits: "
                  "it moves by itself"));
    const std::string ball = "def PhysicsSphericalJoint \"j\" " + api +
                             "{ rel physics:body0 = </R/a>\nrel physics:body1 = </R/b>\n"
                             "rel physxMimicJoint:rotZ:referenceJoint = </R/gone> }";
    CHECK(hasNote(robotScene(twoBoxes(ball)).notes,
                  "couplings (mimic) of joints of no value, or of several: /R/j"));
}

TEST_CASE("a stage without shapes is refused with what it has instead, and nothing is said of meshes") {
    CHECK_THROWS_WITH(robotScene("def Camera \"c\" {}"),
                      Catch::Contains("found none") &&
                          Catch::Contains("left out: prims of other types: Camera (/c)") &&
                          !Catch::Contains("each mesh"));
}

TEST_CASE("of a stage without physics it is said once that each mesh is a body") {
    const std::vector<std::string> notes = robotScene("def Cube \"a\" {}\ndef Cube \"b\" {}").notes;
    CHECK(hasNote(notes, "no rigid bodies and no colliders: each mesh is a body of its own"));
    CHECK_FALSE(hasNote(notes, "no collision geometry that can be had"));
}
