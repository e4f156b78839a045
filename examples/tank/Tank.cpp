#include "Tank.h"

#include <osg/Geode>
#include <osg/Material>
#include <osg/ShapeDrawable>
#include <osgSim/DOFTransform>

namespace {

osg::ref_ptr<osg::Node> solid(osg::Shape* shape, const osg::Vec4& color) {
    osg::ref_ptr<osg::ShapeDrawable> drawable = new osg::ShapeDrawable(shape);
    drawable->setColor(color);
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(drawable);
    return geode;
}

osg::ref_ptr<osg::Node> box(const osg::Vec3& centre, const osg::Vec3& size, const osg::Vec4& color) {
    return solid(new osg::Box(centre, size.x(), size.y(), size.z()), color);
}

osg::ref_ptr<osg::Node> barrel(const osg::Vec3& from, float length, float radius, const osg::Vec4& color) {
    osg::ref_ptr<osg::Cylinder> cylinder =
        new osg::Cylinder(from + osg::Vec3(length / 2, 0, 0), radius, length);
    cylinder->setRotation(osg::Quat(osg::PI_2, osg::Y_AXIS));
    return solid(cylinder, color);
}

/// Turns about a point by heading (about Z) or pitch (about Y: the put matrix turns the node's X there).
osg::ref_ptr<osgSim::DOFTransform> joint(const std::string& name, const osg::Matrix& put) {
    osg::ref_ptr<osgSim::DOFTransform> dof = new osgSim::DOFTransform;
    dof->setName(name);
    dof->setPutMatrix(osg::Matrix::inverse(put));
    dof->setInversePutMatrix(put);
    dof->setCurrentScale(osg::Vec3(1, 1, 1));
    dof->setLimitationFlags(0xff800000ul);
    dof->setAnimationOn(true);
    return dof;
}

} // namespace

osg::ref_ptr<osg::Group> makeTank() {
    const osg::Vec4 green(0.35f, 0.42f, 0.25f, 1), dark(0.25f, 0.28f, 0.2f, 1), steel(0.5f, 0.5f, 0.52f, 1);
    osg::ref_ptr<osg::Group> tank = new osg::Group;
    tank->setName("Tank");
    tank->addChild(box(osg::Vec3(0, 0, 0.7f), osg::Vec3(6, 3, 1), green));
    tank->addChild(box(osg::Vec3(-2.4f, 0, 1.45f), osg::Vec3(1, 1.6f, 0.55f), dark)); // stowage
    for (float side : {-1.0f, 1.0f})
        tank->addChild(box(osg::Vec3(0, 1.7f * side, 0.5f), osg::Vec3(6.4f, 0.5f, 1), dark));

    osg::ref_ptr<osgSim::DOFTransform> turret = joint("Turret", osg::Matrix::translate(0.3, 0, 1.25));
    turret->setMinHPR(osg::Vec3(-osg::PI, 0, 0));
    turret->setMaxHPR(osg::Vec3(osg::PI, 0, 0));
    turret->setIncrementHPR(osg::Vec3(0.6f, 0, 0));
    turret->addChild(box(osg::Vec3(0.3f, 0, 1.65f), osg::Vec3(2, 1.8f, 0.7f), green));
    tank->addChild(turret);

    osg::ref_ptr<osgSim::DOFTransform> gun =
        joint("Gun", osg::Matrix::rotate(osg::PI_2, osg::Z_AXIS) * osg::Matrix::translate(1.4, 0, 1.75));
    gun->setMinHPR(osg::Vec3(0, osg::DegreesToRadians(-20.0f), 0));
    gun->setMaxHPR(osg::Vec3(0, osg::DegreesToRadians(8.0f), 0));
    gun->setIncrementHPR(osg::Vec3(0, 0.07f, 0));
    gun->addChild(barrel(osg::Vec3(1.4f, 0, 1.75f), 3.2f, 0.09f, steel));
    turret->addChild(gun);
    return tank;
}
