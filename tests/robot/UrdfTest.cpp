#ifdef OSGTSS_HAVE_URDF
#include "tests/robot/Urdf.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/robot/WritePairs.h"
#include "bake/scene/Layer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"

#include <numbers>

using namespace urdf;

TEST_CASE("a link's point is where the URDF says, at any value of its joints") {
    const RobotScene robot = madeOfUrdf(robotOf(
        aLink("base") + aLink("upper") + aLink("tool") +
        aJoint("shoulder", "revolute", "base", "upper",
               "<origin xyz='0.1 0.2 0.3' rpy='0.4 -0.5 0.6'/><axis xyz='1 2 -2'/>" + limits) +
        aJoint("slide", "prismatic", "upper", "tool", "<origin xyz='0 0 1'/><axis xyz='0 -3 0'/>" + limits)));
    const SceneModel& scene = robot.scene;
    REQUIRE(scene.joints.size() == 2);
    for (double angle : {-1.0, 0.0, 0.7, 2.0})
        for (double way : {-1.0, 0.25, 2.0}) {
            Pose upper = Pose::Identity(), tool = Pose::Identity();
            upper.translate(Vec3(0.1, 0.2, 0.3)); // fixed axes: roll, then pitch, then yaw
            upper.rotate(Eigen::AngleAxisd(0.6, Vec3::UnitZ()) * Eigen::AngleAxisd(-0.5, Vec3::UnitY()) *
                         Eigen::AngleAxisd(0.4, Vec3::UnitX()));
            upper.rotate(Eigen::AngleAxisd(angle, Vec3(1, 2, -2).normalized()));
            tool = upper * Eigen::Translation3d(0, -way, 1);
            const std::vector<double> values{angle, way};
            const std::vector<Pose> placed = posedBodies(scene, values);
            CHECK((placed[1].matrix() - upper.matrix()).norm() < 1e-12);
            CHECK((placed[2].matrix() - tool.matrix()).norm() < 1e-12);
        }
    CHECK(scene.joints[0].dofs[0].lower == -1);
    CHECK(scene.joints[1].dofs[0].upper == 2);
    CHECK(scene.pairs.size() == 3);
}

TEST_CASE("several shapes of a link are one body in the link's frame; visual ones stand in where there is no "
          "other") {
    const std::string shapes =
        "<collision><origin xyz='1 0 0'/><geometry><sphere radius='0.1'/></geometry></collision>"
        "<collision><origin xyz='0 0 2' rpy='0 1.5707963267948966 0'/>"
        "<geometry><cylinder radius='0.1' length='1'/></geometry></collision>"
        "<visual><geometry><box size='9 9 9'/></geometry></visual>";
    const std::string seen = "<visual><geometry><box size='1 1 1'/></geometry></visual>";
    const std::string text =
        robotOf(aLink("base", shapes) + aLink("eye", seen) + aLink("frame", "") +
                aJoint("a", "fixed", "base", "eye", "") + aJoint("b", "fixed", "eye", "frame", ""));
    const RobotScene robot = madeOfUrdf(text);
    const TriangleMesh& mesh = bodyCalled(robot.scene, "base").mesh;
    CHECK(auditMesh(mesh).components == 2);
    CHECK(auditMesh(mesh).watertight);
    CHECK((bounds(mesh).max() - Vec3(1.1, 0.1, 2.1)).norm() < 2e-3);
    CHECK((bounds(mesh).min() - Vec3(-0.5, -0.1, -0.1)).norm() < 2e-3);
    CHECK(hasNote(robot.notes, "no collision geometry that can be had, and their other one is taken: eye"));
    CHECK(robot.links[1].visual);
    CHECK(bodyCalled(robot.scene, "frame").mesh.empty());
    RobotSceneRequest visual;
    visual.visual = true;
    CHECK(bounds(bodyCalled(madeOfUrdf(text, visual).scene, "base").mesh).sizes().isApprox(Vec3(9, 9, 9)));
}

