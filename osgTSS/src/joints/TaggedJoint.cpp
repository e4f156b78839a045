#include "JointKinds.h"

#include "AxisDofs.h"
#include "osgTSS/src/NodePaths.h"

#include "bake/base/Error.h"

#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osg/PositionAttitudeTransform>
#include <osg/ValueObject>
#include <osgTSS/Convert>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgTSS {

namespace {

const char* const dofsTag = "osgTSS:dofs";
const char* const pivotTag = "osgTSS:pivot";
const char* const restTag = "osgTSS:rest";

tss::Vec3 taggedPivot(const osg::Node& node) {
    osg::Vec3d pivot;
    osg::Vec3f single;
    if (!node.getUserValue(pivotTag, pivot) && node.getUserValue(pivotTag, single)) pivot = single;
    return toCore(pivot);
}

/// Slides before turns, each axis once, with limits that hold 0.
std::vector<tss::Dof> dofsOf(const osg::Node& node) {
    std::string text;
    node.getUserValue(dofsTag, text);
    const std::vector<tss::Dof> dofs = parseDofWords(text, dofsTag);
    const auto expected = [&](const std::string& what) {
        return tss::InputError(std::string(dofsTag) + ": expected " + what + ", found \"" + text + "\"");
    };
    for (auto dof = dofs.begin(); dof != dofs.end(); ++dof) {
        if (!(dof->lower <= 0 && 0 <= dof->upper)) throw expected("limits that hold 0");
        for (auto other = dofs.begin(); other != dof; ++other)
            if (other->name == dof->name ||
                (other->kind == tss::DofKind::Rotation && dof->kind == tss::DofKind::Translation))
                throw expected("each axis once and slides before turns");
    }
    return dofs;
}

bool isFinite(const osg::Matrixd& matrix) {
    return std::all_of(matrix.ptr(), matrix.ptr() + 16, [](double value) { return std::isfinite(value); });
}

/// The node's matrix by the values of its DOFs, and back: M = rest pivot D pivot^-1 as columns.
class TaggedNode : public OverwrittenNode<osg::Transform, osg::Matrixd> {
public:
    TaggedNode(osg::Transform& node, const std::vector<tss::Dof>& dofs, const osg::Matrixd& rest)
        : OverwrittenNode(node), _dofs(dofs),
          _toRest(osg::Matrixd::translate(toOsg(taggedPivot(node))) * rest),
          _fromPivot(osg::Matrixd::translate(-toOsg(taggedPivot(node)))) {}

    std::vector<double> asked() const override {
        const osg::Matrixd now = ownMatrix(*_node);
        const std::size_t count = _dofs.dofs().size();
        if (!isFinite(now)) return std::vector<double>(count, std::numeric_limits<double>::quiet_NaN());
        const auto rigid =
            toSimilarity(osg::Matrixd::inverse(_fromPivot) * now * osg::Matrixd::inverse(_toRest));
        // Another matrix than such a joint can have: as at rest.
        return rigid ? _dofs.valuesOf(rigid->pose) : std::vector<double>(count, 0);
    }

    std::optional<Stray> stray() const override {
        const std::vector<double> values = asked();
        const osg::Matrixd now = ownMatrix(*_node), known = stateAt(values);
        const double size = 1 + osg::Vec3d(now.getTrans() - _toRest.getTrans()).length();
        double scale = 0;
        for (int i = 0; i < 12; ++i) scale = std::max(scale, std::abs(_toRest.ptr()[i]));
        for (int i = 0; i < 16 && isFinite(now); ++i)
            if (!(std::abs(now.ptr()[i] - known.ptr()[i]) <= 1e-4 * (i < 12 ? scale : size)))
                return Stray{"it stands as none of its degrees of freedom can place it", true};
        for (std::size_t k = 0; k < values.size(); ++k)
            if (auto beyond = beyondLimits(_dofs.dofs()[k], values[k])) return beyond;
        return std::nullopt;
    }

private:
    osg::Matrixd read() const override { return ownMatrix(*_node); }

    osg::Matrixd stateAt(const std::vector<double>& values) const override {
        return _fromPivot * toOsg(_dofs.poseAt(values)) * _toRest;
    }

    void write(const osg::Matrixd& matrix) override {
        if (!isFinite(matrix)) return; // what is no number is not wished for again
        if (auto* transform = dynamic_cast<osg::MatrixTransform*>(_node.get()))
            return transform->setMatrix(matrix);
        auto& transform = static_cast<osg::PositionAttitudeTransform&>(*_node);
        // Whatever the node's own scale mirrors, it goes on mirroring.
        osg::Matrixd turned = osg::Matrixd::inverse(osg::Matrixd::scale(transform.getScale())) * matrix;
        turned.setTrans(0, 0, 0);
        transform.setAttitude(turned.getRotate());
        transform.setPosition(transform.getPivotPoint() * matrix);
    }

    AxisDofs _dofs;
    osg::Matrixd _toRest, _fromPivot;
};

} // namespace

bool isTagged(const osg::Node& node) {
    std::string dofs;
    return node.getUserValue(dofsTag, dofs);
}

FoundJoints taggedJoint(osg::Transform& node) {
    if (!dynamic_cast<osg::MatrixTransform*>(&node) && !dynamic_cast<osg::PositionAttitudeTransform*>(&node))
        throw tss::InputError(std::string(dofsTag) +
                              ": expected it on a MatrixTransform or a PositionAttitudeTransform");
    osg::Matrixd rest;
    if (!node.getUserValue(restTag, rest)) {
        rest = ownMatrix(node);
        node.setUserValue(restTag, rest);
    }
    const auto similarity = toSimilarity(rest);
    if (!similarity)
        throw tss::InputError("its matrix shears, or scales axes differently: expected equal scales");
    tss::Joint joint;
    joint.frame0.translation() = joint.frame1.translation() = taggedPivot(node);
    joint.dofs = dofsOf(node);
    if (joint.dofs.empty()) throw tss::InputError(std::string(dofsTag) + ": expected a DOF, found none");
    joint.drives.resize(joint.dofs.size());
    scaleLengths(joint, similarity->scale);
    joint.frame0 = similarity->pose * joint.frame0;
    return {{joint}, similarity->scale};
}

std::unique_ptr<JointNode> makeTaggedNode(osg::Node& node, const tss::Joint& joint) {
    auto* transform = node.asTransform();
    osg::Matrixd rest;
    if (!transform || !node.getUserValue(restTag, rest)) return nullptr;
    std::vector<tss::Dof> dofs;
    try {
        dofs = dofsOf(node);
    } catch (const tss::InputError& error) { // the application has changed its words since
        OSG_WARN << "osgTSS: node \"" << node.getName() << "\": " << error.message << std::endl;
    }
    if (dofs.size() != joint.dofs.size()) return nullptr;
    return std::make_unique<TaggedNode>(*transform, dofs, rest);
}

} // namespace osgTSS
