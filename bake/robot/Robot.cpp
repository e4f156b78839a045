#include "bake/robot/Robot.h"

#include "bake/base/Degrees.h"
#include "bake/base/Error.h"
#include "bake/motion/WholeTurn.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss {

namespace {

Where placeOfJoint(const Robot& robot, const RobotJoint& joint) {
    return {robot.file, joint.where, "joint " + joint.name};
}

std::string rangeText(const Robot& robot, const Dof& dof) {
    const bool turns = dof.kind == DofKind::Rotation;
    const auto shown = [&](double value) { return turns ? toDegrees(value) : robot.metersPerUnit * value; };
    return fmt::format("{:.6g} to {:.6g} {}", shown(dof.lower) + 0.0, shown(dof.upper) + 0.0,
                       turns ? "degrees" : "m");
}

std::vector<RobotJoint>::const_iterator named(const Robot& robot, const std::string& name) {
    return std::ranges::find(robot.joints, name, &RobotJoint::name);
}

/// Why a follower does not follow; empty where it does.
std::string whyAlone(const Robot& robot, const RobotJoint& joint) {
    auto leader = named(robot, joint.leader);
    if (leader == robot.joints.end() || leader->dofs.size() != 1)
        return "mimics \"" + joint.leader + "\", which is no joint that turns or slides within limits";
    for (std::size_t steps = 0; steps < robot.joints.size() && leader != robot.joints.end(); ++steps) {
        if (&*leader == &joint) return "is one of joints that mimic each other in a circle";
        if (leader->leader.empty()) break;
        leader = named(robot, leader->leader);
    }
    return "";
}

/// Finds the joint that leads a follower in the end. Its own limits do not stop it: who applies a `mimic`
/// does not look at them.
void findLeader(const Robot& robot, RobotJoint& joint) {
    auto leader = named(robot, joint.leader);
    for (; !leader->leader.empty(); leader = named(robot, leader->leader)) {
        joint.offset += joint.factor * leader->offset;
        joint.factor *= leader->factor;
        joint.leader = leader->leader;
    }
    Dof& dof = joint.dofs[0];
    const Dof& leads = leader->dofs[0];
    if (leader->endless && joint.factor != 0) {
        if (dof.kind != DofKind::Rotation) return; // its own limits are all there is
        const double half = fullTurn / 2 * std::max(1.0, std::abs(joint.factor));
        dof.lower = joint.offset - half;
        dof.upper = joint.offset + half;
        return;
    }
    const double a = joint.factor * leads.lower + joint.offset, b = joint.factor * leads.upper + joint.offset;
    dof.lower = std::min(a, b);
    dof.upper = std::max(a, b);
}

/// Without a leader a follower moves by itself, and leads those that follow it.
void settleLeader(Robot& robot, RobotJoint& joint) {
    const std::string why = whyAlone(robot, joint);
    if (why.empty()) return;
    robot.notes.push_back("joint " + joint.name + " (" + joint.where + ") " + why + ": it moves by itself");
    joint.leader.clear();
}

/// The limits that a follower has, through others that follow too.
void settleFollower(Robot& robot, RobotJoint& joint) {
    const Dof own = joint.dofs[0];
    findLeader(robot, joint);
    const Dof& led = joint.dofs[0];
    const double rounding = 1e-9 * (own.upper - own.lower);
    const bool beyond = led.lower < own.lower - rounding || led.upper > own.upper + rounding;
    robot.notes.push_back("joint " + joint.name + " mimics " + joint.leader + ", which leads it from " +
                          rangeText(robot, led) +
                          (beyond ? ", beyond its own limits " + rangeText(robot, own) : ""));
}

void settleHeld(Robot& robot, RobotJoint& joint) {
    const bool held = std::ranges::all_of(joint.dofs, [](const Dof& d) { return d.lower == d.upper; });
    if (joint.dofs.empty() || !held) return;
    for (const Dof& dof : joint.dofs) joint.origin = joint.origin * dofPose(dof, dof.lower);
    robot.notes.push_back("joint " + joint.name + " (" + joint.where + ") has the limits " +
                          rangeText(robot, joint.dofs[0]) + ": taken as fixed there");
    joint.dofs.clear();
    joint.drives.clear();
}

/// Some exporters write limits of thousands of turns where there are none, further than is served: one turn
/// goes through the same poses.
void settleEndless(Robot& robot, RobotJoint& joint) {
    constexpr double farthest = 1e5; // radians
    for (Dof& dof : joint.dofs) {
        if (dof.kind != DofKind::Rotation || !joint.drives.empty()) continue;
        const double most = std::max(std::abs(dof.lower), std::abs(dof.upper));
        if (most <= farthest || dof.upper - dof.lower < fullTurn) continue;
        robot.notes.push_back("joint " + joint.name + " (" + joint.where + ") has the limits " +
                              rangeText(robot, dof) + ": taken as one whole turn");
        setWholeTurn(dof);
        joint.endless = joint.dofs.size() == 1;
    }
}

/// Led by one without an end, and without limits of its own.
bool slidesOnAndOn(Robot& robot, const RobotJoint& joint) {
    if (joint.leader.empty() || joint.factor == 0 || joint.dofs[0].kind == DofKind::Rotation) return false;
    const auto leader = std::ranges::find(robot.joints, joint.leader, &RobotJoint::name);
    if (!leader->endless || joint.dofs[0].lower < joint.dofs[0].upper) return false;
    robot.notes.push_back("joint " + joint.name + " (" + joint.where +
                          ") slides without limits as its leader turns on and on: left out, " +
                          robot.links[joint.child].name + " and what hangs on it are tied to nothing");
    return true;
}

} // namespace

