#ifdef OSGTSS_HAVE_MJCF
#include "tests/robot/Mjcf.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/robot/PairEvidence.h"
#include "bake/robot/ReadRobot.h"
#include "bake/robot/WritePairs.h"
#include "bake/scene/Layer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"

#include <numbers>

using namespace tss;

namespace {

constexpr double degree = std::numbers::pi / 180;
const std::string ball = "<geom size='.1'/>";

Eigen::AngleAxisd about(const Vec3& axis, double degrees) {
    return {degrees * degree, axis.normalized()};
}

/// Where the model's first geom, a small box off the middle, stands.
Pose placed(const std::string& attributes, const std::string& compiler = "") {
    const RobotScene robot = made(modelOf(compiler + world("<body name='a'>" + ball + "<body name='b' " +
                                                           attributes + ">" + ball + "</body></body>")));
    return posedBodies(robot.scene, {})[1];
}

} // namespace

TEST_CASE("several joints of a body turn in their order about their own anchors") {
    const RobotScene robot = made(modelOf(
        world("<body name='a' pos='1 0 0'>" + ball + "<body name='b' pos='0 1 0' euler='0 0 90'>" + ball +
              "<joint name='z' pos='.1 .2 .3' axis='0 0 1' range='-30 40'/>"
              "<joint name='x' pos='.1 .2 .3' axis='1 0 0' range='-50 60'/>"
              "<joint name='odd' type='slide' axis='1 1 0' range='-1 2'/></body></body>")));
    const SceneModel& scene = robot.scene;
    REQUIRE(robot.scene.pairs.size() == 1);
    const Motion motion = pairMotion(scene, scene.pairs[0]);
    REQUIRE(motion.dofCount() == 3);
    CHECK(motion.dofs[0].upper == Approx(40 * degree));
    const Vec3 anchor(.1, .2, .3);
    for (const std::vector<double>& q : {std::vector{0.0, 0.0, 0.0}, {-0.5, 1.0, 1.5}, {0.6, -0.8, -1.0}}) {
        Pose pose = Pose::Identity();
        pose.translate(Vec3(0, 1, 0)).rotate(about({0, 0, 1}, 90));
        pose.translate(anchor).rotate(Eigen::AngleAxisd(q[0], Vec3::UnitZ())).translate(-anchor);
        pose.translate(anchor).rotate(Eigen::AngleAxisd(q[1], Vec3::UnitX())).translate(-anchor);
        pose.translate(q[2] * Vec3(1, 1, 0).normalized());
        CHECK((tss::pose(motion, q).matrix() - pose.matrix()).norm() < 1e-12);
    }
    const SceneModel again = readScene(std::make_shared<const Layer>(layerOf(scene)), "arm.tss");
    CHECK(again.pairs.size() == 1);
    CHECK(pairMotion(again, again.pairs[0]).dofCount() == 3);
}

TEST_CASE("orientations are read in each of their forms, and in the compiler's angles and order") {
    const auto same = [](const Pose& a, const Eigen::Quaterniond& b) {
        return (a.linear() - b.toRotationMatrix()).norm() < 1e-12;
    };
    const Eigen::Quaterniond turned(about({0, 0, 1}, 90));
    CHECK(same(placed("quat='2 0 0 2'"), turned));
    CHECK(same(placed("axisangle='0 0 3 90'"), turned));
    CHECK(same(placed("xyaxes='0 2 0 -1 1 0'"), turned));
    CHECK(same(placed("zaxis='1 0 0'"), Eigen::Quaterniond(about({0, 1, 0}, 90))));
    CHECK(same(placed("zaxis='0 0 -2'"), Eigen::Quaterniond(about({1, 0, 0}, 180)))); // as MuJoCo does
    const auto x = about({1, 0, 0}, 20), y = about({0, 1, 0}, 30), z = about({0, 0, 1}, 40);
    CHECK(same(placed("euler='20 30 40'"), x * y * z));
    CHECK(same(placed("euler='20 30 40'", "<compiler eulerseq='XYZ'/>"), z * y * x));
    CHECK(same(placed("euler='40 30 20'", "<compiler eulerseq='zyx'/>"), z * y * x));
    CHECK(same(placed("euler='0 0 1.5707963267948966'", "<compiler angle='radian'/>"), turned));
    CHECK(placed("pos='1 2 3'").translation() == Vec3(1, 2, 3));
}

