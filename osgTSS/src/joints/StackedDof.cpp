#include "StackedDof.h"

#include "FoundJoint.h"
#include "JointNode.h"

#include "bake/base/Error.h"
#include "bake/motion/TurnBetween.h"

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

template <class Value, class Part>
std::vector<Keys<double>> part(const std::vector<Keys<Value>>& all, const Part& of) {
    std::vector<Keys<double>> parts;
    for (const Keys<Value>& keys : all) {
        parts.push_back({keys.times, {}});
        for (const Value& value : keys.values) parts.back().values.push_back(of(value));
    }
    return parts;
}

Eigen::Matrix3d matrixOf(const osg::Quat& q) {
    return Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
}

/// Turns of all keys in an order, each channel without jumps; nothing where the middle one comes near a
/// quarter turn, where the others are not told apart.
std::optional<std::vector<std::array<Keys<double>, 3>>> turnKeys(const std::vector<Keys<osg::Quat>>& all,
                                                                 const std::array<int, 3>& order) {
    const double most = osg::DegreesToRadians(80.0);
    std::vector<std::array<Keys<double>, 3>> turns;
    for (const Keys<osg::Quat>& keys : all) {
        std::array<Keys<double>, 3> channel;
        for (const osg::Quat& value : keys.values) {
            const auto angles = turnsOf(matrixOf(value), order);
            if (std::abs(angles[1]) > most) return std::nullopt;
            for (std::size_t k = 0; k < 3; ++k) {
                std::vector<double>& values = channel[k].values;
                const double before = !values.empty() ? values.back() : 0;
                values.push_back(angles[k] - wholeTurns(angles[k], before));
            }
        }
        for (Keys<double>& part : channel) part.times = keys.times;
        turns.push_back(std::move(channel));
    }
    return turns;
}

std::vector<MovedAxis> movedTurns(const std::string& name, const std::vector<Keys<osg::Quat>>& all,
                                  double rate) {
    std::array<int, 3> order{0, 1, 2};
    do {
        const auto turns = turnKeys(all, order);
        if (!turns) continue;
        std::vector<MovedAxis> moved;
        for (std::size_t k = 0; k < 3; ++k) {
            std::vector<Keys<double>> of;
            for (const auto& channel : *turns) of.push_back(channel[k]);
            moved.push_back(spanning(name + turnName[order[k]], tss::DofKind::Rotation, order[k], of, rate));
            if (moved.back().dof.upper - moved.back().dof.lower > 4 * osg::PI)
                throw tss::InputError("the keys of " + name + " turn more than twice round");
        }
        return moved;
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
    if (const auto* turn = dynamic_cast<const StackedRotateAxisElement*>(&element)) {
        const auto keys = channels.keys<double>(node, target, name);
        return keys.empty() ? std::vector<MovedAxis>{} : movedAboutAxis(*turn, keys, rate);
    }
    if (dynamic_cast<const StackedTranslateElement*>(&element)) {
        const auto keys = channels.keys<osg::Vec3d>(node, target, name);
        std::vector<MovedAxis> moved;
        for (int k = 0; k < 3 && !keys.empty(); ++k)
            moved.push_back(spanning(name + translationName[k], tss::DofKind::Translation, k,
                                     part(keys, [k](const osg::Vec3d& v) { return v[k]; }), rate));
        return moved;
    }
    if (dynamic_cast<const StackedQuaternionElement*>(&element)) {
        const auto keys = channels.keys<osg::Quat>(node, target, name);
        return keys.empty() ? std::vector<MovedAxis>{} : movedTurns(name, keys, rate);
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
    const double angle = turnsOf(matrixOf(q), _order)[_index];
    return angle - wholeTurns(angle, _middle);
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
    std::array<double, 3> angles = turnsOf(matrixOf(turn.getQuaternion()), _order);
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