void moveChild(RobotJoint& joint, const Vec3& by) {
    joint.origin = Pose(joint.origin * Eigen::Translation3d(by));
    if (joint.frame) {
        joint.frame = Pose(Eigen::Translation3d(-by) * *joint.frame);
        return;
    }
    for (Dof& dof : joint.dofs) {
        dof.origin -= by;
        dof.frame = Pose(Eigen::Translation3d(-by) * dof.frame);
    }
}

void checkForest(const Robot& robot) {
    constexpr std::size_t most = 500;
    if (robot.links.size() > most)
        throw InputError(Where{robot.file},
                         "expected no more than 500 links, found " + std::to_string(robot.links.size()));
    std::vector<int> above(robot.links.size(), -1); // the joint that holds a link
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
        const RobotJoint& joint = robot.joints[j];
        int& holder = above[joint.child];
        if (holder >= 0)
            throw InputError(
                placeOfJoint(robot, joint),
                "link " + robot.links[joint.child].name + " hangs on joint " + robot.joints[holder].name +
                    " too; expected each link to be the child of one joint: of a closed loop leave one out");
        holder = static_cast<int>(j);
    }
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
        std::size_t steps = 0;
        for (int at = static_cast<int>(link); at >= 0 && above[at] >= 0; at = robot.joints[above[at]].parent)
            if (++steps > robot.links.size())
                throw InputError(placeOfJoint(robot, robot.joints[above[at]]),
                                 "the joints close a loop; expected links that hang on each other as a tree: "
                                 "leave one joint out");
    }
}

void settleRobot(Robot& robot) {
    checkForest(robot);
    for (RobotJoint& joint : robot.joints) settleEndless(robot, joint);
    for (RobotJoint& joint : robot.joints)
        if (!joint.leader.empty()) settleLeader(robot, joint);
    for (RobotJoint& joint : robot.joints)
        if (!joint.leader.empty()) settleFollower(robot, joint);
    if (std::ranges::any_of(robot.joints, [](const RobotJoint& joint) { return !joint.leader.empty(); }))
        robot.notes.push_back(
            "the scene's motion couples joints that mimic others; a table lets each move by "
            "itself, so what is proven never to meet holds, and some contacts of it may "
            "need both apart");
    for (RobotJoint& joint : robot.joints) settleEndless(robot, joint); // those that are led so far
    std::vector<RobotJoint> kept;
    for (const RobotJoint& joint : robot.joints)
        if (!slidesOnAndOn(robot, joint)) kept.push_back(joint);
    robot.joints = std::move(kept);
    for (RobotJoint& joint : robot.joints) settleHeld(robot, joint);
}

} // namespace tss
