#include "bake/model/Kinematics.h"
#include "tests/usd/Stages.h"

#include <algorithm>
#include <numbers>
#include <random>

using namespace tss;

TEST_CASE("rigid bodies with colliders below them and a hinge are a scene with a pair") {
    const RobotScene made = robotScene(twoBoxes(hinge));
    const SceneModel& scene = made.scene;
    CHECK(scene.metersPerUnit == 0.01);
    CHECK(scene.upAxis == 'Z');
    REQUIRE(scene.joints.size() == 1);
    REQUIRE(scene.pairs.size() == 1);
    CHECK(scene.joints[0].path == "/R/j");
    CHECK(bodyCalled(scene, "b").placement.translation().isApprox(Vec3(4, 0, 0)));
    CHECK(bounds(bodyCalled(scene, "b").mesh).max().isApprox(Vec3(1, 1, 1)));
    const Motion motion = pairMotion(scene, scene.pairs[0]);
    REQUIRE(motion.dofCount() == 1);
    CHECK(motion.dofs[0].lower == Approx(-30 * std::numbers::pi / 180));
    CHECK(motion.dofs[0].upper == Approx(90 * std::numbers::pi / 180));
    const double quarter[] = {std::numbers::pi / 2};
    const bool fromA = scene.bodies[scene.pairs[0].bodyA].path == "/R/a";
    const Pose turned = fromA ? pose(motion, quarter) : Pose(pose(motion, quarter).inverse());
    CHECK((turned * Vec3(0, 0, 0)).isApprox(Vec3(2, 2, 0), 1e-6));
}

TEST_CASE("a joint that names its bodies the other way round, and one to the world, move as they should") {
    std::string reversed = hinge;
    reversed.replace(reversed.find("body0"), 5, "bodyX").replace(reversed.find("body1"), 5, "body0");
    reversed.replace(reversed.find("bodyX"), 5, "body1");
    reversed.replace(reversed.find("localPos0 = (2"), 14, "localPos0 = (-2");
    reversed.replace(reversed.find("localPos1 = (-2"), 15, "localPos1 = (2");
    const std::string fixed = "def PhysicsFixedJoint \"f\" { rel physics:body1 = </R/a> }\n";
    const SceneModel scene = robotScene(twoBoxes(reversed + fixed)).scene;
    REQUIRE(scene.joints.size() == 2);
    REQUIRE(scene.pairs.size() == 1);
    // +30 of the file turns a by 30 about b, that is b by -30 about a.
    const Motion motion = pairMotion(scene, scene.pairs[0]);
    const double q[] = {std::numbers::pi / 2};
    const bool fromA = scene.bodies[scene.pairs[0].bodyA].path == "/R/a";
    const Pose turned = fromA ? pose(motion, q) : Pose(pose(motion, q).inverse());
    CHECK((turned * Vec3(0, 0, 0)).isApprox(Vec3(2, -2, 0), 1e-6));
}

