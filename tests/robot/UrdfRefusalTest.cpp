// What a URDF may not say, and what is left out of one by name.
#ifdef OSGTSS_HAVE_URDF
#include "bake/model/Kinematics.h"
#include "tests/robot/Urdf.h"

using namespace urdf;

TEST_CASE("what a URDF gets wrong is refused with file, line and element") {
    const auto says = [](const std::string& text, const std::string& words) {
        const std::string message = refusedUrdf(text);
        INFO(message);
        CHECK(message.find("arm.urdf") != std::string::npos);
        CHECK(message.find(words) != std::string::npos);
    };
    const std::string two = aLink("a") + aLink("b");
    says("", "expected XML, found nothing");
    says("<robot name='x'>", "line 1: expected the end of the element");
    says("<sdf/>", "line 1 (<sdf>): expected <robot>, found <sdf>");
    says("<robot name='x'/>", "at least one <link>");
    says("<robot><link/></robot>", "line 1 (<link>): expected an attribute name");
    says(robotOf(aLink("a") + aLink("a")), "line 4 (<link a>): expected a name that no other link has");
    says(robotOf(two + aJoint("j", "fixed", "a", "b", "") + aJoint("k", "fixed", "a", "b", "")),
         "hangs on joint j too");
    says(robotOf(two + aLink("c") + aJoint("j", "fixed", "a", "b", "") + aJoint("k", "fixed", "b", "a", "")),
         "loop");
    says(robotOf(two + aJoint("j", "fixed", "a", "b", "") + aJoint("k", "fixed", "b", "a", "")), "a loop");
    says(robotOf(two + aLink("c") + aJoint("j", "fixed", "a", "b", "") + aJoint("k", "fixed", "c", "c", "")),
         "line 7 (<joint k>): the joints close a loop");
    says(robotOf(aLink("a", "<collision><geometry><box/></geometry></collision>")),
         "expected an attribute size");
    says(robotOf(aLink("a", "<collision><geometry><box size='1 0 1'/></geometry></collision>")),
         "lengths above 0");
    says(robotOf("<link name='a' name='b'/>"), "not well-formed XML");
    says(robotOf(aLink("caf\xe9")), "UTF-8");
}

TEST_CASE(
    "a link of which a shape cannot be had has no part of it, but its other shapes, and the others stay") {
    const std::string lost = "<collision><geometry><mesh filename='lost.stl'/></geometry></collision>";
    const std::string seen = "<visual><geometry><box size='1 1 1'/></geometry></visual>";
    const std::string point = "<collision><geometry><box size='0 0 0'/></geometry></collision>";
    const std::string text =
        robotOf(aLink("a") + aLink("b", box + lost) + aLink("c", lost + seen) + aLink("d", point) +
                aLink("e", lost + box) + aJoint("m", "revolute", "a", "e", limits) +
                aJoint("j", "revolute", "a", "b", limits) + aJoint("k", "revolute", "b", "c", limits) +
                aJoint("l", "revolute", "c", "d", limits));
    const RobotScene robot = madeOfUrdf(text);
    CHECK(bodyCalled(robot.scene, "b").mesh.empty());
    CHECK(bodyCalled(robot.scene, "d").mesh.empty());
    CHECK(bounds(bodyCalled(robot.scene, "c").mesh).sizes().isApprox(Vec3::Ones()));
    CHECK(robot.links[2].visual);
    CHECK(robot.scene.pairs.size() == 1); // of a and c
    CHECK(hasNote(robot.notes, "left out: arm.urdf: line 4 (<link b>): "));
    CHECK(hasNote(robot.notes, "left out: points, shapes of no size: d"));
    CHECK(robot.notes.back() == "these have no shape then, and whether they collide is not known: b, e");
    CHECK(refusedUrdf(robotOf(aLink("a", lost))).find("arm.urdf: line 3 (<link a>): ") != std::string::npos);
}

TEST_CASE("a joint that cannot be read is left out by name, and the rest comes in") {
    const auto note = [](const std::string& joint, const std::string& words) {
        const RobotScene robot = madeOfUrdf(robotOf(aLink("a", box) + aLink("b", box) + aLink("c", box) +
                                                    joint + aJoint("k", "revolute", "a", "c", limits)));
        INFO(words);
        CHECK(hasNote(robot.notes, words));
        REQUIRE(robot.scene.joints.size() == 1);
        CHECK(robot.scene.pairs.size() == 1); // of a and c
    };
    const std::string untied = ": left out, b and what hangs on it are tied to nothing";
    note(aJoint("j", "revolute", "a", "b", "<limit lower='2' upper='1'/>"),
         "joint j (line 6) has a lower limit above its upper one" + untied);
    note(aJoint("j", "spherical", "a", "b", ""), "found \"spherical\")" + untied);
    note(aJoint("j", "revolute", "a", "b", ""), "expected an element <limit lower=... upper=...>)" + untied);
    note(aJoint("j", "revolute", "a", "b", "<axis xyz='0 0 0'/>" + limits),
         "expected an axis that is not zero)" + untied);
    for (const char* numbers : {"0 nan 0", "0 1e999 0", "0, 1, 2", "1 2 3 4"})
        note(aJoint("j", "revolute", "a", "b",
                    "<origin xyz='" + std::string(numbers) + "'/><limit lower='0' upper='1'/>"),
             "joint j (line 6) cannot be read (xyz: expected 3 finite numbers, found \"" +
                 std::string(numbers) + "\")" + untied);
    note(aJoint("j", "fixed", "a", "nobody", ""),
         "joint j (line 6) cannot be read (expected the name of a link, found \"nobody\"): left out");
    note("<joint name='j' type='fixed'><parent link='a'/></joint>",
         "joint j (line 6) cannot be read (expected an element <child>): left out");
}

