#include "JointKinds.h"

#include "DofWords.h"

#include "bake/base/Error.h"

#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osg/PositionAttitudeTransform>
#include <osg/ValueObject>
#include <osg/observer_ptr>
#include <osgTSS/Convert>

#include <algorithm>
#include <sstream>

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

osg::Matrixd matrixOf(const osg::Transform& node) {
    osg::Matrixd matrix;
    node.computeLocalToWorldMatrix(matrix, nullptr);
    return matrix;
}

/// "rotZ:-24:18"
tss::Dof parse(const std::string& word) {
    const tss::Dof dof = parseDofWord(word, dofsTag);
    if (!(dof.lower <= 0 && 0 <= dof.upper))
        throw tss::InputError(std::string(dofsTag) + ": expected limits that hold 0, found \"" + word + "\"");
    return dof;
}

std::vector<tss::Dof> dofsOf(const osg::Node& node) {
    std::string text;
    node.getUserValue(dofsTag, text);
    std::istringstream words(text);
    std::vector<tss::Dof> dofs;
    for (std::string word; words >> word;) {
        const tss::Dof dof = parse(word);
        for (const tss::Dof& other : dofs)
            if (other.name == dof.name ||
                (other.kind == tss::DofKind::Rotation && dof.kind == tss::DofKind::Translation))
                throw tss::InputError(std::string(dofsTag) +
                                      ": expected each axis once and slides before turns, found \"" + text +
                                      "\"");
        dofs.push_back(dof);
    }
    return dofs;
}

bool isFinite(const osg::Matrixd& matrix) {
    return std::all_of(matrix.ptr(), matrix.ptr() + 16, [](double value) { return std::isfinite(value); });
}

/// The node's matrix by the values of its DOFs, and back: M = rest pivot D pivot^-1 as columns.
class TaggedNode : public JointNode {
public:
    TaggedNode(osg::Transform& node, const std::vector<tss::Dof>& dofs, const osg::Matrixd& rest)
        : _node(&node), _toRest(osg::Matrixd::translate(toOsg(taggedPivot(node))) * rest),
          _fromPivot(osg::Matrixd::translate(-toOsg(taggedPivot(node)))) {
        std::vector<int> order;
        for (const tss::Dof& dof : dofs) {
            Eigen::Index axis = 0;
            dof.axis.cwiseAbs().maxCoeff(&axis);
            const bool turn = dof.kind == tss::DofKind::Rotation;
            if (turn) order.push_back(static_cast<int>(axis));
            _slots.push_back({turn, turn ? order.size() - 1 : static_cast<std::size_t>(axis), dof});
        }
        for (int axis = 0; axis < 3; ++axis)
            if (std::ranges::find(order, axis) == order.end()) order.push_back(axis);
        std::copy_n(order.begin(), 3, _order.begin());
    }

    bool valid() const override { return _node.valid(); }
    std::size_t dofCount() const override { return _slots.size(); }

    void restoreAsked() override {
        if (_stopped && matrixOf(*_node) == _shown) write(_asked);
    }

    std::vector<double> asked() const override {
        if (!isFinite(matrixOf(*_node)))
            return std::vector<double>(_slots.size(), std::numeric_limits<double>::quiet_NaN());
        const osg::Matrixd moved =
            osg::Matrixd::inverse(_fromPivot) * matrixOf(*_node) * osg::Matrixd::inverse(_toRest);
        const auto rigid = toSimilarity(moved);
        std::vector<double> values(_slots.size());
        if (!rigid) return values; // another matrix than such a joint can have: as at rest
        const auto turns = turnsWithin(rigid->pose.linear());
        for (std::size_t k = 0; k < _slots.size(); ++k) {
            const Slot& slot = _slots[k];
            values[k] = slot.turn ? turns[slot.index] -
                                        wholeTurns(turns[slot.index], (slot.dof.lower + slot.dof.upper) / 2)
                                  : rigid->pose.translation()[static_cast<Eigen::Index>(slot.index)];
        }
        return values;
    }

