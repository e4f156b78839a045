#include "JointKinds.h"

#include "AxisDofs.h"
#include "BoneMotion.h"

#include <osg/ValueObject>
#include <osg/observer_ptr>
#include <osgAnimation/Skeleton>
#include <osgTSS/Convert>

#include <algorithm>
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

class BoneNode : public OverwrittenNode<Bone, osg::Matrixd> {
public:
    BoneNode(Bone& bone, const tss::Joint& joint, const tss::Pose& frame0, const tss::Pose& frame1)
        : OverwrittenNode(bone), _dofs(joint.dofs), _frame0(frame0), _frame1(frame1), _still(boneStill(bone)),
          _above(standingAbove(bone)) {}

    std::vector<double> asked() const override { return look().values; }

    std::optional<Stray> stray() const override {
        const std::vector<double>& values = look().values;
        for (std::size_t k = 0; k < values.size(); ++k)
            if (auto beyond = beyondLimits(_dofs.dofs()[k], values[k])) {
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
    /// What the joint knows of a matrix of the bone.
    struct Look {
        osg::Matrixd matrix;
        std::vector<double> values;
        double scale = 1;
        bool fits = false; ///< it is what the values give
    };

    /// What the bone's matrix says now; kept, as it is asked for several times a frame.
    const Look& look() const {
        const osg::Matrixd& matrix = _node->getMatrix();
        if (!_look.values.empty() && _look.matrix == matrix) return _look;
        _look.matrix = matrix;
        _look.values.assign(_dofs.dofs().size(), 0);
        _look.fits = false;
        const auto rigid = toSimilarity(matrix, _still);
        if (!rigid) return _look;
        _look.scale = rigid->scale;
        _look.values = _dofs.valuesOf(_frame0.inverse(Eigen::Isometry) * rigid->pose * _frame1);
        // As much as was taken for standing still, and its rounding.
        _look.fits = alike(matrix, matrixAt(_look.values, _look.scale), 2 * _still);
        return _look;
    }

    osg::Matrixd matrixAt(const std::vector<double>& values, double scale) const {
        return osg::Matrixd::scale(scale, scale, scale) *
               toOsg(_frame0 * _dofs.poseAt(values) * _frame1.inverse(Eigen::Isometry));
    }

    osg::Matrixd read() const override { return _node->getMatrix(); }
    void write(const osg::Matrixd& matrix) override { _node->setMatrix(matrix); }
    osg::Matrixd stateAt(const std::vector<double>& values) const override {
        return matrixAt(values, look().scale);
    }

    AxisDofs _dofs;
    tss::Pose _frame0, _frame1; ///< in the bone's own lengths, against its parent node
    double _still;
    std::vector<Standing> _above;
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