TEST_CASE("geoms are closed meshes of their sizes: half lengths, between two points, in frames") {
    const auto box = [](const std::string& geom) {
        const RobotScene robot = made(modelOf(world("<body name='a'>" + geom + "</body>")));
        CHECK(auditMesh(robot.scene.bodies[0].mesh).watertight);
        return bounds(robot.scene.bodies[0].mesh);
    };
    const auto like = [](const Eigen::AlignedBox3d& a, const Vec3& low, const Vec3& high) {
        return (a.min() - low).norm() < 0.01 * (high - low).norm() &&
               (a.max() - high).norm() < 0.01 * (high - low).norm();
    };
    CHECK(like(box("<geom type='box' size='1 2 3' pos='1 0 0'/>"), {0, -2, -3}, {2, 2, 3}));
    CHECK(like(box("<geom size='2'/>"), {-2, -2, -2}, {2, 2, 2}));
    CHECK(like(box("<geom type='capsule' size='1 3'/>"), {-1, -1, -4}, {1, 1, 4}));
    CHECK(like(box("<geom type='cylinder' size='1 3' euler='90 0 0'/>"), {-1, -3, -1}, {1, 3, 1}));
    CHECK(like(box("<geom type='ellipsoid' size='1 2 3'/>"), {-1, -2, -3}, {1, 2, 3}));
    CHECK(like(box("<geom type='capsule' size='1' fromto='0 0 0 4 0 0'/>"), {-1, -1, -1}, {5, 1, 1}));
    CHECK(like(box("<geom type='box' size='.5 .1' fromto='0 0 0 0 4 0'/>"), {-.5, 0, -.5}, {.5, 4, .5}));
    // As MuJoCo has it: its own z towards the first point, by the shortest turn.
    CHECK((box("<geom type='box' size='.5' fromto='0 0 0 1 2 3'/>").min() - Vec3(-.68, -.581, -.401)).norm() <
          1e-3);
    CHECK((box("<geom type='box' size='.5' fromto='0 0 0 1 2 3'/>").max() - Vec3(1.68, 2.581, 3.401)).norm() <
          1e-3);
    CHECK(like(
        box("<frame pos='0 0 9'><frame euler='0 90 0'><geom type='capsule' size='1 3'/></frame></frame>"),
        {-4, -1, 8}, {4, 1, 10}));
}

TEST_CASE("what a class says holds for its elements, and what they say themselves before it") {
    const RobotScene robot = made(modelOf(
        "<default><geom type='box' size='1 1 1'/><joint range='-10 10'/><default class='arm'><joint axis='1 "
        "0 0'/>"
        "<default class='fine'><geom size='3 3 3' euler='0 0 45'/></default></default></default>" +
        world("<body name='a' childclass='arm'><geom/><body name='b'><joint name='j'/><geom class='fine' "
              "quat='1 0 0 0'/>"
              "</body><body name='c'><joint name='k' range='-20 20'/><geom class='fine'/></body>"
              "<body name='d'><joint name='l'/><geom class='fine' euler='0 0 90'/></body></body>")));
    const auto size = [&](const char* body) {
        return Vec3(bounds(bodyCalled(robot.scene, body).mesh).sizes());
    };
    CHECK(size("a").isApprox(Vec3(2, 2, 2)));
    CHECK(size("b").isApprox(
        Vec3(6 * std::sqrt(2), 6 * std::sqrt(2), 6))); // the class's euler counts, not a quat
    CHECK(size("d").isApprox(Vec3(6, 6, 6)));          // but its own euler does
    CHECK(size("c").isApprox(Vec3(6 * std::sqrt(2), 6 * std::sqrt(2), 6)));
    CHECK(jointCalled(robot.scene, "j").dofs[0].upper == Approx(10 * degree));
    CHECK(jointCalled(robot.scene, "k").dofs[0].upper == Approx(20 * degree));
    CHECK(pairMotion(robot.scene, robot.scene.pairs[0]).dofs[0].axis.isApprox(Vec3::UnitX()));
    CHECK(refused(modelOf(world("<body><geom class='nobody' size='1'/></body>"))).find("found \"nobody\"") !=
          std::string::npos);
}

