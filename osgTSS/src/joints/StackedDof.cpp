#include "StackedDof.h"

#include "bake/base/Error.h"
#include "bake/motion/AxisTurns.h"
#include "bake/motion/SmallSystems.h"
#include "bake/motion/WholeTurn.h"

#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedRotateAxisElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgTSS/Convert>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgTSS {

namespace {

using namespace osgAnimation;

constexpr std::array<const char*, 3> translationName{".x", ".y", ".z"};
constexpr std::array<const char*, 3> turnName{".rx", ".ry", ".rz"};

/// Values over time, seconds.
template <class Value>
struct Keys {
    std::vector<double> times;
    std::vector<Value> values;
};

/// A DOF whose limits are the range of values, and its drive when they are those of one channel.
MovedAxis spanning(const std::string& name, tss::DofKind kind, int axis, const std::vector<Keys<double>>& all,
                   double rate) {
    MovedAxis moved;
    moved.dof.name = name;
    moved.dof.kind = kind;
    moved.dof.axis = tss::Vec3::Unit(axis);
    moved.dof.lower = std::numeric_limits<double>::infinity();
    moved.dof.upper = -moved.dof.lower;
    for (const Keys<double>& keys : all)
        for (double value : keys.values) {
            if (!std::isfinite(value)) throw tss::InputError("a key of " + name + " is not finite");
            moved.dof.lower = std::min(moved.dof.lower, value);
            moved.dof.upper = std::max(moved.dof.upper, value);
        }
    moved.dof.rest = all.front().values.front();
    if (all.size() != 1) return moved;
    for (std::size_t k = 0; k < all[0].times.size(); ++k) {
        const double code = all[0].times[k] * rate;
        if (!moved.drive.times.empty() && !(code > moved.drive.times.back())) continue;
        moved.drive.times.push_back(code);
        moved.drive.values.push_back(all[0].values[k]);
    }
    return moved;
}

Eigen::Matrix3d matrixOf(const osg::Quat& q) {
    return Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
}

/// What an element says along the keys of each channel that moves it.
template <class Element, class ValueOf>
auto keysOf(const Element& element, const std::vector<AnimationChannels::Channels>& animations,
            int stepsBetweenKeys, const ValueOf& valueOf) {
    std::vector<Keys<std::invoke_result_t<ValueOf, const Element&>>> all;
    for (const AnimationChannels::Channels& animation : animations) {
        const osg::ref_ptr<Element> moved = osg::clone(&element, osg::CopyOp::DEEP_COPY_ALL);
        for (const auto& channel : channelsOf(*moved, animation)) {
            auto& keys = all.emplace_back();
            keys.times = withSteps(keyTimes(*channel), isCurve(*channel) ? stepsOfCurve : stepsBetweenKeys);
            for (const double time : keys.times) {
                channel->reset();
                channel->update(time, 1, 0);
                moved->update(static_cast<float>(time));
                keys.values.push_back(valueOf(*moved));
            }
        }
    }
    std::erase_if(all, [](const auto& keys) { return keys.times.empty(); });
    return all;
}

using TurnKeys = std::vector<Keys<Eigen::Matrix3d>>;

/// The keys of three turns in this order, one channel each; none where the turns cannot be told apart.
std::vector<std::vector<Keys<double>>> inTurns(const TurnKeys& all, const std::array<int, 3>& order) {
    std::vector<std::vector<Keys<double>>> turns(3);
    for (const Keys<Eigen::Matrix3d>& keys : all) {
        std::array<std::vector<double>, 3> angles;
        for (const Eigen::Matrix3d& value : keys.values)
            if (!tss::addTurns(value, order, angles[0].empty(), angles)) return {};
        for (std::size_t k = 0; k < 3; ++k) turns[k].push_back({keys.times, std::move(angles[k])});
    }
    return turns;
}

std::vector<MovedAxis> movedTurns(const std::string& name, const TurnKeys& keys, double rate) {
    std::array<int, 3> order{0, 1, 2};
    do {
        const auto turns = inTurns(keys, order);
        std::vector<MovedAxis> moved;
        for (std::size_t k = 0; k < turns.size(); ++k) {
            moved.push_back(
                spanning(name + turnName[order[k]], tss::DofKind::Rotation, order[k], turns[k], rate));
            if (moved.back().dof.upper - moved.back().dof.lower > 4 * osg::PI)
                throw tss::InputError("the keys of " + name + " turn more than twice round");
        }
        if (!moved.empty()) return moved;
    } while (std::next_permutation(order.begin(), order.end()));
    throw tss::InputError("the keys of " + name + " turn too far about several axes to be told apart");
}

std::vector<MovedAxis> movedAboutAxis(const StackedRotateAxisElement& element,
                                      const std::vector<Keys<double>>& keys, double rate) {
    const tss::Vec3 axis = toCore(osg::Vec3d(element.getAxis())).normalized();
    if (!axis.allFinite()) throw tss::InputError("element " + element.getName() + " has no axis");
    int along = 0;
    for (int k = 0; k < 3; ++k)
        if (axis == tss::Vec3(tss::Vec3::Unit(k))) along = k;
    MovedAxis moved = spanning(element.getName(), tss::DofKind::Rotation, along, keys, rate);
    if (axis != tss::Vec3(tss::Vec3::Unit(along))) moved.axes = tss::turnBetween(tss::Vec3::UnitX(), axis);
    return {moved};
}

Eigen::Matrix3d product(const std::array<double, 3>& angles, const std::array<int, 3>& order) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
    for (std::size_t k = 0; k < 3; ++k)
        matrix = matrix * Eigen::AngleAxisd(angles[k], tss::Vec3::Unit(order[k])).toRotationMatrix();
    return matrix;
}

} // namespace

