#include "JointKinds.h"

#include "DofWords.h"

#include "bake/base/Error.h"

#include <osg/ValueObject>
#include <osg/observer_ptr>

#include <algorithm>
#include <array>
#include <map>

namespace osgTSS {

namespace {

/// An axis of a DOFTransform: heading turns about Z, pitch about X, roll about Y.
struct Axis {
    tss::DofKind kind;
    int direction; ///< 0 X, 1 Y, 2 Z
    float current, lower, upper, increment;
    bool limited; ///< the node's limitation flag
};

constexpr unsigned int firstFlag = 0x80000000u; // translations X Y Z, then pitch, roll, yaw

Axis translation(const osgSim::DOFTransform& node, int i) {
    return {tss::DofKind::Translation,
            i,
            node.getCurrentTranslate()[i],
            node.getMinTranslate()[i],
            node.getMaxTranslate()[i],
            node.getIncrementTranslate()[i],
            (node.getLimitationFlags() & (firstFlag >> i)) != 0};
}

/// i: index into HPR.
Axis turn(const osgSim::DOFTransform& node, int i) {
    constexpr std::array<int, 3> direction{2, 0, 1};
    constexpr std::array<int, 3> flag{5, 3, 4};
    return {tss::DofKind::Rotation,
            direction[i],
            node.getCurrentHPR()[i],
            node.getMinHPR()[i],
            node.getMaxHPR()[i],
            node.getIncrementHPR()[i],
            (node.getLimitationFlags() & (firstFlag >> flag[i])) != 0};
}

/// The node multiplies translations first and then the turns in the order of its name, seen as columns.
std::array<Axis, 6> axesInOrder(const osgSim::DOFTransform& node) {
    using osgSim::DOFTransform;
    static const std::map<DOFTransform::MultOrder, std::array<int, 3>> orders = {
        {DOFTransform::PRH, {1, 2, 0}}, {DOFTransform::PHR, {1, 0, 2}}, {DOFTransform::HPR, {0, 1, 2}},
        {DOFTransform::HRP, {0, 2, 1}}, {DOFTransform::RPH, {2, 1, 0}}, {DOFTransform::RHP, {2, 0, 1}}};
    const std::array<int, 3>& hpr = orders.at(node.getHPRMultOrder());
    return {translation(node, 0), translation(node, 1), translation(node, 2),
            turn(node, hpr[0]),   turn(node, hpr[1]),   turn(node, hpr[2])};
}

const char* const limitsTag = "osgTSS:limits";
const char* const writtenWord = "written"; ///< at its begin: the node's limits hold whatever its flags say

std::string nameOf(const Axis& axis) {
    return (axis.kind == tss::DofKind::Rotation ? "rot" : "trans") +
           std::string(1, char('X' + axis.direction));
}

/// What an application says of the axis, over what the node does.
const tss::Dof* given(const Axis& axis, const std::vector<tss::Dof>& limits) {
    for (const tss::Dof& dof : limits)
        if (dof.name == nameOf(axis)) return &dof;
    return nullptr;
}

/// The DOF that an axis is. One that the node does not limit turns without end: a whole turn. If it slides,
/// the limits that it has all the same are what tables are made for; without any it is taken to stay (lower =
/// upper) and named in `unlimited`.
tss::Dof dofOf(const Axis& axis, const std::vector<tss::Dof>& limits, std::string& unlimited) {
    tss::Dof dof;
    dof.kind = axis.kind;
    dof.name = nameOf(axis);
    dof.axis = tss::Vec3::Unit(axis.direction);
    dof.lower = axis.lower;
    dof.upper = axis.upper;
    double current = axis.current;
    if (const tss::Dof* said = given(axis, limits)) {
        dof.lower = said->lower;
        dof.upper = said->upper;
    } else if (!axis.limited && axis.kind == tss::DofKind::Rotation) {
        dof.lower = -osg::PI;
        dof.upper = osg::PI;
    } else if (!(axis.lower < axis.upper)) {
        dof.lower = dof.upper = axis.current;
        if (!axis.limited) unlimited += (unlimited.empty() ? "" : " ") + dof.name;
    }
    if (tss::wholeTurn(dof)) current = tss::nearestTurn(current, (dof.lower + dof.upper) / 2);
    dof.rest = std::min(std::max(current, dof.lower), dof.upper);
    return dof;
}

/// As the node moves: to and fro between its limits, upwards first, for one period; round and round without
/// limits.
tss::TimeSamples drive(const tss::Dof& dof, const Axis& axis, double rate) {
    tss::TimeSamples samples;
    if (!(axis.increment > 0) || !(dof.lower < dof.upper)) return samples;
    const double codesPerUnit = rate / axis.increment, range = dof.upper - dof.lower;
    const double top = (dof.upper - dof.rest) * codesPerUnit;
    const auto add = [&](double time, double value) {
        if (!samples.times.empty() && !(time > samples.times.back())) return;
        samples.times.push_back(time);
        samples.values.push_back(value);
    };
    const bool endless = !axis.limited && tss::wholeTurn(dof);
    const double back = endless ? 1e-6 * range * codesPerUnit : range * codesPerUnit;
    add(0, dof.rest);
    add(top, dof.upper);
    add(top + back, dof.lower);
    add(endless ? range * codesPerUnit : 2 * range * codesPerUnit, dof.rest);
    return samples;
}

/// Where a DOF stands in the node's vectors.
struct DofSlot {
    bool rotation;
    int component; ///< of HPR or of translate
    bool fullTurn; ///< limits of a whole turn or more: angles are told apart up to whole turns only
    tss::Dof dof;
};

/// The nearest of the angles that a slot does not tell apart.
double nearest(const DofSlot& slot, double value, double to) {
    return slot.fullTurn ? tss::nearestTurn(value, to) : value;
}

class DofTransformNode : public JointNode {
public:
    DofTransformNode(osgSim::DOFTransform& node, std::vector<DofSlot> slots)
        : _node(&node), _slots(std::move(slots)), _scale(node.getCurrentScale()), _put(node.getPutMatrix()),
          _inversePut(node.getInversePutMatrix()) {}

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
            values.push_back(nearest(slot, value, (slot.dof.lower + slot.dof.upper) / 2));
        }
        return values;
    }