TEST_CASE("the class at the top holds for all, whatever it is called and in however many parts") {
    const auto size = [](const std::string& top, const std::string& geom) {
        const RobotScene robot = made(modelOf(top + world("<body name='a'>" + geom + "</body>")));
        return Vec3(bounds(robot.scene.bodies[0].mesh).sizes());
    };
    const std::string top = "<default class='top'><geom type='box' size='1 2 3'/>"
                            "<default class='small'><geom size='.5'/></default></default>";
    CHECK(size(top, "<geom/>").isApprox(Vec3(2, 4, 6)));
    CHECK(size(top, "<geom class='top'/>").isApprox(Vec3(2, 4, 6)));
    CHECK(size(top + "<default><geom size='5'/></default>", "<geom/>").isApprox(Vec3(10, 4, 6)));
    // A size of fewer numbers leaves the others as they are.
    CHECK(size(top, "<geom size='3'/>").isApprox(Vec3(6, 4, 6)));
    CHECK(size(top, "<geom class='small'/>").isApprox(Vec3(1, 4, 6)));
    CHECK(size(top, "<geom class='small' size='3 1'/>").isApprox(Vec3(6, 2, 6)));
}

TEST_CASE("bodies without a name take none that another has") {
    const RobotScene robot =
        made(modelOf(world("<body name='a'>" + ball + "<body>" + ball + "<body name='body1'>" + ball +
                           "<joint/></body></body></body>")));
    CHECK(bodyCalled(robot.scene, "body1").named);
    CHECK_FALSE(bodyCalled(robot.scene, "body1_").named);
    CHECK(hasNote(made(modelOf(world("<body>" + ball + "</body>") +
                               "<contact><exclude body1='body0' body2='world'/></contact>"))
                      .notes,
                  "excludes of bodies that are not there: body0 and world"));
}

TEST_CASE("bodies that are tied to nothing stand where they do in the file") {
    const RobotScene robot =
        made(modelOf(world("<body name='a' pos='1 0 0'><freejoint/>" + ball + "<body name='b' pos='0 2 0'>" +
                           ball + "<joint type='slide'/></body></body>")));
    CHECK(posedBodies(robot.scene, {})[0].translation() == Vec3(1, 0, 0));
    CHECK(posedBodies(robot.scene, {})[1].translation() == Vec3(1, 2, 0));
    const RobotScene alone = made(modelOf(world("<body name='a' pos='1 0 0'>" + ball + "</body>")));
    CHECK(posedBodies(alone.scene, {})[0].translation() == Vec3(1, 0, 0));
}

TEST_CASE("what is not served is left out by name, and the rest comes in") {
    const RobotScene robot = made(
        modelOf("<asset><mesh name='shell' vertex='0 0 0'/></asset>" +
                world("<geom name='floor' type='plane' size='1 1 1'/><body name='a'>" + ball +
                      "<freejoint/><geom type='mesh' mesh='shell'/><body name='b'>" + ball +
                      "<joint name='far' type='slide'/></body><body name='c'>" + ball +
                      "<joint name='round' type='ball' range='0 30'/></body><body name='d'>" + ball +
                      "<joint name='spin'/></body><replicate count='3'><body name='e'/></replicate></body>") +
                "<equality><weld name='glue'/><joint joint1='spin' joint2='round'/></equality>"));
    CHECK(robot.scene.bodies.size() >= 4);
    for (const char* words :
         {"geoms of type plane: floor", "free joints: the bodies are tied to nothing: a",
          "(<link a>): mesh \"shell\" has no file",
          "slides without limits: the bodies are tied to nothing: b", "bodies made by replicate",
          "glue, joint of spin", "balls, which are taken as three turns"})
        CHECK(hasNote(robot.notes, words));
    CHECK(bodyCalled(robot.scene, "a").mesh.empty()); // with its ball alone nothing could be proven
    const Dof& spin = jointCalled(robot.scene, "spin").dofs[0];
    CHECK(spin.upper - spin.lower == Approx(2 * std::numbers::pi));
    CHECK(jointCalled(robot.scene, "round").dofs.size() == 3);
}

TEST_CASE("bodies whose joint cannot be served are tied to nothing, by name") {
    const auto note = [](const std::string& joint, const std::string& words) {
        const RobotScene robot = made(
            modelOf(world("<body name='a'>" + ball + "<body name='b'>" + ball + joint + "</body></body>")));
        INFO(words);
        CHECK(hasNote(robot.notes, words + ": the bodies are tied to nothing: b"));
        CHECK(robot.scene.joints.empty());
        CHECK(robot.scene.pairs.empty());
    };
    note("<joint axis='0 0 0'/>", "joints whose axis is zero");
    note("<joint limited='true' range='2 1'/>", "joints with a lower limit above their upper one");
    note("<joint limited='true'/>", "joints with limits and no range");
    note("<joint type='slide' range='1 1'/>", "slides without limits"); // which a range has where it rises
    note("<joint type='screw'/>", "joints of type screw");
    note("<joint type='free' limited='true'/>", "free joints"); // as where a class says limited
}