TEST_CASE("every kind of shape becomes a mesh that encloses it, where its transforms put it") {
    const auto sizes = [](const std::string& prim) {
        const SceneModel scene =
            robotScene("def Xform \"R\" ( prepend apiSchemas = [\"PhysicsRigidBodyAPI\"] ) { " + prim + " }")
                .scene;
        return bounds(scene.bodies.at(0).mesh);
    };
    const auto near = [](const Eigen::AlignedBox3d& box, const Vec3& min, const Vec3& max) {
        return (box.min() - min).cwiseAbs().maxCoeff() < 0.02 &&
               (box.max() - max).cwiseAbs().maxCoeff() < 0.02;
    };
    CHECK(near(sizes("def Cube \"c\" { double size = 3 }"), Vec3::Constant(-1.5), Vec3::Constant(1.5)));
    CHECK(near(sizes("def Sphere \"c\" {}"), Vec3::Constant(-1), Vec3::Constant(1)));
    CHECK(near(sizes("def Capsule \"c\" { uniform token axis = \"X\" }"), {-1, -0.5, -0.5}, {1, 0.5, 0.5}));
    CHECK(near(sizes("def Cylinder \"c\" { uniform token axis = \"Y\"\n double height = 4 }"), {-1, -2, -1},
               {1, 2, 1}));
    CHECK(near(sizes("def Cone \"c\" {}"), {-1, -1, -1}, {1, 1, 1}));
    CHECK(near(sizes("def Cube \"c\" { double3 xformOp:translate = (1, 0, 0)\n float3 xformOp:scale = (2, 1, "
                     "1)\n float xformOp:rotateZ = 90\n"
                     "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateZ\", "
                     "\"xformOp:scale\"] }"),
               {0, -2, -1}, {2, 2, 1}));
    CHECK(near(sizes("def Cube \"c\" { double3 xformOp:translate = (1, 0, 0)\nuniform token[] xformOpOrder = "
                     "[\"!invert!xformOp:translate\"] }"),
               {-2, -1, -1}, {0, 1, 1}));
}

TEST_CASE("types of old, operations without a property and meshes that are none do not stop the rest") {
    const std::string square = "point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]\n"
                               "int[] faceVertexCounts = [4]\n";
    const RobotScene made = robotScene(
        "def Mesh \"old\" { " + square +
        "PointIndex[] faceVertexIndices = [0, 1, 2, 3]\n"
        "point3f xformOp:translate = (2, 0, 0)\n uniform token[] xformOpOrder = [\"xformOp:translate\", "
        "\"xformOp:rotateX\", \"!invert!xformOp:gone\"] }\n"
        "def Mesh \"bad\" { " +
        square +
        "int[] faceVertexIndices = [0, 1, 2] }\n"
        "def Mesh \"odd\" { point3f[] points = [(0, 0, inf)]\nint[] faceVertexCounts = [1]\nint[] "
        "faceVertexIndices = [0] }");
    CHECK(bounds(bodyCalled(made.scene, "old").mesh).max() == Vec3(1, 1, 0));
    CHECK(bodyCalled(made.scene, "old").placement.translation() == Vec3(2, 0, 0));
    CHECK(bodyCalled(made.scene, "bad").mesh.empty());
    CHECK(
        hasNote(made.notes, "left out: root.usda: /bad (<link bad>): faceVertexIndices: expected 4 indices"));
    CHECK(hasNote(made.notes, "left out: root.usda: /odd (<link odd>): points: expected a finite number"));
    CHECK(hasNote(made.notes, "operations of which there is no property: /old.xformOp:rotateX"));
}

TEST_CASE("the tip of a cone is up along its axis, and a mirrored shape stays outward") {
    const auto only = [](const std::string& prim) {
        return robotScene("def Xform \"R\" ( prepend apiSchemas = [\"PhysicsRigidBodyAPI\"] ) { " + prim +
                          " }")
            .scene.bodies.at(0)
            .mesh;
    };
    const TriangleMesh cone = only("def Cone \"c\" { uniform token axis = \"X\" }");
    int tips = 0;
    for (const Vec3& v : cone.vertices) tips += (v - Vec3(1, 0, 0)).norm() < 1e-9;
    CHECK(tips == 1);
    const TriangleMesh mirrored = only("def Cube \"c\" { float3 xformOp:scale = (-1, 1, 1)\nuniform token[] "
                                       "xformOpOrder = [\"xformOp:scale\"] }");
    double volume = 0;
    for (std::size_t t = 0; t < mirrored.triangles.size(); ++t)
        volume += mirrored.corner(t, 0).dot(mirrored.corner(t, 1).cross(mirrored.corner(t, 2))) / 6;
    CHECK(volume == Approx(8));
}