    std::optional<Stray> stray() const override {
        const std::vector<double> values = asked();
        for (int turn = 0; turn < 2; ++turn)
            for (int i = 0; i < 3; ++i) {
                const bool known = std::ranges::any_of(_slots, [&](const DofSlot& slot) {
                    return slot.rotation == (turn == 1) && slot.component == i;
                });
                const float value = (turn ? _node->getCurrentHPR() : _node->getCurrentTranslate())[i];
                if (!known && value != 0)
                    return Stray{std::string("its ") + (turn ? "turn" : "slide") + " " +
                                     (turn ? "HPR" : "XYZ")[i] + " is " + std::to_string(value) +
                                     ", and was taken to stay 0",
                                 true};
            }
        if (_node->getCurrentScale() != _scale) return Stray{"its scale has changed", true};
        if (_node->getPutMatrix() != _put || _node->getInversePutMatrix() != _inversePut)
            return Stray{"its put matrix has changed", true};
        for (std::size_t k = 0; k < _slots.size(); ++k) {
            auto beyond = beyondLimits(_slots[k].dof, values[k]);
            if (!beyond) continue;
            beyond->unserved = _slots[k].dof.lower == _slots[k].dof.upper;
            return beyond;
        }
        return std::nullopt;
    }

    void show(const std::vector<double>& values) override {
        _askedHPR = _shownHPR = _node->getCurrentHPR();
        _askedTranslate = _shownTranslate = _node->getCurrentTranslate();
        for (std::size_t k = 0; k < _slots.size(); ++k) {
            float& value = (_slots[k].rotation ? _shownHPR : _shownTranslate)[_slots[k].component];
            // What was not changed keeps its bits.
            if (values[k] != nearest(_slots[k], value, (_slots[k].dof.lower + _slots[k].dof.upper) / 2))
                value = static_cast<float>(nearest(_slots[k], values[k], value));
        }
        _stopped = _shownHPR != _askedHPR || _shownTranslate != _askedTranslate;
        if (!_stopped) return;
        _node->setCurrentHPR(_shownHPR);
        _node->setCurrentTranslate(_shownTranslate);
    }

private:
    osg::observer_ptr<osgSim::DOFTransform> _node;
    std::vector<DofSlot> _slots;
    osg::Vec3 _scale;
    osg::Matrix _put, _inversePut;
    bool _stopped = false;
    osg::Vec3 _askedHPR, _askedTranslate, _shownHPR, _shownTranslate;
};

} // namespace

