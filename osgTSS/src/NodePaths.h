#pragma once
#include <osg/Transform>

namespace osgTSS {

/// All ways from a node to one below it, both included; none where it is not below.
inline osg::NodePathList pathsFrom(osg::Node& above, osg::Node& node) {
    osg::NodePathList paths = node.getParentalNodePaths(&above);
    std::erase_if(paths, [&](const osg::NodePath& path) { return path.empty() || path.front() != &above; });
    return paths;
}

/// Whether there is one.
inline bool isBelow(const osg::Node& node, const osg::Node& above) {
    if (&node == &above) return true;
    for (unsigned int k = 0; k < node.getNumParents(); ++k)
        if (isBelow(*node.getParent(k), above)) return true;
    return false;
}

/// The matrix of a transform by itself.
inline osg::Matrixd ownMatrix(const osg::Transform& transform) {
    osg::Matrix matrix;
    transform.computeLocalToWorldMatrix(matrix, nullptr);
    return matrix;
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