TEST_CASE("D6, spherical and prismatic joints keep their limits, and what ties nothing is left out by name") {
    const std::string ends = "rel physics:body0 = </R/a>\nrel physics:body1 = </R/b>\n";
    const auto locked = [](const char* dof) {
        return std::string("float limit:") + dof + ":physics:low = 1\nfloat limit:" + dof +
               ":physics:high = -1\n";
    };
    const RobotScene d6 = robotScene(twoBoxes(
        "def PhysicsJoint \"j\" ( prepend apiSchemas = [\"PhysicsLimitAPI:transX\", "
        "\"PhysicsLimitAPI:transY\", \"PhysicsLimitAPI:transZ\", \"PhysicsLimitAPI:rotX\"] ) {" +
        ends + locked("transX") + locked("transY") +
        "float limit:transZ:physics:low = -1\nfloat limit:transZ:physics:high = 2\n" + locked("rotX") + "}"));
    REQUIRE(d6.scene.pairs.size() == 1);
    CHECK(pairMotion(d6.scene, d6.scene.pairs[0]).dofCount() == 3);
    CHECK(hasNote(d6.notes, "turn once round"));
    const RobotScene ball =
        robotScene(twoBoxes("def PhysicsSphericalJoint \"j\" {" + ends +
                            "float physics:coneAngle0Limit = 20\nfloat physics:coneAngle1Limit = 30 }"));
    CHECK(pairMotion(ball.scene, ball.scene.pairs.at(0)).dofCount() == 3);
    const RobotScene slide = robotScene(twoBoxes("def PhysicsPrismaticJoint \"j\" {" + ends + "}"));
    CHECK(slide.scene.joints.empty());
    CHECK(hasNote(slide.notes, "slide without limits, which tie nothing: /R/j"));
    const RobotScene rope = robotScene(twoBoxes("def PhysicsDistanceJoint \"j\" {" + ends + "}"));
    CHECK(hasNote(rope.notes, "PhysicsDistanceJoints, which tie nothing here: /R/j"));
}

TEST_CASE("the box of a cone of limits holds it, however the body is twisted") {
    const double degree = std::numbers::pi / 180;
    const auto ball = [](const std::string& axis, int cone0, int cone1) {
        const SceneModel scene =
            robotScene(twoBoxes("def PhysicsSphericalJoint \"j\" {\nrel physics:body0 = </R/a>\n"
                                "rel physics:body1 = </R/b>\nuniform token physics:axis = \"" +
                                axis + "\"\nfloat physics:coneAngle0Limit = " + std::to_string(cone0) +
                                "\nfloat physics:coneAngle1Limit = " + std::to_string(cone1) + " }"))
                .scene;
        return scene.joints.at(0).dofs;
    };
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(-1, 1);
    for (int axis : {0, 1, 2}) {
        const auto dofs = ball(std::string(1, "XYZ"[axis]), 62, 10);
        const Vec3 along = Vec3::Unit(axis), first = Vec3::Unit((axis + 1) % 3),
                   second = Vec3::Unit((axis + 2) % 3);
        for (int k = 0; k < 300; ++k) {
            // Swung about either axis or both, either first, and twisted.
            const Eigen::AngleAxisd one(62 * degree * share(random), first),
                two(10 * degree * share(random), second), twist(180 * degree * share(random), along);
            for (const Eigen::Matrix3d& turn : {Eigen::Matrix3d((one * twist).toRotationMatrix()),
                                                Eigen::Matrix3d((two * twist).toRotationMatrix())}) {
                const double x = std::atan2(-turn(1, 2), turn(2, 2)),
                             y = std::asin(std::clamp(turn(0, 2), -1.0, 1.0)),
                             z = std::atan2(-turn(0, 1), turn(0, 0));
                const auto within = [&](double a, double b, double c) {
                    const double q[] = {a, b, c};
                    for (int d = 0; d < 3; ++d) {
                        const double value = std::remainder(q[d], 360 * degree);
                        if (value < dofs[d].lower - 1e-6 || value > dofs[d].upper + 1e-6) return false;
                    }
                    return true;
                };
                CHECK((within(x, y, z) || within(x + 180 * degree, 180 * degree - y, z + 180 * degree)));
            }
        }
    }
    CHECK(ball("X", 30, 20)[1].upper == Approx(30 * degree).epsilon(1e-6));
    CHECK(ball("X", 120, 20)[1].upper == Approx(180 * degree));
}

