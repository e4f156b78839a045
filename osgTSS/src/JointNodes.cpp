#include "JointNodes.h"

#include <osg/NodeVisitor>
#include <osg/ValueObject>
#include <osg/observer_ptr>
#include <osgSim/DOFTransform>
#include <osgTSS/JointTransform>

#include <cmath>

namespace osgTSS {

namespace {

const char* const tagName = "osgTSS:joint";

class JointTransformNode : public JointNode {
public:
    explicit JointTransformNode(JointTransform& node) : _node(&node), _dofs(node.getNumDofs()) {}

    bool valid() const override { return _node.valid() && _node->getNumDofs() == _dofs; }
    std::size_t dofCount() const override { return _dofs; }
    void restoreAsked() override {} // it keeps the two apart itself
    std::vector<double> asked() const override { return _node->getAskedValues(); }
    std::vector<double> shown() const override { return _node->getValues(); }
    void show(const std::vector<double>& values) override { _node->setResolvedValues(values); }

private:
    osg::observer_ptr<JointTransform> _node;
    std::size_t _dofs;
};

/// Where a DOF stands in the node's vectors.
struct DofSlot {
    bool rotation;
    int component; ///< of HPR or of translate
    bool fullTurn; ///< limits of a whole turn or more: angles are told apart up to whole turns only
    double middle; ///< of the limits
};

class DofTransformNode : public JointNode {
public:
    DofTransformNode(osgSim::DOFTransform& node, std::vector<DofSlot> slots)
        : _node(&node), _slots(std::move(slots)) {}

    bool valid() const override { return _node.valid(); }
    std::size_t dofCount() const override { return _slots.size(); }

    void restoreAsked() override {
        if (!_stopped || _node->getCurrentHPR() != _shownHPR ||
            _node->getCurrentTranslate() != _shownTranslate)
            return;
        _node->setCurrentHPR(_askedHPR);
        _node->setCurrentTranslate(_askedTranslate);
    }

    std::vector<double> asked() const override {
        std::vector<double> values;
        for (const DofSlot& slot : _slots) {
            const double value =
                (slot.rotation ? _node->getCurrentHPR() : _node->getCurrentTranslate())[slot.component];
            values.push_back(value - wholeTurns(slot, value));
        }
        return values;
    }
    std::vector<double> shown() const override { return asked(); }

    void show(const std::vector<double>& values) override {
        _askedHPR = _shownHPR = _node->getCurrentHPR();
        _askedTranslate = _shownTranslate = _node->getCurrentTranslate();
        for (std::size_t k = 0; k < _slots.size(); ++k) {
            float& value = (_slots[k].rotation ? _shownHPR : _shownTranslate)[_slots[k].component];
            value = static_cast<float>(values[k] + wholeTurns(_slots[k], value));
        }
        _stopped = _shownHPR != _askedHPR || _shownTranslate != _askedTranslate;
        if (!_stopped) return;
        _node->setCurrentHPR(_shownHPR);
        _node->setCurrentTranslate(_shownTranslate);
    }

private:
    static double wholeTurns(const DofSlot& slot, double value) {
        return slot.fullTurn ? 2 * osg::PI * std::round((value - slot.middle) / (2 * osg::PI)) : 0;
    }

    osg::observer_ptr<osgSim::DOFTransform> _node;
    std::vector<DofSlot> _slots;
    bool _stopped = false;
    osg::Vec3 _askedHPR, _askedTranslate, _shownHPR, _shownTranslate;
};

/// Heading turns about Z, pitch about X, roll about Y.
std::unique_ptr<JointNode> makeDofTransformNode(osgSim::DOFTransform& node, const tss::Joint& joint) {
    constexpr int componentOfAxis[3] = {1, 2, 0};
    std::vector<DofSlot> slots;
    for (const tss::Dof& dof : joint.dofs) {
        Eigen::Index axis = 0;
        const double length = dof.axis.cwiseAbs().maxCoeff(&axis);
        if (dof.kind == tss::DofKind::Path || dof.axis != tss::Vec3(tss::Vec3::Unit(axis) * length))
            return nullptr;
        const bool rotation = dof.kind == tss::DofKind::Rotation;
        const bool fullTurn = rotation && dof.upper - dof.lower >= 2 * osg::PI * (1 - 1e-6);
        slots.push_back({rotation, rotation ? componentOfAxis[axis] : static_cast<int>(axis), fullTurn,
                         (dof.lower + dof.upper) / 2});
    }
    return std::make_unique<DofTransformNode>(node, std::move(slots));
}

class FindJointNodes : public osg::NodeVisitor {
public:
    FindJointNodes() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Node& node) override {
        std::string path;
        if (auto* joint = dynamic_cast<JointTransform*>(&node))
            path = joint->getJoint().path;
        else
            node.getUserValue(tagName, path);
        if (!path.empty()) found.emplace(path, &node);
        traverse(node);
    }

    std::map<std::string, osg::Node*> found;
};

} // namespace

std::unique_ptr<JointNode> makeJointNode(osg::Node& node, const tss::Joint& joint) {
    if (auto* transform = dynamic_cast<JointTransform*>(&node)) {
        if (transform->getNumDofs() != joint.dofs.size()) return nullptr;
        return std::make_unique<JointTransformNode>(*transform);
    }
    if (auto* transform = dynamic_cast<osgSim::DOFTransform*>(&node))
        return makeDofTransformNode(*transform, joint);
    return nullptr;
}

void tagJoint(osg::Node& node, const std::string& jointPath) {
    if (auto* joint = dynamic_cast<JointTransform*>(&node))
        joint->setPath(jointPath);
    else
        node.setUserValue(tagName, jointPath);
}

std::map<std::string, osg::Node*> findJointNodes(osg::Node& root) {
    FindJointNodes visitor;
    root.accept(visitor);
    return visitor.found;
}

} // namespace osgTSS