FoundJoints dofTransformJoint(const osgSim::DOFTransform& node, double timeCodesPerSecond) {
    const osg::Vec3 scale = node.getCurrentScale();
    if (scale == osg::Vec3())
        throw tss::InputError(
            "its scale is 0, as OpenSceneGraph sets it: setCurrentScale(osg::Vec3(1, 1, 1))");
    FoundJoints found;
    found.scale = evenScale(scale, found.off);
    if (found.scale == 0 || (node.getAnimationOn() && node.getIncrementScale() != osg::Vec3()))
        throw tss::InputError("expected a scale that is the same in all directions and at all times; tables "
                              "are for rigid bodies");
    tss::Joint joint;
    joint.frame0 = rigid(node.getInversePutMatrix(), "inverse put matrix", &found.off);
    // Scaled after the put matrix: x -> s (put x) = (put with its translation scaled) (s x).
    tss::Pose put = rigid(node.getPutMatrix(), "put matrix", &found.off);
    put.translation() *= found.scale;
    joint.frame1 = put.inverse(Eigen::Isometry);
    std::string words;
    node.getUserValue(limitsTag, words);
    const bool written = words.rfind(writtenWord, 0) == 0;
    if (written) words.erase(0, std::string(writtenWord).size());
    const std::vector<tss::Dof> limits = parseDofWords(words, limitsTag);
    int free = 0;
    for (Axis axis : axesInOrder(node)) {
        axis.limited = axis.limited || written;
        const tss::Dof dof = dofOf(axis, limits, found.unlimited);
        if (!axis.limited && !given(axis, limits) && tss::wholeTurn(dof))
            found.turning += (free++ > 0 ? " " : "") + dof.name;
        if (dof.lower == 0 && dof.upper == 0) continue; // locked where it does nothing
        joint.drives.push_back(node.getAnimationOn() ? drive(dof, axis, timeCodesPerSecond)
                                                     : tss::TimeSamples{});
        joint.dofs.push_back(dof);
    }
    if (free < 2) found.turning.clear();
    found.joints = {joint};
    return found;
}

/// Heading turns about Z, pitch about X, roll about Y.
std::unique_ptr<JointNode> makeDofTransformNode(osgSim::DOFTransform& node, const tss::Joint& joint) {
    constexpr int componentOfAxis[3] = {1, 2, 0};
    std::vector<DofSlot> slots;
    for (const tss::Dof& dof : joint.dofs) {
        Eigen::Index axis = 0;
        dof.axis.cwiseAbs().maxCoeff(&axis);
        // Of any length, below 0 under a mirror: a value is that of the node's own units.
        if (dof.kind == tss::DofKind::Path || dof.axis != tss::Vec3(tss::Vec3::Unit(axis) * dof.axis[axis]))
            return nullptr;
        const bool rotation = dof.kind == tss::DofKind::Rotation;
        const bool fullTurn = rotation && dof.upper - dof.lower >= 2 * osg::PI * (1 - 1e-6);
        slots.push_back({rotation, rotation ? componentOfAxis[axis] : static_cast<int>(axis), fullTurn, dof});
    }
    return std::make_unique<DofTransformNode>(node, std::move(slots));
}

} // namespace osgTSS
