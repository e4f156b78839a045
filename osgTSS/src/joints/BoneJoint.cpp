#include "JointKinds.h"

#include "BoneMotion.h"

#include <osg/ValueObject>
#include <osg/observer_ptr>
#include <osgAnimation/Skeleton>
#include <osgTSS/Convert>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgTSS {

namespace {

using osgAnimation::Bone;

const char* const frame0Tag = "osgTSS:frame0";
const char* const frame1Tag = "osgTSS:frame1";
const char* const standsTag = "osgTSS:stands";

/// A bone that stands between the one that moves and the one above that does.
struct Standing {
    osg::observer_ptr<Bone> bone;
    osg::Matrixd matrix;
    double still; ///< the turns that it may make all the same
};

std::vector<Standing> standingAbove(osg::Node& node) {
    std::vector<Standing> found;
    for (osg::Node* at = &node; at->getNumParents() > 0;) {
        at = at->getParent(0);
        osg::Matrixd matrix;
        if (dynamic_cast<osgAnimation::Skeleton*>(at) || at->getUserValue(frame0Tag, matrix)) break;
        if (auto* bone = dynamic_cast<Bone*>(at); bone && at->getUserValue(standsTag, matrix))
            found.push_back({bone, matrix, boneStill(*bone)});
    }
    return found;
}

bool alike(const osg::Matrixd& a, const osg::Matrixd& b, double turn) {
    const double size = 1 + std::max(a.getTrans().length(), b.getTrans().length());
    for (int i = 0; i < 16; ++i)
        if (!(std::abs(a.ptr()[i] - b.ptr()[i]) <= turn * size)) return false;
    return true;
}

class BoneNode : public JointNode {
public:
    BoneNode(Bone& bone, const tss::Joint& joint, const tss::Pose& frame0, const tss::Pose& frame1)
        : _bone(&bone), _joint(joint), _frame0(frame0), _frame1(frame1), _still(boneStill(bone)),
          _above(standingAbove(bone)) {
        std::size_t turns = 0;
        for (const tss::Dof& dof : joint.dofs) {
            int axis = 0;
            dof.axis.cwiseAbs().maxCoeff(&axis);
            _axes.push_back(axis);
            if (dof.kind == tss::DofKind::Rotation && turns < 3) _order[turns++] = axis;
        }
        _turns = turns;
        if (turns == 2) _order[2] = 3 - _order[0] - _order[1];
    }

    bool valid() const override { return _bone.valid(); }
    std::size_t dofCount() const override { return _axes.size(); }

    void restoreAsked() override {
        if (_stopped && _bone->getMatrix() == _shown) _bone->setMatrix(_asked);
    }

    std::vector<double> asked() const override { return look().values; }

    void show(const std::vector<double>& values) override {
        _stopped = values != look().values;
        if (!_stopped) return;
        _asked = _bone->getMatrix();
        _bone->setMatrix(matrixAt(values, look().scale));
        _shown = _bone->getMatrix();
    }

    std::optional<Stray> stray() const override {
        const std::vector<double>& values = look().values;
        for (std::size_t k = 0; k < _axes.size(); ++k)
            if (auto beyond = beyondLimits(_joint.dofs[k], values[k])) {
                beyond->unserved = true; // other keys than were known: they are played
                return beyond;
            }
        if (!look().fits) return Stray{"it stands as none of its degrees of freedom can place it", true};
        for (const Standing& standing : _above)
            if (standing.bone.valid() &&
                !alike(standing.bone->getMatrix(), standing.matrix, 2 * standing.still))
                return Stray{"bone " + standing.bone->getName() + " above it does not stand still", true};
        return std::nullopt;
    }

private:
    std::array<double, 3> anglesOf(const Eigen::Matrix3d& turned) const {
        if (_turns > 1) return turnsOf(turned, _order);
        if (_turns == 0) return {};
        const Eigen::Quaterniond q(turned);
        return {2 * std::atan2(q.vec()[_order[0]], q.w()), 0, 0};
    }

    /// What the joint knows of a matrix of the bone.
    struct Look {
        osg::Matrixd matrix;
        std::vector<double> values;
        double scale = 1;
        bool fits = false; ///< it is what the values give
    };

