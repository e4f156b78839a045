#ifdef OSGTSS_HAVE_MJCF
#include "bake/geometry/MeshAudit.h"
#include "tests/robot/Mjcf.h"

using namespace tss;

TEST_CASE("included files stand where they are named, once each") {
    const auto others = [](const std::string& name) -> std::string {
        if (name == "bodies.xml")
            return "<mujocoinclude><worldbody><body name='a'><include "
                   "file='geom.xml'/></body></worldbody></mujocoinclude>";
        if (name == "geom.xml") return "<mujoco><geom type='box' size='1 1 1'/></mujoco>";
        if (name == "self.xml") return "<mujoco><include file='self.xml'/></mujoco>";
        if (name == "bad.xml") return "<mujoco><worldbody>";
        if (name == "gone.xml") throw InputError(Where{"/models/gone.xml"}, "cannot be read");
        throw InputError("no file " + name);
    };
    const RobotScene robot = made(modelOf("<include file='bodies.xml'/>"), others);
    CHECK(bounds(bodyCalled(robot.scene, "a").mesh).sizes().isApprox(Vec3(2, 2, 2)));
    CHECK(refused(modelOf("<include file='self.xml'/>"), others).find("found self.xml again") !=
          std::string::npos);
    CHECK(
        refused(modelOf("<include file='none.xml'/>"), others).find("line 2 (<include>): no file none.xml") !=
        std::string::npos);
    CHECK(refused(modelOf("<include file='gone.xml'/>"), others)
              .find("line 2 (<include>): /models/gone.xml: cannot be read") != std::string::npos);
    CHECK(refused(modelOf("<include file='bad.xml'/>"), others).find("bad.xml: line 1") != std::string::npos);
}

TEST_CASE("what is wrong in an included file is told with its name and line") {
    const auto others = [](const std::string& name) -> std::string {
        if (name == "arm.xml")
            return "<mujoco>\n<worldbody>\n<include file='parts/hand.xml'/></worldbody></mujoco>";
        if (name == "size.xml")
            return "<mujoco>\n<worldbody><body>\n<geom name='g' size='a'/></body></worldbody></mujoco>";
        return "<mujoco>\n\n<body name='hand'>\n<geom type='mesh' mesh='none'/></body></mujoco>";
    };
    const auto says = [&](const std::string& included, const std::string& words) {
        const std::string message = refused(modelOf("<include file='" + included + "'/>"), others);
        INFO(message);
        CHECK(message.find(words) != std::string::npos);
    };
    says("size.xml", "size.xml: line 3 (<geom g>): size: expected 1 to 3 finite numbers, found \"a\"");
    says("arm.xml", "parts/hand.xml: line 4 (<geom>): mesh: expected");
    const auto hfield = [](const std::string&) -> std::string {
        return "<mujoco>\n<worldbody><body name='b'>\n<geom type='hfield'/><geom "
               "size='1'/></body></worldbody></mujoco>";
    };
    CHECK(hasNote(
        made(modelOf("<include file='field.xml'/>" + world("<body name='a'><geom size='1'/></body>")), hfield)
            .notes,
        "line 3 of field.xml"));
}

#endif
