#pragma once
#include "Playback.h"

#include <catch2/catch.hpp>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgSim/DOFTransform>
#include <osgTSS/ConstraintVisitor>
#include <osgTSS/Convert>
#include <osgTSS/Install>

#include <limits>

/// Nodes as other people's files hold them.
namespace nodes {

constexpr unsigned long allLimited = 0xff800000ul;

inline osg::ref_ptr<osg::Node> box(const osg::Vec3& centre, float half = 0.2f) {
    return new osg::ShapeDrawable(new osg::Box(centre, 2 * half));
}

inline osg::ref_ptr<osgSim::DOFTransform> dof(const std::string& name, unsigned long flags = allLimited) {
    osg::ref_ptr<osgSim::DOFTransform> node = new osgSim::DOFTransform;
    node->setName(name);
    node->setCurrentScale(osg::Vec3(1, 1, 1));
    node->setLimitationFlags(flags);
    node->setAnimationOn(false);
    return node;
}

inline tss::SceneModel
extract(osg::Node& root, osgTSS::ConstraintVisitor::Pairs pairs = osgTSS::ConstraintVisitor::NEIGHBOURS) {
    osgTSS::ConstraintVisitor visitor(pairs);
    root.accept(visitor);
    return visitor.getModel();
}

/// A table of one test between spheres about two points.
inline void giveTable(tss::SceneModel& model, std::size_t pair, const osg::Vec3& a, const osg::Vec3& b,
                      double radius) {
    model.pairs.at(pair).table = std::make_shared<tss::Table>(
        tss::makeTable({{osgTSS::toCore(a), radius}}, {{osgTSS::toCore(b), radius}}, {{0, 0}}, {},
                       pairMotion(model, model.pairs[pair])));
}

} // namespace nodes