    /// Of the matrix now; asked for several times a frame.
    const Look& look() const {
        const osg::Matrixd& matrix = _bone->getMatrix();
        if (!_look.values.empty() && _look.matrix == matrix) return _look;
        _look.matrix = matrix;
        _look.values.assign(_axes.size(), 0);
        _look.fits = false;
        const auto rigid = toSimilarity(matrix);
        if (!rigid) return _look;
        _look.scale = rigid->scale;
        const tss::Pose moved = _frame0.inverse(Eigen::Isometry) * rigid->pose * _frame1;
        const std::array<double, 3> angles = anglesOf(moved.linear());
        std::size_t turn = 0;
        for (std::size_t k = 0; k < _axes.size(); ++k) {
            const tss::Dof& dof = _joint.dofs[k];
            if (dof.kind == tss::DofKind::Rotation) {
                const double angle = angles[turn++];
                _look.values[k] = angle - wholeTurns(angle, (dof.lower + dof.upper) / 2);
            } else {
                _look.values[k] = moved.translation()[_axes[k]];
            }
        }
        // As much as was taken for standing still, and its rounding.
        _look.fits = alike(matrix, matrixAt(_look.values, _look.scale), 2 * _still);
        return _look;
    }

    osg::Matrixd matrixAt(const std::vector<double>& values, double scale) const {
        tss::Pose moved = tss::Pose::Identity();
        for (std::size_t k = 0; k < _axes.size(); ++k)
            if (_joint.dofs[k].kind == tss::DofKind::Rotation)
                moved.rotate(Eigen::AngleAxisd(values[k], tss::Vec3::Unit(_axes[k])));
            else
                moved.translate(values[k] * tss::Vec3::Unit(_axes[k]));
        return osg::Matrixd::scale(scale, scale, scale) *
               toOsg(_frame0 * moved * _frame1.inverse(Eigen::Isometry));
    }

    osg::observer_ptr<Bone> _bone;
    tss::Joint _joint;
    tss::Pose _frame0, _frame1; ///< in the bone's own lengths, against its parent node
    double _still;
    std::vector<Standing> _above;
    std::vector<int> _axes; ///< of each DOF
    std::array<int, 3> _order{};
    std::size_t _turns = 0;
    bool _stopped = false;
    osg::Matrixd _asked, _shown;
    mutable Look _look;
};

std::optional<tss::Pose> frameOn(const osg::Node& node, const char* tag) {
    osg::Matrixd matrix;
    if (!node.getUserValue(tag, matrix)) return std::nullopt;
    const auto similarity = toSimilarity(matrix);
    return similarity ? std::optional<tss::Pose>(similarity->pose) : std::nullopt;
}

/// Nothing is written where it says so already: another graph may share the values.
void setFrame(osg::Node& node, const char* tag, const osg::Matrixd& matrix) {
    osg::Matrixd before;
    if (!node.getUserValue(tag, before) || before != matrix) node.setUserValue(tag, matrix);
}

} // namespace

std::optional<FoundJoints> boneJoint(osg::Node& node, const AnimationChannels& channels) {
    auto* bone = dynamic_cast<Bone*>(&node);
    if (!bone) return std::nullopt;
    FoundJoints found = boneMotion(*bone, channels);
    const tss::Joint& joint = found.joints.front();
    if (joint.dofs.empty()) {
        const double scale = found.scale;
        setFrame(node, standsTag, osg::Matrixd::scale(scale, scale, scale) * toOsg(joint.frame0));
        return std::nullopt;
    }
    setFrame(node, frame0Tag, toOsg(joint.frame0));
    setFrame(node, frame1Tag, toOsg(joint.frame1));
    return found;
}

std::optional<osg::Matrixd> standingBone(const osg::Node& node) {
    osg::Matrixd matrix;
    if (!dynamic_cast<const Bone*>(&node) || !node.getUserValue(standsTag, matrix)) return std::nullopt;
    return matrix;
}

std::unique_ptr<JointNode> makeBoneNode(osg::Node& node, const tss::Joint& joint) {
    auto* bone = dynamic_cast<Bone*>(&node);
    const auto frame0 = frameOn(node, frame0Tag), frame1 = frameOn(node, frame1Tag);
    if (!bone || !frame0 || !frame1) return nullptr;
    std::size_t turns = 0;
    for (const tss::Dof& dof : joint.dofs) {
        if (dof.kind == tss::DofKind::Path) return nullptr;
        if (dof.kind == tss::DofKind::Rotation) ++turns;
    }
    return turns <= 3 ? std::make_unique<BoneNode>(*bone, joint, *frame0, *frame1) : nullptr;
}

} // namespace osgTSS