TEST_CASE("of a body with a shape that cannot be had nothing is made; what a group holds collides") {
    const auto widthOf = [](const std::string& second) {
        return bounds(bodyCalled(robotScene(twoBoxes(hinge, second)).scene, "b").mesh).sizes().maxCoeff();
    };
    const std::string api = "( prepend apiSchemas = [\"PhysicsCollisionAPI\"] ) ";
    CHECK(widthOf("") == Approx(2));
    const auto empty = [](const std::string& second) {
        return bodyCalled(robotScene(twoBoxes(hinge, second)).scene, "b").mesh.empty();
    };
    CHECK(empty("def PointInstancer \"p\" " + api + "{ def Cube \"proto\" {} }"));
    CHECK(empty("def PointInstancer \"p\" { def Cube \"proto\" " + api + "{} }"));
    CHECK(empty("def PointInstancer \"p\" { rel prototypes = </R/b/x> }\ndef Cube \"x\" " + api + "{}"));
    CHECK_FALSE(empty("def PointInstancer \"p\" { def Cube \"proto\" {} }"));
    CHECK(empty("def NurbsPatch \"p\" " + api + "{}"));
    CHECK(empty("def Hull \"p\" " + api + "{}")); // whatever that is
    CHECK(empty("def Capsule_1 \"p\" " + api + "{ double radiusTop = 1\ndouble radiusBottom = 2 }"));
    CHECK_FALSE(empty("def BasisCurves \"p\" {}"));
    CHECK_FALSE(empty("def SphereLight \"p\" {}"));
    CHECK(widthOf("def Capsule_1 \"p\" " + api +
                  "{ double height = 6\ndouble radiusTop = 0.5\ndouble radiusBottom = 0.5 }") ==
          Approx(7).epsilon(0.01));
    CHECK(widthOf("def Cylinder_1 \"p\" " + api + "{ double height = 6 }") == Approx(6).epsilon(0.01));
    CHECK(widthOf("def Xform \"g\" " + api + "{ def Cube \"big\" { double size = 8 } }") == Approx(8));
    CHECK(widthOf("def Xform \"g\" { def Cube \"big\" { double size = 8 } }") == Approx(2)); // a visual
}

TEST_CASE("a joint that closes a loop is left out, the one outside of the articulation first") {
    const std::string second = R"usda(
    def PhysicsRevoluteJoint "first" {
        rel physics:body0 = </R/a>
        rel physics:body1 = </R/b>
        uniform bool physics:excludeFromArticulation = 1
        float physics:lowerLimit = 0
        float physics:upperLimit = 1
    })usda";
    const RobotScene made = robotScene(twoBoxes(second + hinge));
    REQUIRE(made.scene.joints.size() == 1);
    CHECK(made.scene.joints[0].path == "/R/j");
    CHECK(hasNote(made.notes, "close a loop"));
    CHECK(hasNote(made.notes, "/R/first"));
}

