#pragma once
#include "bake/scene/SceneModel.h"

#include <osg/Node>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace osgTSS {

/// Reads and writes the values of a joint on the node that carries them.
class JointNode {
public:
    virtual ~JointNode() = default;

    /// The node is still there.
    virtual bool valid() const = 0;
    virtual std::size_t dofCount() const = 0;
    /// Before anything writes: what was asked for last comes back, so that an animation that steps from its
    /// own last value, or an application that asks once, does not see that it was stopped.
    virtual void restoreAsked() = 0;
    /// What is asked for.
    virtual std::vector<double> asked() const = 0;
    /// What the node shows.
    virtual std::vector<double> shown() const = 0;
    /// Shows these values.
    virtual void show(const std::vector<double>& values) = 0;
};

/// A JointTransform, or an osgSim::DOFTransform with DOFs as the joint describes them; null for another node
/// or for DOFs that the node does not have.
std::unique_ptr<JointNode> makeJointNode(osg::Node& node, const tss::Joint& joint);

/// Names the joint that a node carries. On another node than a JointTransform it is a user value, so that it
/// is saved and cloned with the node.
void tagJoint(osg::Node& node, const std::string& jointPath);

/// The nodes at and below `root` that carry a joint, by the joint's path. Sees masked nodes; of several nodes
/// with one path the first.
std::map<std::string, osg::Node*> findJointNodes(osg::Node& root);

} // namespace osgTSS
