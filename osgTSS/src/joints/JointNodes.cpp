#include "JointNodes.h"

#include "AnimationChannels.h"
#include "JointKinds.h"
#include "osgTSS/src/EachNode.h"

#include "bake/base/Error.h"

#include <osg/ValueObject>
#include <osg/observer_ptr>
#include <osgAnimation/Bone>
#include <osgTSS/JointTransform>

#include <algorithm>
#include <sstream>

namespace osgTSS {

namespace {

const char* const tagName = "osgTSS:joint";

/// It keeps what is asked for and what it shows apart itself.
class JointTransformNode : public JointNode {
public:
    explicit JointTransformNode(JointTransform& node)
        : _node(&node), _dofs(node.getNumDofs()), _frame0(node.getJoint().frame0),
          _frame1(node.getJoint().frame1) {}

    bool valid() const override { return _node.valid() && _node->getNumDofs() == _dofs; }
    std::vector<double> asked() const override { return _node->getAskedValues(); }
    std::vector<double> shown() const override { return _node->getValues(); }
    void show(const std::vector<double>& values) override { _node->setResolvedValues(values); }
    std::optional<Stray> stray() const override {
        const tss::Joint& joint = _node->getJoint();
        if (joint.frame0.matrix() == _frame0.matrix() && joint.frame1.matrix() == _frame1.matrix())
            return std::nullopt;
        return Stray{"its frames are others than its tables were made for", true};
    }

private:
    osg::observer_ptr<JointTransform> _node;
    std::size_t _dofs;
    tss::Pose _frame0, _frame1;
};

/// Joints of a node that moves by itself: what cannot be served is not the application's wish.
template <class Find>
std::optional<FoundJoints> ifServed(const Find& find, std::string& why) {
    try {
        return find();
    } catch (const tss::InputError& error) {
        why = error.message;
        return std::nullopt;
    }
}

} // namespace

std::optional<FoundJoints> jointsOf(osg::Transform& node, const AnimationChannels& channels,
                                    double timeCodesPerSecond, std::string& why) {
    if (const auto* transform = dynamic_cast<JointTransform*>(&node)) {
        tss::Joint joint = transform->getJoint();
        for (std::size_t k = 0; k < joint.dofs.size(); ++k)
            joint.dofs[k].rest = transform->getValue(static_cast<unsigned int>(k));
        return FoundJoints{{joint}};
    }
    if (const auto* transform = dynamic_cast<osgSim::DOFTransform*>(&node))
        return dofTransformJoint(*transform, timeCodesPerSecond);
    if (isTagged(node)) return taggedJoint(node);
    if (dynamic_cast<osgAnimation::Bone*>(&node))
        return ifServed([&] { return boneJoint(node, channels); }, why);
    if (const auto* animation = animationPathOf(node))
        return ifServed([&] { return animationPathJoint(*animation, timeCodesPerSecond); }, why);
    if (auto* animation = stackOf(node))
        return ifServed([&] { return stackedJoints(node, *animation, channels, timeCodesPerSecond); }, why);
    return std::nullopt;
}

bool saysJoint(osg::Node& node) {
    return dynamic_cast<JointTransform*>(&node) || dynamic_cast<osgSim::DOFTransform*>(&node) ||
           isTagged(node);
}

std::unique_ptr<JointNode> makeJointNode(osg::Node& node, const tss::Joint& joint) {
    if (auto* transform = dynamic_cast<JointTransform*>(&node)) {
        if (transform->getNumDofs() != joint.dofs.size()) return nullptr;
        return std::make_unique<JointTransformNode>(*transform);
    }
    if (auto* transform = dynamic_cast<osgSim::DOFTransform*>(&node))
        return makeDofTransformNode(*transform, joint);
    if (isTagged(node)) return makeTaggedNode(node, joint);
    if (dynamic_cast<osgAnimation::Bone*>(&node)) return makeBoneNode(node, joint);
    if (animationPathOf(node)) return makeAnimationPathNode(node, joint);
    if (stackOf(node)) return makeStackedNode(node, joint);
    return nullptr;
}

void tagJoint(osg::Node& node, const std::string& jointPath) {
    if (auto* joint = dynamic_cast<JointTransform*>(&node)) return joint->setPath(jointPath);
    std::string paths;
    node.getUserValue(tagName, paths);
    if ((" " + paths + " ").find(" " + jointPath + " ") != std::string::npos) return;
    node.setUserValue(tagName, paths.empty() ? jointPath : paths + " " + jointPath);
}

bool carriesJoint(osg::Node& node) {
    if (const auto* joint = dynamic_cast<JointTransform*>(&node)) return !joint->getJoint().path.empty();
    std::string paths;
    return node.getUserValue(tagName, paths);
}

std::map<std::string, std::vector<osg::Node*>> findJointNodes(osg::Node& root) {
    std::map<std::string, std::vector<osg::Node*>> found;
    eachNode(root, [&](osg::Node& node) {
        const auto add = [&](const std::string& path) {
            std::vector<osg::Node*>& nodes = found[path];
            if (std::ranges::find(nodes, &node) == nodes.end()) nodes.push_back(&node);
        };
        if (const auto* joint = dynamic_cast<JointTransform*>(&node)) {
            if (!joint->getJoint().path.empty()) add(joint->getJoint().path);
            return;
        }
        std::string paths;
        node.getUserValue(tagName, paths);
        std::istringstream words(paths);
        for (std::string path; words >> path;) add(path);
    });
    return found;
}

} // namespace osgTSS