TEST_CASE("several joints of the same two bodies are one with the values of all, one after the other") {
    const auto turn = [](const char* name, const char* axis, const char* ends, int upper) {
        return std::string("def PhysicsRevoluteJoint \"") + name + "\" {\nuniform token physics:axis = \"" +
               axis + "\"\n" + ends +
               "float physics:lowerLimit = -10\nfloat physics:upperLimit = " + std::to_string(upper) +
               "\n}\n";
    };
    const char *const forth =
                          "rel physics:body0 = </R/a>\nrel physics:body1 = </R/b>\n"
                          "point3f physics:localPos0 = (2, 0, 0)\npoint3f physics:localPos1 = (-2, 0, 0)\n",
                      *const back =
                          "rel physics:body0 = </R/b>\nrel physics:body1 = </R/a>\n"
                          "point3f physics:localPos0 = (-2, 0, 0)\npoint3f physics:localPos1 = (2, 0, 0)\n",
                      *const elsewhere = "rel physics:body0 = </R/a>\nrel physics:body1 = </R/b>\n";
    const RobotScene made =
        robotScene(twoBoxes(turn("yaw", "Z", forth, 40) + turn("pitch", "Y", back, 50) +
                            turn("hingeToo", "Z", forth, 20) + turn("apart", "X", elsewhere, 30)));
    CHECK(hasNote(made.notes, "taken one after the other: b_joint (yaw, pitch)"));
    CHECK(hasNote(made.notes, "close a loop"));
    CHECK(hasNote(made.notes, "/R/hingeToo, /R/apart")); // moves alike; at 0 elsewhere
    REQUIRE(made.scene.pairs.size() == 1);
    const Motion motion = pairMotion(made.scene, made.scene.pairs[0]);
    REQUIRE(motion.dofCount() == 2);
    const double degree = std::numbers::pi / 180, q[] = {40 * degree, 30 * degree};
    CHECK(motion.dofs[0].upper == Approx(40 * degree));
    CHECK(motion.dofs[1].upper == Approx(50 * degree));
    const Pose expected = Eigen::Translation3d(2, 0, 0) * Eigen::AngleAxisd(q[0], Vec3::UnitZ()) *
                          Eigen::AngleAxisd(-q[1], Vec3::UnitY()) * Eigen::Translation3d(2, 0, 0);
    CHECK(pose(motion, q).isApprox(expected, 1e-6)); // pitch turns a about b
}

TEST_CASE("a joint of one value rests where the stage shows its bodies, if its limits let it") {
    const std::string ends = "rel physics:body0 = </R/a>\nrel physics:body1 = </R/b>\n"
                             "point3f physics:localPos0 = (4, 0, 0)\n";
    const auto slide = [&](const char* at, int upper) { // b is shown at x = 4
        return robotScene(twoBoxes("def PhysicsPrismaticJoint \"j\" {\nuniform token physics:axis = \"X\"\n"
                                   "rel physics:body0 = </R/a>\nrel physics:body1 = </R/b>\n"
                                   "float physics:lowerLimit = -1\nfloat physics:upperLimit = " +
                                   std::to_string(upper) + "\n" + at + "}\n"));
    };
    const RobotScene moved = slide("", 9);
    CHECK(moved.scene.joints.at(0).dofs.at(0).rest == Approx(4));
    CHECK(!hasNote(moved.notes, "shows elsewhere"));
    const RobotScene beyond = slide("", 3);
    CHECK(beyond.scene.joints.at(0).dofs.at(0).rest == 0);
    CHECK(hasNote(beyond.notes, "shows elsewhere"));
    const RobotScene beside = slide("point3f physics:localPos0 = (0, 1, 0)\n", 9);
    CHECK(beside.scene.joints.at(0).dofs.at(0).rest == 0);
    CHECK(hasNote(beside.notes, "shows elsewhere"));

    std::string turned =
        twoBoxes("def PhysicsRevoluteJoint \"j\" {\nuniform token physics:axis = \"Z\"\n" + ends +
                 "float physics:lowerLimit = 300\nfloat physics:upperLimit = 420\n}\n");
    turned.replace(turned.find("[\"xformOp:translate\"]"), 21,
                   "[\"xformOp:translate\", \"xformOp:rotateZ\"]\nfloat xformOp:rotateZ = 30");
    const SceneModel scene = robotScene(turned).scene;
    CHECK(scene.joints.at(0).dofs.at(0).rest == Approx(390 * std::numbers::pi / 180).epsilon(1e-6));
    const Vec3 corner = bodyCalled(scene, "b").placement * Vec3(1, 0, 0);
    CHECK(corner.isApprox(Vec3(4 + std::sqrt(0.75), 0.5, 0), 1e-6));
}

