#pragma once
#include <osg/Node>

namespace osgTSS {

/// Whether a callback is one of those that install() puts in: they move what hangs below their node.
bool isInstalled(const osg::Callback& callback);

/// Whether an update callback may move the node itself: any but those that are known to move others only
/// (osgTSS's own, animation managers, a skeleton's).
bool movesItself(osg::Node& node);

} // namespace osgTSS