TEST_CASE("an axis of any length is the direction that it is") {
    for (const char* axis : {"0 3e200 4e200", "0 3e-200 4e-200", "0 3 4"}) {
        CAPTURE(axis);
        const RobotScene robot = madeOfUrdf(
            robotOf(aLink("a") + aLink("b") +
                    aJoint("j", "revolute", "a", "b", "<axis xyz='" + std::string(axis) + "'/>" + limits)));
        REQUIRE(robot.scene.joints.size() == 1);
        const Motion motion = pairMotion(robot.scene, robot.scene.pairs.at(0));
        CHECK(motion.dofs.at(0).axis.isApprox(Vec3(0, 0.6, 0.8)));
    }
}

TEST_CASE("links that no joint holds come in, tied to nothing") {
    const RobotScene robot = madeOfUrdf(robotOf(aLink("root", box) + aLink("a", box) + aLink("root_", box) +
                                                aJoint("j", "revolute", "a", "root", limits)));
    CHECK(robot.scene.bodies.size() == 3);
    CHECK(robot.scene.joints.size() == 1);
    CHECK(robot.scene.pairs.size() == 1);
    CHECK(hasNote(robot.notes, "link root_ hangs on no joint: tied to nothing"));
}

TEST_CASE("a robot without a name has that of its file; zeros after its end do not matter") {
    using namespace std::string_literals;
    CHECK(madeOfUrdf("<robot><link name='a'/></robot>\n\0\0"s).scene.defaultPrim == "arm");
    CHECK(refusedUrdf("<robot>\0<link name='a'/></robot>"s).find("UTF-8") != std::string::npos);
}

TEST_CASE("xacro, document types, bombs and depth are refused by name") {
    const std::string xacro = robotOf("<xacro:include filename='x'/>" + aLink("a"));
    CHECK(refusedUrdf(xacro).find("line 3 (<xacro:include>): \"xacro:include\" is xacro") !=
          std::string::npos);
    CHECK(refusedUrdf(xacro).find("xacro arm.urdf > arm_expanded.urdf") != std::string::npos);
    CHECK(refusedUrdf(robotOf("<link name='${prefix}a'/>")).find("is xacro") != std::string::npos);
    const std::string bomb =
        "<!DOCTYPE robot [<!ENTITY a \"lol\"><!ENTITY b \"&a;&a;&a;\">]>\n" + robotOf(aLink("&b;"));
    CHECK(refusedUrdf(bomb).find("line 1: a document type is not read") != std::string::npos);
    CHECK(refusedUrdf("<!-- licence -->\n" + robotOf(aLink("a")))
              .find("line 2: expected <?xml ...?> at the very") != std::string::npos);
    std::string deep;
    for (int k = 0; k < 100000; ++k) deep += "<link name='a'>";
    CHECK(refusedUrdf("<robot name='x'>" + deep).find("no more than 100 deep") != std::string::npos);
    CHECK(refusedUrdf(robotOf("<!-- " + std::string(9 << 20, 'x') + " -->" + aLink("a"))).find("8 MiB") !=
          std::string::npos);
}

TEST_CASE(
    "a link with a shape that cannot be read has its other ones, and what is not used does not matter") {
    const auto note = [](const std::string& shape, const std::string& words) {
        const RobotScene robot = madeOfUrdf(robotOf(
            "<material name='red'><color rgba='1 0 0 1'/></material><gazebo reference='a'><x/></gazebo>"
            "<transmission name='t'><type>x</type></transmission>" +
            aLink("a", "<inertial><mass value='junk'/></inertial>"
                       "<visual><geometry><box size='1 1 1'/></geometry><material name='dim'><color "
                       "rgba='junk'/></material></visual>"
                       "<visual><geometry><box size='1 1 1'/></geometry><material name='red'/></visual>"
                       "<collision>" +
                           shape + "</collision>" + box)));
        INFO(words);
        CHECK(hasNote(robot.notes, "left out: arm.urdf: line 3 (<link a>): " + words));
        CHECK(bodyCalled(robot.scene, "a").displayColor == Vec3(1, 0, 0));
        CHECK(bounds(bodyCalled(robot.scene, "a").mesh).sizes().isApprox(Vec3::Ones()));
    };
    note("<geometry><plane/></geometry>", "a shape <plane> is none of URDF's");
    note("<geometry><mesh filename='a.stl' scale='1 1 1 1'/></geometry>", "scale: expected 3 finite numbers");
    note("<origin rpy='0 0'/><geometry><box size='1 1 1'/></geometry>", "rpy: expected 3 finite numbers");
    note("<geometry><box/></geometry>", "expected an attribute size");
    note("<geometry><capsule radius='1'/></geometry>", "expected an attribute length");
    note("<geometry><box size='1 1 1'/><box size='1 1 1'/></geometry>", "expected one shape in a <geometry>");
}
#endif