TEST_CASE("scenery is one body of the world, and filtered pairs are none") {
    const std::string ground =
        "def Cube \"ground\" ( prepend apiSchemas = [\"PhysicsCollisionAPI\"] ) {}\n"
        "def PhysicsFixedJoint \"f\" { rel physics:body0 = </R/a> }\n"
        "def Material \"M\" {}\ndef Plane \"P\" ( prepend apiSchemas = [\"PhysicsCollisionAPI\"] ) {}\n";
    const RobotScene made = robotScene(twoBoxes(hinge + ground));
    CHECK(bodyCalled(made.scene, "world").mesh.triangles.size() == 12);
    CHECK(made.scene.pairs.size() == 2); // of b with a and the world; a and the world stand still
    CHECK(hasNote(made.notes, "left out: prims of other types: Material (/R/M)"));
    CHECK(hasNote(made.notes, "left out: colliders of type Plane: /R/P"));
    std::string filtered = twoBoxes(hinge);
    filtered.replace(filtered.find("\"PhysicsRigidBodyAPI\"]"), 22,
                     "\"PhysicsRigidBodyAPI\", \"PhysicsFilteredPairsAPI\"]");
    filtered.insert(filtered.find("def Cube"), "rel physics:filteredPairs = </R/b>\n");
    CHECK(robotScene(filtered).scene.pairs.empty());
}

TEST_CASE("the motion that a file drives its joints by is kept") {
    std::string driven = hinge;
    driven.insert(driven.find("float physics:lower"),
                  "float drive:angular:physics:targetPosition.timeSamples = { 0: 0, 10: 45 }\n");
    std::string text = twoBoxes(driven);
    text.replace(text.find("upAxis"), 0, "endTimeCode = 10\n ");
    const SceneModel scene = robotScene(text).scene;
    CHECK(scene.endTimeCode == 10);
    REQUIRE(scene.joints.at(0).drives.at(0).values.size() == 2);
    CHECK(scene.joints[0].drives[0].values[1] == Approx(std::numbers::pi / 4));
}

namespace {

/// A cube at x = 4 k that hangs on a by a joint of its own: "turns" or "slides".
std::string follower(int k, const std::string& type, const std::string& said) {
    const std::string name = std::string(1, static_cast<char>('a' + k));
    return "def Cube \"" + name +
           "\" ( prepend apiSchemas = [\"PhysicsRigidBodyAPI\", "
           "\"PhysicsCollisionAPI\"] ) {\ndouble3 xformOp:translate = (" +
           std::to_string(4 * k) + ", 0, 0)\nuniform token[] xformOpOrder = [\"xformOp:translate\"]\ndef " +
           type + " \"j\" " + said + "rel physics:body0 = </R/a>\nrel physics:body1 = </R/" + name +
           ">\npoint3f physics:localPos0 = (" + std::to_string(4 * k) +
           ", 0, 0)\nuniform token physics:axis = \"Z\"\n"
           "float physics:lowerLimit = -5\nfloat physics:upperLimit = 5 } }\n";
}

} // namespace

