#include "JointKinds.h"

#include "AxisDofs.h"
#include "DofState.h"

#include "bake/base/Error.h"

#include <osg/ValueObject>

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

/// At a place of the node's DofState.
Axis axisAt(const osgSim::DOFTransform& node, std::size_t place) {
    constexpr std::array<int, 6> direction{0, 1, 2, 2, 0, 1}, flag{0, 1, 2, 5, 3, 4};
    const auto of = [&](const osg::Vec3& translate, const osg::Vec3& hpr) {
        return place < 3 ? translate[place] : hpr[place - 3];
    };
    return {place < 3 ? tss::DofKind::Translation : tss::DofKind::Rotation,
            direction[place],
            of(node.getCurrentTranslate(), node.getCurrentHPR()),
            of(node.getMinTranslate(), node.getMinHPR()),
            of(node.getMaxTranslate(), node.getMaxHPR()),
            of(node.getIncrementTranslate(), node.getIncrementHPR()),
            (node.getLimitationFlags() & (firstFlag >> flag[place])) != 0};
}

/// The node multiplies translations first and then the turns in the order of its name, seen as columns.
std::vector<Axis> axesInOrder(const osgSim::DOFTransform& node) {
    using osgSim::DOFTransform;
    static const std::map<DOFTransform::MultOrder, std::array<std::size_t, 3>> orders = {
        {DOFTransform::PRH, {4, 5, 3}}, {DOFTransform::PHR, {4, 3, 5}}, {DOFTransform::HPR, {3, 4, 5}},
        {DOFTransform::HRP, {3, 5, 4}}, {DOFTransform::RPH, {5, 4, 3}}, {DOFTransform::RHP, {5, 3, 4}}};
    std::vector<Axis> axes{axisAt(node, 0), axisAt(node, 1), axisAt(node, 2)};
    for (const std::size_t place : orders.at(node.getHPRMultOrder())) axes.push_back(axisAt(node, place));
    return axes;
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
        tss::setWholeTurn(dof);
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

constexpr std::array<const char*, 6> stateNames{"slide X", "slide Y", "slide Z",
                                                "turn H",  "turn P",  "turn R"};

/// Where a DOF stands in the node.
struct DofSlot {
    std::size_t place; ///< in the node's DofState
    bool fullTurn;     ///< limits of a whole turn or more: angles are told apart up to whole turns only
    tss::Dof dof;

    /// The nearest of the angles that it does not tell apart.
    double nearest(double value, double to) const { return fullTurn ? tss::nearestTurn(value, to) : value; }
    double valueIn(const DofState& state) const { return nearest(state[place], (dof.lower + dof.upper) / 2); }
};

class DofTransformNode : public OverwrittenNode<osgSim::DOFTransform, DofState> {
public:
    DofTransformNode(osgSim::DOFTransform& node, std::vector<DofSlot> slots)
        : OverwrittenNode(node), _slots(std::move(slots)), _scale(node.getCurrentScale()),
          _put(node.getPutMatrix()), _inversePut(node.getInversePutMatrix()) {}

    std::vector<double> asked() const override {
        const DofState state = read();
        std::vector<double> values;
        for (const DofSlot& slot : _slots) values.push_back(slot.valueIn(state));
        return values;
    }

    std::optional<Stray> stray() const override {
        const DofState state = read();
        for (std::size_t place = 0; place < state.size(); ++place)
            if (state[place] != 0 && std::ranges::find(_slots, place, &DofSlot::place) == _slots.end())
                return Stray{std::string("its ") + stateNames[place] + " is " + std::to_string(state[place]) +
                                 ", and was taken to stay 0",
                             true};
        if (_node->getCurrentScale() != _scale) return Stray{"its scale has changed", true};
        if (_node->getPutMatrix() != _put || _node->getInversePutMatrix() != _inversePut)
            return Stray{"its put matrix has changed", true};
        for (const DofSlot& slot : _slots) {
            auto beyond = beyondLimits(slot.dof, slot.valueIn(state));
            if (!beyond) continue;
            beyond->unserved = slot.dof.lower == slot.dof.upper;
            return beyond;
        }
        return std::nullopt;
    }

private:
    DofState read() const override { return dofState(*_node); }
    void write(const DofState& state) override { setDofState(*_node, state); }
    DofState stateAt(const std::vector<double>& values) const override {
        DofState state = read();
        for (std::size_t k = 0; k < _slots.size(); ++k) {
            float& value = state[_slots[k].place];
            // What was not changed keeps its bits.
            if (values[k] != _slots[k].valueIn(state))
                value = static_cast<float>(_slots[k].nearest(values[k], value));
        }
        return state;
    }

    std::vector<DofSlot> _slots;
    osg::Vec3 _scale;
    osg::Matrix _put, _inversePut;
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

std::unique_ptr<JointNode> makeDofTransformNode(osgSim::DOFTransform& node, const tss::Joint& joint) {
    std::vector<DofSlot> slots;
    for (const tss::Dof& dof : joint.dofs) {
        const int axis = axisOf(dof);
        // Of any length, below 0 under a mirror: a value is that of the node's own units.
        if (dof.kind == tss::DofKind::Path || dof.axis != tss::Vec3(tss::Vec3::Unit(axis) * dof.axis[axis]))
            return nullptr;
        const bool fullTurn =
            dof.kind == tss::DofKind::Rotation && dof.upper - dof.lower >= 2 * osg::PI * (1 - 1e-6);
        slots.push_back({placeOf(dof.kind, axis), fullTurn, dof});
    }
    return std::make_unique<DofTransformNode>(node, std::move(slots));
}

} // namespace osgTSS