TEST_CASE(
    "fixed joints hold, continuous ones turn once round, floating and planar ones are left out by name") {
    const RobotScene robot =
        madeOfUrdf(robotOf(aLink("base") + aLink("a") + aLink("b") + aLink("c") + aLink("d") +
                           aJoint("hold", "fixed", "base", "a", "") +
                           aJoint("wheel", "continuous", "a", "b", "<axis xyz='0 0 1'/>") +
                           aJoint("swim", "floating", "base", "c", "") +
                           aJoint("stuck", "revolute", "base", "d", "<limit lower='0.5' upper='0.5'/>")));
    CHECK(jointCalled(robot.scene, "hold").dofs.empty());
    CHECK(jointCalled(robot.scene, "stuck").dofs.empty());
    const RobotScene odd = madeOfUrdf(
        robotOf(aLink("base") + aLink("a") +
                aJoint("hold", "fixed", "base", "a",
                       "<axis xyz='0 0 0'/><limit lower='' upper='x'/><mimic/><origin xyz='1 0 0'/>")));
    CHECK(jointCalled(odd.scene, "hold").dofs.empty()); // what a fixed joint has no use for is not looked at
    CHECK(jointPose(jointCalled(odd.scene, "hold"), {}).translation().x() == 1);
    const Dof& wheel = jointCalled(robot.scene, "wheel").dofs.at(0);
    CHECK(wheel.upper - wheel.lower == Approx(2 * std::numbers::pi));
    CHECK(robot.scene.joints.size() == 3);
    CHECK(hasNote(robot.notes, "joint swim (line 10) is floating"));
    CHECK(hasNote(robot.notes,
                  "joint stuck (line 11) has the limits 28.6479 to 28.6479 degrees: taken as fixed"));
    CHECK(robot.scene.pairs.size() == 3); // the wheel against the base, a and d; c is tied to nothing
}

TEST_CASE("a joint that mimics goes as far as its leader leads it, and follows it in the scene's motion") {
    const auto follower = [](const std::string& mimic, const std::string& itsLimits) {
        return robotOf(
            aLink("base") + aLink("a") + aLink("b") + aJoint("lead", "revolute", "base", "a", limits) +
            aJoint("follow", "revolute", "base", "b", "<mimic joint='lead' " + mimic + "/>" + itsLimits));
    };
    const RobotScene robot =
        madeOfUrdf(follower("multiplier='-0.5' offset='0.25'", "<limit lower='0' upper='9'/>"));
    const Joint &lead = jointCalled(robot.scene, "lead"), &joint = jointCalled(robot.scene, "follow");
    CHECK(joint.dofs[0].lower == Approx(-0.75));
    CHECK(joint.dofs[0].upper == Approx(0.75));
    CHECK(joint.dofs[0].rest == Approx(0.25));
    REQUIRE(joint.drives[0].times == lead.drives[0].times);
    for (std::size_t k = 0; k < joint.drives[0].values.size(); ++k)
        CHECK(joint.drives[0].values[k] == Approx(0.25 - 0.5 * lead.drives[0].values[k]));
    CHECK(hasNote(robot.notes, "joint follow mimics lead, which leads it from -42.9718 to 42.9718 degrees, "
                               "beyond its own limits 0 to 515.662 degrees"));
    const RobotScene within = madeOfUrdf(follower("", "<limit lower='-1' upper='9'/>"));
    CHECK(hasNote(within.notes, "which leads it from -57.2958 to 114.592 degrees"));
    CHECK_FALSE(hasNote(within.notes, "beyond"));
}

