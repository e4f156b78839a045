#pragma once
#include <osg/Node>

#include <string>
#include <vector>

namespace osgTSS {

/// What nobody would hear of otherwise: user values "osgTSS:..." of a node whose name osgTSS does not know,
/// or whose type it does not read. A sentence each.
std::vector<std::string> wrongTags(const osg::Node& node);

} // namespace osgTSS
