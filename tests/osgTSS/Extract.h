#pragma once
#include <osg/Node>
#include <osgTSS/ConstraintVisitor>

/// What the visitor makes of a graph.
inline tss::SceneModel
extract(osg::Node& root, osgTSS::ConstraintVisitor::Pairs pairs = osgTSS::ConstraintVisitor::NEIGHBOURS) {
    osgTSS::ConstraintVisitor visitor(pairs);
    root.accept(visitor);
    return visitor.getModel();
}