std::vector<MovedAxis> movedAxes(const StackedTransformElement& element, const osg::Node& node,
                                 const AnimationChannels& channels, const std::string& target, double rate) {
    const std::string& name = element.getName();
    const std::vector<AnimationChannels::Channels> animations = channels.of(node, target);
    std::vector<MovedAxis> moved;
    if (const auto* turn = dynamic_cast<const StackedRotateAxisElement*>(&element)) {
        const auto keys = keysOf(*turn, animations, 1, [](const auto& at) { return at.getAngle(); });
        return keys.empty() ? moved : movedAboutAxis(*turn, keys, rate);
    }
    if (const auto* slide = dynamic_cast<const StackedTranslateElement*>(&element)) {
        for (int k = 0; k < 3; ++k) {
            const auto keys =
                keysOf(*slide, animations, 1, [k](const auto& at) { return double(at.getTranslate()[k]); });
            if (keys.empty()) break;
            moved.push_back(spanning(name + translationName[k], tss::DofKind::Translation, k, keys, rate));
        }
        return moved;
    }
    if (const auto* turns = dynamic_cast<const StackedQuaternionElement*>(&element)) {
        const auto turned = [](const auto& at) { return matrixOf(at.getQuaternion()); };
        const TurnKeys keys = keysOf(*turns, animations, stepsOfCurve, turned);
        return keys.empty() ? moved : movedTurns(name, keys, rate);
    }
    if (channels.animates(node, target, name))
        throw tss::InputError("a channel animates its element " + name +
                              ", which neither turns nor slides: a scale or a whole matrix");
    return {};
}

double StackedDof::value() const {
    const osg::ref_ptr<StackedTransformElement> element = _element.get();
    switch (_part) {
    case ANGLE:
        return static_cast<StackedRotateAxisElement&>(*element).getAngle();
    case TRANSLATION:
        return static_cast<StackedTranslateElement&>(*element).getTranslate()[_index];
    case TURN:
        break;
    }
    const osg::Quat& q = static_cast<StackedQuaternionElement&>(*element).getQuaternion();
    const double angle = tss::turnsOf(matrixOf(q), _order)[_index];
    return tss::nearestTurn(angle, _middle);
}

void StackedDof::setValue(double value) {
    const osg::ref_ptr<StackedTransformElement> element = _element.get();
    switch (_part) {
    case ANGLE:
        return static_cast<StackedRotateAxisElement&>(*element).setAngle(value);
    case TRANSLATION: {
        auto& translate = static_cast<StackedTranslateElement&>(*element);
        osg::Vec3 to = translate.getTranslate();
        to[_index] = static_cast<float>(value);
        return translate.setTranslate(to);
    }
    case TURN:
        break;
    }
    auto& turn = static_cast<StackedQuaternionElement&>(*element);
    std::array<double, 3> angles = tss::turnsOf(matrixOf(turn.getQuaternion()), _order);
    angles[_index] = value;
    const Eigen::Quaterniond q(product(angles, _order));
    turn.setQuaternion(osg::Quat(q.x(), q.y(), q.z(), q.w()));
}

std::vector<StackedDof> findStackedDofs(UpdateMatrixTransform& animation, const tss::Joint& joint) {
    std::vector<StackedDof> found;
    const auto nameIs = [](const tss::Dof& dof, const std::string& name) { return dof.name == name; };
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
        const tss::Dof& dof = joint.dofs[k];
        for (const auto& element : animation.getStackedTransforms()) {
            StackedDof part;
            part._element = element.get();
            part._middle = (dof.lower + dof.upper) / 2;
            const std::string& name = element->getName();
            if (dynamic_cast<StackedRotateAxisElement*>(element.get()) && nameIs(dof, name)) {
                found.push_back(part);
            } else if (dynamic_cast<StackedTranslateElement*>(element.get())) {
                part._part = StackedDof::TRANSLATION;
                for (part._index = 0; part._index < 3; ++part._index)
                    if (nameIs(dof, name + translationName[part._index])) found.push_back(part);
            } else if (dynamic_cast<StackedQuaternionElement*>(element.get())) {
                part._part = StackedDof::TURN;
                // The order of the turns is that of their DOFs, three in a row.
                std::size_t first = k;
                while (first > 0 && joint.dofs[first - 1].name.rfind(name + ".r", 0) == 0) --first;
                int turns = 0;
                for (std::size_t i = first; i < joint.dofs.size() && turns < 3; ++i)
                    for (int axis = 0; axis < 3; ++axis)
                        if (nameIs(joint.dofs[i], name + turnName[axis])) {
                            if (i == k) part._index = turns;
                            part._order[turns++] = axis;
                            break;
                        }
                if (turns == 3 && dof.name.rfind(name + ".r", 0) == 0) found.push_back(part);
            }
            if (found.size() == k + 1) break;
        }
        if (found.size() != k + 1) return {};
    }
    return found;
}

} // namespace osgTSS
