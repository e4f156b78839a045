#pragma once
#include <osg/Node>
#include <osgTSS/SkinGeometry>

#include <map>
#include <string>

namespace osgTSS {

/// Names the body whose frame a node's children are in. A user value, saved and cloned with the node.
void tagBody(osg::Node& node, const std::string& bodyPath);

/// What shows bodies at and below a node, by the bodies' paths; of several the first. Sees masked nodes.
struct BodyNodes {
    std::map<std::string, osg::Node*> frames;
    std::map<std::string, SkinGeometry*> shapes;
};
BodyNodes findBodyNodes(osg::Node& root);

} // namespace osgTSS