TEST_CASE("what one leads that turns on and on goes all the way round, or within its own limits") {
    const auto led = [](const std::string& type, const std::string& mimic, const std::string& itsLimits) {
        return madeOfUrdf(
            robotOf(aLink("base") + aLink("a") + aLink("b") + aJoint("lead", "continuous", "base", "a", "") +
                    aJoint("follow", type, "base", "b", "<mimic joint='lead' " + mimic + "/>" + itsLimits)));
    };
    const auto range = [](const RobotScene& robot) {
        const Dof& dof = jointCalled(robot.scene, "follow").dofs.at(0);
        return dof.upper - dof.lower;
    };
    const double turn = 2 * std::numbers::pi;
    CHECK(range(led("revolute", "multiplier='0.5'", limits)) == Approx(turn));
    CHECK(range(led("revolute", "multiplier='-1' offset='0.1'", limits)) == Approx(turn));
    CHECK(range(led("continuous", "multiplier='2.5'", "")) >= turn);
    CHECK(range(led("prismatic", "multiplier='0.05'", limits)) == Approx(3));
    const RobotScene rack = led("prismatic", "multiplier='0.05'", "<limit effort='1' velocity='1'/>");
    CHECK(rack.scene.joints.size() == 1);
    CHECK(hasNote(rack.notes, "slides without limits as its leader turns on and on: left out, b and what"));
    // A leader of another one's leader.
    const RobotScene chain = madeOfUrdf(
        robotOf(aLink("base") + aLink("a") + aLink("b") + aLink("c") +
                aJoint("follow", "revolute", "base", "c", "<mimic joint='mid' multiplier='0.5'/>" + limits) +
                aJoint("mid", "revolute", "base", "b", "<mimic joint='lead' multiplier='0.5'/>" + limits) +
                aJoint("lead", "continuous", "base", "a", "")));
    CHECK(range(chain) == Approx(turn));
}

TEST_CASE("URDF 1.1 turns by a quaternion too, and other versions are refused") {
    const auto placed = [](const std::string& origin) {
        const RobotScene robot =
            madeOfUrdf(robotOf(aLink("base") + aLink("a") +
                               aJoint("j", "revolute", "base", "a", "<origin " + origin + "/>" + limits)));
        return Eigen::Matrix3d(
            pose(pairMotion(robot.scene, robot.scene.pairs.at(0)), std::vector{0.0}).linear());
    };
    for (const Eigen::Quaterniond& q :
         {Eigen::Quaterniond(0.5, 0.1, -0.7, 0.2), Eigen::Quaterniond(1, 0, 1, 0),
          Eigen::Quaterniond(1, 1, -1, 1), Eigen::Quaterniond(0, 0, 0, -3)}) {
        const auto text = [](double c) { return std::to_string(c) + " "; };
        const std::string xyzw = "quat_xyzw='" + text(q.x()) + text(q.y()) + text(q.z()) + text(q.w()) + "'";
        CHECK((placed(xyzw) - q.normalized().toRotationMatrix()).norm() < 1e-9);
    }
    CHECK(
        madeOfUrdf(robotOf(aLink("a", "<collision><origin quat_xyzw='0 0 0 0'/><geometry><box size='1 1 1'/>"
                                      "</geometry></collision>") +
                           aLink("b")))
            .scene.bodies[0]
            .mesh.empty());
    const std::string both =
        robotOf(aLink("base") + aLink("a") +
                aJoint("j", "revolute", "base", "a", "<origin rpy='0 0 0' quat_xyzw='0 0 0 1'/>" + limits));
    CHECK(hasNote(madeOfUrdf(both).notes, "expected one of rpy and quat_xyzw"));
    const auto version = [](const std::string& number) {
        return "<robot name='r' version='" + number + "'>" + aLink("a") + "</robot>";
    };
    CHECK(madeOfUrdf(version("1.1")).scene.bodies.size() == 1);
    CHECK(madeOfUrdf(version("1.2")).scene.bodies.size() == 1);
    CHECK(refusedUrdf(version("2.0")).find("expected 1.0, 1.1 or 1.2, found \"2.0\"") != std::string::npos);
}

TEST_CASE("an SRDF is that of the robot's own name, also where that is no prim's") {
    std::string text = robotOf(aLink("a") + aLink("b") + aJoint("j", "revolute", "a", "b", limits));
    text.replace(text.find("'arm'"), 5, "'2-arm robot'");
    const RobotScene robot = madeOfUrdf(text);
    const SceneModel again = readScene(std::make_shared<const Layer>(layerOf(robot.scene)), "arm.tss");
    CHECK(srdfOf(again, {}, "arm.tss").text.find("<robot name=\"2-arm robot\">") != std::string::npos);
}