TEST_CASE("a range that does not rise is no limit, as to MuJoCo") {
    const auto turns = [](const std::string& joint) {
        const RobotScene robot = made(modelOf("<default><joint range='-10 10'/></default>" +
                                              world("<body name='a'>" + ball + "<body name='b'>" + ball +
                                                    "<joint name='j' " + joint + "/></body></body>")));
        const Dof& dof = jointCalled(robot.scene, "j").dofs.at(0);
        return dof.upper - dof.lower;
    };
    CHECK(turns("") == Approx(20 * degree));
    CHECK(turns("range='0 0'") == Approx(360 * degree));
    CHECK(turns("range='5 4'") == Approx(360 * degree));
    CHECK(turns("type='ball' range='0 0'") == Approx(360 * degree));
}

TEST_CASE("of a body with a geom that cannot be had nothing is made, but for the world's planes") {
    const auto empty = [](const std::string& geom) {
        const RobotScene robot = made(modelOf(world("<body name='a'>" + ball + "</body><body name='b'>" +
                                                    ball + geom + "<joint name='j'/></body>")));
        return bodyCalled(robot.scene, "b").mesh.empty();
    };
    CHECK(empty("<geom type='sdf' size='1'/>"));
    CHECK(empty("<geom type='boxx' size='1 1 1'/>"));
    CHECK(empty("<replicate count='6' euler='0 0 60'><geom size='1'/></replicate>"));
    CHECK(
        empty("<frame pos='1 0 0'><replicate count='6'><frame><geom size='1'/></frame></replicate></frame>"));
    CHECK_FALSE(empty("<replicate count='6'><body><geom size='1'/></body></replicate>"));
    CHECK(empty("<geom type='plane' size='1 1 1'/>"));
    const RobotScene room = made(modelOf(world("<geom type='plane' size='1 1 1'/>" + ball +
                                               "<body name='b'>" + ball + "<joint name='j'/></body>")));
    CHECK_FALSE(bodyCalled(room.scene, "world").mesh.empty()); // what is proven is about the rest of it
}

TEST_CASE("geoms that a pair names collide, whatever their own bits say") {
    const auto widest = [](const std::string& contact) {
        const RobotScene robot =
            made(modelOf(world("<body name='a'>" + ball + "<body name='b'><joint name='j'/>" + ball +
                               "<geom name='blade' size='3' contype='0' conaffinity='0'/></body></body>") +
                         contact));
        return bounds(bodyCalled(robot.scene, "b").mesh).sizes().maxCoeff();
    };
    CHECK(widest("") < 1);
    CHECK(widest("<contact><pair geom1='blade' geom2='x'/></contact>") > 5);
    // Nor does an exclude count of their bodies.
    const auto pairs = [](const std::string& pair) {
        return made(modelOf(world("<body name='a'><geom name='one' size='.1'/></body><body name='b'><joint/>"
                                  "<geom name='two' size='.1'/></body>") +
                            "<contact><exclude body1='a' body2='b'/>" + pair + "</contact>"))
            .scene.pairs.size();
    };
    CHECK(pairs("") == 0);
    CHECK(pairs("<pair geom1='two' geom2='one'/>") == 1);
}

TEST_CASE("geoms whose bits are none do not collide, however it is written") {
    for (const char* zero : {"0", " 0 ", "00", "-0"}) {
        const std::string geom = "<geom size='3' contype='" + std::string(zero) + "' conaffinity='0'/>";
        const RobotScene robot = made(modelOf(world("<body name='a'>" + ball + geom + "</body>")));
        CHECK(bounds(robot.scene.bodies[0].mesh).sizes().maxCoeff() < 1);
    }
}

TEST_CASE("what has no name is excluded by none: MuJoCo would not know it") {
    const RobotScene robot = made(modelOf(world("<body name='a'>" + ball + "<body pos='1 0 0'>" + ball +
                                                "<joint range='0 1'/><body name='c' pos='1 0 0'>" + ball +
                                                "<joint range='0 1'/></body></body></body>")));
    const SceneModel again = readScene(std::make_shared<const Layer>(layerOf(robot.scene)), "arm.tss");
    const std::string written = mjcfExcludesOf(again, evidenceOf(again), "arm.tss").text;
    INFO(written);
    CHECK(written.find("body1=\"body1\"") == std::string::npos);
    CHECK(written.find("body2=\"body1\"") == std::string::npos);
    CHECK(written.find("left on: MuJoCo knows no body without a name") != std::string::npos);
}

