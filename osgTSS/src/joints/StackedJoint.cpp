#include "JointKinds.h"

#include "StackedDof.h"
#include "osgTSS/src/CallbackOf.h"

#include "bake/base/Error.h"

#include <osg/MatrixTransform>
#include <osg/observer_ptr>
#include <osgAnimation/Bone>

#include <algorithm>

namespace osgTSS {

namespace {

/// Collects DOFs and fixed parts, from the parent inwards, into as few joints as a file can hold: those whose
/// DOFs share a frame, each axis once.
class ChainMaker {
public:
    void addFixed(const tss::Pose& pose) { _fixed = _fixed * pose; }

    /// The DOF acts along or about X, Y or Z of `axes`, a frame turned against the stack's.
    void addDof(const tss::Dof& dof, const tss::TimeSamples& drive, const Eigen::Quaterniond& axes) {
        addFixed(tss::Pose(axes));
        const bool moved = (_fixed.matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff() > 1e-12;
        if (_joints.empty() || moved || has(_joints.back(), dof)) {
            _joints.emplace_back();
            _joints.back().frame0 = _fixed;
            _fixed = tss::Pose::Identity();
        }
        _joints.back().dofs.push_back(dof);
        _joints.back().drives.push_back(drive);
        addFixed(tss::Pose(axes.conjugate()));
    }

    std::vector<tss::Joint> finish() {
        if (!_joints.empty()) _joints.back().frame1 = _fixed.inverse(Eigen::Isometry);
        return std::move(_joints);
    }

private:
    static bool has(const tss::Joint& joint, const tss::Dof& dof) {
        return std::ranges::any_of(joint.dofs, [&](const tss::Dof& other) {
            return other.kind == dof.kind && other.axis == dof.axis;
        });
    }

    std::vector<tss::Joint> _joints;
    tss::Pose _fixed = tss::Pose::Identity(); ///< since the last DOF
};

class StackedNode : public OverwrittenNode<osg::MatrixTransform, std::vector<double>> {
public:
    StackedNode(osg::MatrixTransform& node, osgAnimation::UpdateMatrixTransform& animation,
                std::vector<StackedDof> dofs)
        : OverwrittenNode(node), _animation(&animation), _dofs(std::move(dofs)) {}

    bool valid() const override { return _node.valid() && _animation.valid(); }

    std::vector<double> asked() const override {
        std::vector<double> values;
        for (const StackedDof& dof : _dofs) values.push_back(dof.value());
        return values;
    }

private:
    std::vector<double> read() const override { return asked(); }
    std::vector<double> stateAt(const std::vector<double>& values) const override { return values; }
    void write(const std::vector<double>& values) override {
        for (std::size_t k = 0; k < _dofs.size(); ++k) _dofs[k].setValue(values[k]);
        _node->setMatrix(stackMatrix(_animation->getStackedTransforms()));
    }

    osg::observer_ptr<osgAnimation::UpdateMatrixTransform> _animation;
    std::vector<StackedDof> _dofs;
};

} // namespace

osgAnimation::UpdateMatrixTransform* stackOf(osg::Node& node) {
    if (!dynamic_cast<osg::MatrixTransform*>(&node) || dynamic_cast<osgAnimation::Bone*>(&node))
        return nullptr;
    return callbackOf<osgAnimation::UpdateMatrixTransform>(node.getUpdateCallback());
}

FoundJoints stackedJoints(const osg::Node& node, osgAnimation::UpdateMatrixTransform& animation,
                          const AnimationChannels& channels, double timeCodesPerSecond) {
    ChainMaker chain;
    for (const auto& element : animation.getStackedTransforms()) {
        const std::vector<MovedAxis> moved =
            movedAxes(*element, node, channels, animation.getName(), timeCodesPerSecond);
        for (const MovedAxis& axis : moved) chain.addDof(axis.dof, axis.drive, axis.axes);
        if (moved.empty())
            chain.addFixed(rigid(element->getAsMatrix(), ("element " + element->getName()).c_str()));
    }
    FoundJoints found{chain.finish()};
    if (found.joints.empty()) throw tss::InputError("no channel moves an element of its stack");
    return found;
}

std::unique_ptr<JointNode> makeStackedNode(osg::Node& node, const tss::Joint& joint) {
    osgAnimation::UpdateMatrixTransform* animation = stackOf(node);
    if (!animation) return nullptr;
    std::vector<StackedDof> dofs = findStackedDofs(*animation, joint);
    if (dofs.empty()) return nullptr;
    return std::make_unique<StackedNode>(static_cast<osg::MatrixTransform&>(node), *animation,
                                         std::move(dofs));
}

} // namespace osgTSS