    void show(const std::vector<double>& values) override {
        if (values == asked()) {
            _stopped = false;
            return;
        }
        _asked = matrixOf(*_node);
        _stopped = isFinite(_asked); // what is no number is not wished for again
        write(matrixAt(values));
        _shown = matrixOf(*_node);
    }

    std::optional<Stray> stray() const override {
        const std::vector<double> values = asked();
        const osg::Matrixd now = matrixOf(*_node), known = matrixAt(values);
        const double size = 1 + osg::Vec3d(now.getTrans() - _toRest.getTrans()).length();
        double scale = 0;
        for (int i = 0; i < 12; ++i) scale = std::max(scale, std::abs(_toRest.ptr()[i]));
        for (int i = 0; i < 16 && isFinite(now); ++i)
            if (!(std::abs(now.ptr()[i] - known.ptr()[i]) <= 1e-4 * (i < 12 ? scale : size)))
                return Stray{"it stands as none of its degrees of freedom can place it", true};
        for (std::size_t k = 0; k < _slots.size(); ++k)
            if (auto beyond = beyondLimits(_slots[k].dof, values[k])) return beyond;
        return std::nullopt;
    }

private:
    struct Slot {
        bool turn;
        std::size_t index; ///< of a turn its place in the order, of a slide its axis
        tss::Dof dof;
    };

    /// Of the two ways in which three turns make a rotation the one that the limits allow, or nearly.
    std::array<double, 3> turnsWithin(const Eigen::Matrix3d& rotation) const {
        const std::array<double, 3> first = turnsOf(rotation, _order),
                                    other{first[0] + osg::PI, osg::PI - first[1], first[2] + osg::PI};
        const auto beyond = [&](const std::array<double, 3>& turns) {
            double sum = 0;
            std::array<bool, 3> has{};
            for (const Slot& slot : _slots) {
                if (!slot.turn) continue;
                has[slot.index] = true;
                const double value =
                    turns[slot.index] - wholeTurns(turns[slot.index], (slot.dof.lower + slot.dof.upper) / 2);
                sum += std::max({0.0, slot.dof.lower - value, value - slot.dof.upper});
            }
            for (std::size_t k = 0; k < has.size(); ++k) // a turn that the node does not have
                if (!has[k]) sum += std::abs(turns[k] - wholeTurns(turns[k], 0));
            return sum;
        };
        return beyond(other) < beyond(first) - 1e-9 ? other : first;
    }

    osg::Matrixd matrixAt(const std::vector<double>& values) const {
        tss::Pose moved = tss::Pose::Identity();
        for (std::size_t k = 0; k < _slots.size(); ++k) {
            const Slot& slot = _slots[k];
            if (slot.turn)
                moved.rotate(Eigen::AngleAxisd(values[k], tss::Vec3::Unit(_order[slot.index])));
            else
                moved.translate(values[k] * tss::Vec3::Unit(static_cast<Eigen::Index>(slot.index)));
        }
        return _fromPivot * toOsg(moved) * _toRest;
    }

    void write(const osg::Matrixd& matrix) {
        if (auto* transform = dynamic_cast<osg::MatrixTransform*>(_node.get()))
            return transform->setMatrix(matrix);
        auto& transform = static_cast<osg::PositionAttitudeTransform&>(*_node);
        // Whatever the node's own scale mirrors, it goes on mirroring.
        osg::Matrixd turned = osg::Matrixd::inverse(osg::Matrixd::scale(transform.getScale())) * matrix;
        turned.setTrans(0, 0, 0);
        transform.setAttitude(turned.getRotate());
        transform.setPosition(transform.getPivotPoint() * matrix);
    }

    osg::observer_ptr<osg::Transform> _node;
    osg::Matrixd _toRest, _fromPivot;
    std::vector<Slot> _slots;
    std::array<int, 3> _order{};
    bool _stopped = false;
    osg::Matrixd _asked, _shown;
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
        rest = matrixOf(node);
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