TEST_CASE("three turns hold every turn of a ball up to its angle") {
    const double most = 50 * degree;
    const RobotScene robot = made(modelOf(world("<body name='a'>" + ball + "<body name='b'>" + ball +
                                                "<joint type='ball' range='0 50'/></body></body>")));
    const Motion motion = pairMotion(robot.scene, robot.scene.pairs.at(0));
    for (int k = 0; k < 500; ++k) {
        const Vec3 axis(std::sin(k * 1.1), std::cos(k * 2.3), std::sin(k * 0.7 + 1));
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(most * (k % 10 + 1) / 10, axis.normalized()).toRotationMatrix();
        const std::vector<double> q{std::atan2(-turn(1, 2), turn(2, 2)), std::asin(turn(0, 2)),
                                    std::atan2(-turn(0, 1), turn(0, 0))};
        REQUIRE((pose(motion, q).linear() - turn).norm() < 1e-12);
        CHECK(withinLimits(motion, q, 1e-12));
    }
}

TEST_CASE(
    "excludes are read, bodies in the world meet each other, and values count from the pose as modelled") {
    const RobotScene robot =
        made(modelOf(world("<body name='a'>" + ball + "</body><body name='b' pos='1 0 0'>" + ball +
                           "<joint name='j' range='10 40' ref='15'/></body><body name='c'>" + ball +
                           "<joint name='k' range='0 1'/></body>") +
                     "<contact><exclude body1='c' body2='a'/></contact>"));
    CHECK(robot.scene.pairs.size() == 2);
    CHECK(jointCalled(robot.scene, "j").dofs[0].lower == Approx(-5 * degree));
    CHECK(hasNote(robot.notes, "from their ref on: j"));
}

TEST_CASE(
    "an exclude of bodies that are made is left out by name, and so are these where there are no others") {
    const std::string rope = "<composite type='cable' count='3'/>";
    const RobotScene robot =
        made(modelOf(world(rope + "<body name='a'>" + ball + "<joint range='0 1'/></body><body name='b'>" +
                           ball + "</body>") +
                     "<contact><exclude body1='B_last' body2='a'/><exclude body1='a' body2=''/></contact>"));
    CHECK(hasNote(robot.notes, "left out: excludes of bodies that are not there: B_last and a, a and "));
    CHECK(robot.scene.pairs.size() == 1);
    CHECK(refused(modelOf(world(rope))).find("found none; left out: bodies made by composite") !=
          std::string::npos);
}

TEST_CASE("what an MJCF gets wrong is refused with file, line and element") {
    const auto says = [](const std::string& text, const std::string& words) {
        const std::string message = refused(text);
        INFO(message);
        CHECK(message.find("arm.xml") != std::string::npos);
        CHECK(message.find(words) != std::string::npos);
    };
    const auto body = [](const std::string& inside) {
        return modelOf(world("<body name='a'>" + inside + "</body>"));
    };
    says("<robot/>", "expected <mujoco>, found <robot>");
    says(modelOf(""), "expected at least one <body>");
    says(modelOf("<compiler coordinate='global'/>"),
         "coordinate: expected local, found \"global\"; MuJoCo up to 2.3.3 makes it so");
    says(modelOf("<compiler angle='grad'/>"), "expected degree, found \"grad\"");
    says(modelOf("<compiler eulerseq='xyw'/>"), "eulerseq");
    says(body("<geom type='box' size='1 1'/>"), "line 2 (<geom>): size: expected 3 numbers for a box");
    says(body("<geom size='-1'/>"), "lengths above 0");
    says(body("<geom size='1' quat='0 0 0 0'/>"), "not zero");
    says(body("<geom size='1' pos='0 0'/>"), "pos: expected 3 finite numbers");
    says(body("<geom size='1' pos='0 0 +-1'/>"), "pos: expected 3 finite numbers");
    says(body("<geom type='capsule' size='1' fromto='1 1 1 1 1 1'/>"), "expected two points");
    says(body("<geom type='mesh' mesh='m'/>"), "found \"m\"");
    says(body("<body name='a'/>"), "no other body");
    std::string deep;
    for (int k = 0; k < 100000; ++k) deep += "<body>";
    says("<mujoco><worldbody>" + deep, "no more than 100 deep");
    std::string many;
    for (int k = 0; k < 600; ++k) many += "<body/>";
    says(modelOf(world(many)), "no more than 500 links");
    says(modelOf("<default><geom pos='" + std::string(300, ' ') + "'/></default>" + world("<body/>")),
         "200 characters");
}
#endif