TEST_CASE("a joint that nothing leads moves by itself, by name") {
    const auto note = [](const std::string& mimicOfOne, const std::string& mimicOfTwo,
                         const std::string& words) {
        const RobotScene robot = madeOfUrdf(
            robotOf(aLink("base") + aLink("a") + aLink("b") +
                    aJoint("one", "revolute", "base", "a", mimicOfOne + "<limit lower='5' upper='6'/>") +
                    aJoint("two", "revolute", "base", "b", mimicOfTwo + limits)));
        INFO(words);
        CHECK(hasNote(robot.notes, "joint one (line 6) " + words + ": it moves by itself"));
        CHECK(jointCalled(robot.scene, "one").dofs[0].lower == 5);
        CHECK(jointCalled(robot.scene, "one").dofs[0].upper == 6);
    };
    note("<mimic joint='two'/>", "<mimic joint='one'/>",
         "is one of joints that mimic each other in a circle");
    note("<mimic joint='nobody'/>", "",
         "mimics \"nobody\", which is no joint that turns or slides within limits");
}

TEST_CASE("what follows one that nothing leads follows it, in whichever order they stand") {
    const std::string links = aLink("base") + aLink("a") + aLink("b");
    const std::string wide = "<limit lower='-3' upper='3'/>";
    const std::string first = aJoint("first", "revolute", "base", "a", "<mimic joint='second'/>" + limits);
    for (const char* leader : {"nobody", "second", "first"}) {
        const std::string second =
            aJoint("second", "revolute", "base", "b", std::string("<mimic joint='") + leader + "'/>" + wide);
        const bool circle = leader == std::string("first"); // then the first of them moves by itself
        INFO(leader);
        CHECK(jointCalled(madeOfUrdf(robotOf(links + first + second)).scene, "first").dofs[0].upper ==
              (circle ? 2 : 3));
        CHECK(jointCalled(madeOfUrdf(robotOf(links + second + first)).scene, "first").dofs[0].upper == 3);
    }
}

TEST_CASE("limits of thousands of turns are one whole turn, and those of a continuous joint are none") {
    const auto turning = [](const std::string& type, const std::string& itsLimits) {
        return madeOfUrdf(
            robotOf(aLink("base") + aLink("a") + aJoint("wheel", type, "base", "a", itsLimits)));
    };
    const RobotScene far = turning("revolute", "<limit lower='-1e16' upper='1e16'/>");
    CHECK(jointCalled(far.scene, "wheel").dofs[0].upper == Approx(std::numbers::pi));
    CHECK(hasNote(far.notes, "degrees: taken as one whole turn"));
    const RobotScene odd = turning("continuous", "<limit lower='1' upper='-1'/>");
    REQUIRE(odd.scene.joints.size() == 1);
    CHECK(jointCalled(odd.scene, "wheel").dofs[0].upper == Approx(std::numbers::pi));
}

TEST_CASE("links that are tied to nothing stand where their joints put them") {
    const RobotScene robot =
        madeOfUrdf(robotOf(aLink("base") + aLink("a") + aLink("b") +
                           aJoint("up", "revolute", "base", "a", "<origin xyz='0 0 1'/>" + limits) +
                           aJoint("swim", "floating", "a", "b", "<origin xyz='2 0 0'/>")));
    CHECK(posedBodies(robot.scene, std::vector{0.0})[2].translation() == Vec3(2, 0, 1));
}

TEST_CASE("of two geometries in a collision none is taken, by name") {
    const std::string one = "<geometry><box size='1 1 1'/></geometry>";
    for (const std::string& other : {one, std::string("<geometry/>")}) {
        const RobotScene robot =
            madeOfUrdf(robotOf(aLink("a") + aLink("b", "<collision>" + other + one + "</collision>")));
        CHECK(bodyCalled(robot.scene, "b").mesh.empty());
        CHECK(hasNote(robot.notes, "(<link b>): expected one <geometry>"));
    }
}