TEST_CASE("a joint that mimics another follows it in the scene's motion, as far as that one leads it") {
    const std::string physx = "( prepend apiSchemas = [\"PhysxMimicJointAPI:rotZ\"] ) {\n"
                              "rel physxMimicJoint:rotZ:referenceJoint = </R/j>\n",
                      newton =
                          "( prepend apiSchemas = [\"NewtonMimicAPI\"] ) {\nrel newton:mimicJoint = </R/j>\n";
    const RobotScene made =
        robotScene(twoBoxes(hinge +
                            follower(2, "PhysicsRevoluteJoint",
                                     physx + "float physxMimicJoint:rotZ:gearing = 0.5\n"
                                             "double physxMimicJoint:rotZ:offset = 10\n") +
                            follower(3, "PhysicsPrismaticJoint", newton + "float newton:mimicCoef1 = 0.1\n") +
                            follower(4, "PhysicsRevoluteJoint", newton + "bool newton:mimicEnabled = 0\n")));
    const double degree = std::numbers::pi / 180;
    const auto jointOf = [&](const char* body) -> const Joint& {
        return *std::ranges::find_if(made.scene.joints, [&](const Joint& joint) {
            return made.scene.bodies[joint.body1].path == std::string("/R/") + body;
        });
    };
    const Joint &leader = jointOf("b"), &turns = jointOf("c"), &slides = jointOf("d"), &alone = jointOf("e");
    CHECK(turns.dofs.at(0).lower == Approx(-55 * degree)); // led by -30 to 90
    CHECK(turns.dofs.at(0).upper == Approx(5 * degree));
    CHECK(slides.dofs.at(0).lower == Approx(-3));
    CHECK(slides.dofs.at(0).upper == Approx(9));
    CHECK(alone.dofs.at(0).upper == Approx(5 * degree));
    REQUIRE(turns.drives.at(0).values.size() == leader.drives.at(0).values.size());
    for (std::size_t k = 0; k < leader.drives[0].values.size(); ++k) {
        const double value = leader.drives[0].values[k];
        CHECK(turns.drives[0].values[k] == Approx(-0.5 * value - 10 * degree));
        CHECK(slides.drives.at(0).values[k] == Approx(0.1 * value / degree));
    }
    CHECK(made.scene.endTimeCode == 2 * 48); // of two joints, one after the other
    CHECK(hasNote(made.notes, "joint c_j mimics j, which leads it from -55 to 5 degrees"));
}

TEST_CASE("a joint to the world ties its body where the stage shows it") {
    std::string moved =
        twoBoxes(std::string(hinge) + "def PhysicsFixedJoint \"f\" { rel physics:body1 = </R/a> }\n");
    moved.insert(
        moved.find("def Xform \"a\""),
        "double3 xformOp:translate = (0, 0, 7)\nuniform token[] xformOpOrder = [\"xformOp:translate\"]\n");
    const RobotScene made = robotScene(moved);
    CHECK(bodyCalled(made.scene, "a").placement.translation() == Vec3(0, 0, 7));
    CHECK(bodyCalled(made.scene, "b").placement.translation().isApprox(Vec3(4, 0, 7)));
    CHECK(hasNote(made.notes, "taken where it shows it: /R/f"));
    CHECK_FALSE(hasNote(made.notes, "shows elsewhere"));
}

TEST_CASE("where the scenery collides, what a joint ties to the world moves, and the world does not") {
    const RobotScene made =
        robotScene("def Cube \"rail\" ( prepend apiSchemas = [\"PhysicsCollisionAPI\"] ) {}\n"
                   "def Xform \"cart\" ( prepend apiSchemas = [\"PhysicsRigidBodyAPI\"] ) {\n"
                   "def Sphere \"c\" ( prepend apiSchemas = [\"PhysicsCollisionAPI\"] ) {} }\n"
                   "def PhysicsPrismaticJoint \"slider\" { rel physics:body1 = </cart>\n"
                   "float physics:lowerLimit = -1\nfloat physics:upperLimit = 1 }");
    REQUIRE(made.scene.joints.size() == 1);
    CHECK(made.scene.bodies.at(made.scene.joints[0].body0).path == "/rail/world");
    CHECK_FALSE(hasNote(made.notes, "free bodies"));
}

TEST_CASE("a stage without physics is a body a mesh, each where it stands") {
    const SceneModel scene =
        robotScene("def Xform \"W\" { def Cube \"a\" {} def Sphere \"b\" { double3 xformOp:translate = (5, "
                   "0, 0)\nuniform token[] xformOpOrder = [\"xformOp:translate\"] } }")
            .scene;
    REQUIRE(scene.bodies.size() == 2);
    CHECK(bodyCalled(scene, "b").placement.translation() == Vec3(5, 0, 0));
}
