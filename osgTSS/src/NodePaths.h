#pragma once
#include <osg/Transform>

namespace osgTSS {

/// All ways from a node to one below it, both included; none where it is not below.
inline osg::NodePathList pathsFrom(osg::Node& above, osg::Node& node) {
    osg::NodePathList paths = node.getParentalNodePaths(&above);
    std::erase_if(paths, [&](const osg::NodePath& path) { return path.empty() || path.front() != &above; });
    return paths;
}

/// From the coordinates at the end of a path to those that its first node hangs in, whatever is hidden on the
/// way, which osg::computeLocalToWorld() leaves out.
inline osg::Matrixd alongPath(const osg::NodePath& path) {
    osg::Matrix matrix;
    for (osg::Node* node : path)
        if (node->asTransform()) node->asTransform()->computeLocalToWorldMatrix(matrix, nullptr);
    return matrix;
}

} // namespace osgTSS