TEST_CASE("capsules are shapes: their length is that between the centres of their ends") {
    const std::string capsule = "<geometry><capsule radius='1' length='2'/></geometry>";
    const RobotScene robot =
        madeOfUrdf(robotOf(aLink("a", "<collision>" + capsule + "</collision>") +
                           aLink("b", "<collision><origin xyz='5 0 0' rpy='0 1.5707963267948966 0'/>" +
                                          capsule + "</collision>")));
    const Eigen::AlignedBox3d up = bounds(bodyCalled(robot.scene, "a").mesh),
                              along = bounds(bodyCalled(robot.scene, "b").mesh);
    CHECK(up.sizes().isApprox(Vec3(2, 2, 4), 0.01));
    CHECK(along.sizes().isApprox(Vec3(4, 2, 2), 0.01));
    CHECK(along.center().isApprox(Vec3(5, 0, 0), 0.01));
}

TEST_CASE("names that USD does not know are kept beside, and the scene reads back the same") {
    const RobotScene robot =
        madeOfUrdf(robotOf(aLink("1 base/link") + aLink("tool-0") +
                           aJoint("joint-1", "revolute", "1 base/link", "tool-0",
                                  "<origin xyz='0 0 0.5' rpy='0.1 0.2 0.3'/>" + limits)));
    CHECK(bodyCalled(robot.scene, "tool_0").displayName == "tool-0");
    CHECK(hasNote(robot.notes, "joints have other names in the scene: joint-1 is joint_1"));
    const SceneModel again = readScene(std::make_shared<const Layer>(layerOf(robot.scene)), "arm.tss");
    REQUIRE(again.bodies.size() == 2);
    CHECK(again.bodies[0].displayName == "1 base/link");
    CHECK(again.bodies[1].mesh.triangles.size() == robot.scene.bodies[1].mesh.triangles.size());
    REQUIRE(again.pairs.size() == 1);
    CHECK(again.pairs[0].bodyB == 1);
    const Motion motion = pairMotion(again, again.pairs[0]);
    CHECK(motion.dofs[0].upper == Approx(2).epsilon(1e-6));
    CHECK(motion.dofs[0].rest == 0);
}

TEST_CASE("of pairs that are not asked for it is not said why they are none") {
    std::string links = aLink("l0");
    const int joints = static_cast<int>(maxDofs) + 1;
    for (int k = 1; k <= joints; ++k)
        links += aLink("l" + std::to_string(k)) + aJoint("j" + std::to_string(k), "revolute",
                                                         "l" + std::to_string(k - 1), "l" + std::to_string(k),
                                                         "<origin xyz='1 0 0'/>" + limits);
    CHECK(madeOfUrdf(robotOf(links)).unmade.size() == 1);
    RobotSceneRequest neighbours;
    neighbours.pairs = RobotPairs::Neighbours;
    const RobotScene robot = madeOfUrdf(robotOf(links), neighbours);
    CHECK(static_cast<int>(robot.scene.pairs.size()) == joints);
    CHECK(robot.unmade.empty());
}

TEST_CASE("pairs are those of neighbours or all, and an SRDF takes some out") {
    const std::string text =
        robotOf(aLink("a") + aLink("b") + aLink("c") + aJoint("j", "revolute", "a", "b", limits) +
                aJoint("k", "revolute", "b", "c", "<origin xyz='1 0 0'/>" + limits));
    CHECK(madeOfUrdf(text).scene.pairs.size() == 3);
    RobotSceneRequest neighbours;
    neighbours.pairs = RobotPairs::Neighbours;
    CHECK(madeOfUrdf(text, neighbours).scene.pairs.size() == 2);
    Robot robot = readUrdf(text, "arm.urdf");
    readSrdf(robot,
             "<robot name='arm'><group name='g'/><disable_collisions link1='c' link2='a' reason='Never'/>"
             "<disable_collisions link1='c' link2='nobody' reason='Never'/></robot>",
             "arm.srdf");
    const RobotScene fewer = sceneOf(robot, {}, noMeshes);
    CHECK(fewer.scene.pairs.size() == 2);
    CHECK(hasNote(fewer.notes, "switch off, left out: 1"));
    CHECK(hasNote(fewer.notes, "no link \"nobody\""));
    CHECK(refusal([&] {
              readSrdf(robot, "<robot><disable_collisions link1='a'/></robot>", "arm.srdf");
          }).find("link1 and link2") != std::string::npos);
    CHECK(refusal([&] { readSrdf(robot, text, "arm.urdf"); }).find("expected an SRDF") != std::string::npos);
}
#endif
