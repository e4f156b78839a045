#include "bake/usd/UsdParts.h"

#include "bake/base/UnionFind.h"
#include "bake/motion/WholeTurn.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

constexpr Attribute excluded{"physics:excludeFromArticulation", "bool", true},
    mimicEnabled{"newton:mimicEnabled", "bool"};

/// The path of the joint that this one follows and how, in the file's units: "value + gearing * leader +
/// offset = 0", or "value = coef0 + coef1 * leader".
void readMimic(const PrimReader& prim, RobotJoint& joint) {
    const auto schemas = prim.prim().metadata.find("apiSchemas");
    if (schemas == prim.prim().metadata.end() || !prim.flag(mimicEnabled, true)) return;
    for (const std::string& api : listItems(schemas->second)) {
        const bool physx = api.starts_with("PhysxMimicJointAPI:");
        if (!physx && api != "NewtonMimicAPI") continue;
        const std::string of =
            physx ? "physxMimicJoint:" + api.substr(api.find(':') + 1) + ":" : "newton:mimic";
        const std::string leader = of + (physx ? "referenceJoint" : "Joint"),
                          factor = of + (physx ? "gearing" : "Coef1"),
                          offset = of + (physx ? "offset" : "Coef0");
        joint.leader = prim.target({leader, "rel"});
        joint.factor = (physx ? -1 : 1) * prim.real({factor, "float"}, 1);
        joint.offset = (physx ? -1 : 1) * prim.real({offset, "float"}, 0);
    }
}

Pose frameAt(const JointEnd& end, const PrimReader& prim, const Attribute& position,
             const Attribute& rotation) {
    Pose frame = Pose::Identity();
    frame.linear() = end.turn * prim.rotation(rotation).toRotationMatrix();
    frame.translation() = end.points * prim.vector(position, Vec3::Zero());
    return frame;
}

/// A joint as the file has it: of body0 and body1, either of which may be the world.
struct Edge {
    RobotJoint joint;     ///< parent: of body0, child: of body1, which may be -1
    bool last = false;    ///< comes into the forest after all others
    bool several = false; ///< of several joints in the file, whose names its DOFs have
};

/// The same joint seen from its other body.
RobotJoint turnedRound(const RobotJoint& joint) {
    RobotJoint other = joint;
    std::swap(other.parent, other.child);
    other.origin = joint.origin.inverse(Eigen::Isometry);
    // (O D1...Dd)^-1 = Dd^-1...D1^-1 O^-1, the DOFs then in the parent's frame: O carries them into the
    // child's.
    std::ranges::reverse(other.dofs);
    std::ranges::reverse(other.drives);
    for (Dof& dof : other.dofs) {
        dof.axis = -(joint.origin.linear() * dof.axis);
        dof.origin = joint.origin * dof.origin;
    }
    return other;
}

/// Both turn about one line, or slide along one direction.
bool moveAlike(const Dof& a, const Dof& b) {
    constexpr double rounding = 1e-6; // some steps of a float
    if (a.kind != b.kind || a.axis.cross(b.axis).norm() > rounding * a.axis.norm() * b.axis.norm())
        return false;
    const double apart = (b.origin - a.origin).cross(a.axis).norm();
    return a.kind == DofKind::Translation || apart <= rounding * (1 + a.origin.norm()) * a.axis.norm();
}

void nameDofs(RobotJoint& joint) {
    for (Dof& dof : joint.dofs) dof.name = joint.dofs.size() == 1 ? joint.name : joint.name + "_" + dof.name;
}

/// Adds the DOFs of another joint of the same two bodies below this one's own. False where the two do not
/// move them one after the other: either holds them, they have them elsewhere at 0, or both move them alike.
bool stack(Edge& edge, RobotJoint other) {
    RobotJoint& joint = edge.joint;
    nameDofs(other);
    if (other.parent != joint.parent) other = turnedRound(other);
    constexpr double rounding = 1e-5; // floats, and numbers written with six digits
    const double size = 1 + joint.origin.translation().norm();
    const double apart = (joint.origin.matrix() - other.origin.matrix()).cwiseAbs().maxCoeff();
    const auto isAlike = [&](const Dof& own) {
        return std::ranges::any_of(other.dofs, [&](const Dof& dof) { return moveAlike(own, dof); });
    };
    if (joint.dofs.empty() || other.dofs.empty() || apart > rounding * size ||
        std::ranges::any_of(joint.dofs, isAlike))
        return false;
    if (!edge.several) nameDofs(joint);
    edge.several = true;
    if (!joint.drives.empty() || !other.drives.empty()) {
        joint.drives.resize(joint.dofs.size());
        other.drives.resize(other.dofs.size());
    }
    joint.dofs.insert(joint.dofs.end(), other.dofs.begin(), other.dofs.end());
    joint.drives.insert(joint.drives.end(), other.drives.begin(), other.drives.end());
    if (joint.leader.empty()) joint.leader = other.leader;
    return true;
}

/// The value of a DOF that has the child stand so in the joint's origin: the nearest to the middle of its
/// limits, if any has.
double valueAt(const Dof& dof, const Pose& child) {
    if (dof.kind == DofKind::Translation) return child.translation().dot(dof.axis) / dof.axis.squaredNorm();
    const Eigen::Quaterniond turned(child.linear());
    const double value = 2 * std::atan2(turned.vec().dot(dof.axis.normalized()), turned.w());
    return nearestTurn(value, (dof.lower + dof.upper) / 2);
}

Pose placeOf(const Robot& robot, int link) {
    return link >= 0 ? robot.links[link].place : Pose::Identity();
}

/// A joint of one value is let rest at that which has its child where the file shows it. False where the
/// joint has it elsewhere all the same.
bool findRest(const Robot& robot, RobotJoint& joint) {
    const Pose origin = placeOf(robot, joint.parent) * joint.origin, stands = placeOf(robot, joint.child);
    const auto isShown = [&] {
        Pose should = origin;
        for (const Dof& dof : joint.dofs)
            should = should * dofPose(dof, std::clamp(dof.rest, dof.lower, dof.upper));
        const double size = 1 + should.translation().norm() + stands.translation().norm();
        return (should.matrix() - stands.matrix()).cwiseAbs().maxCoeff() <= 1e-3 * size;
    };
    if (isShown()) return true;
    if (joint.dofs.size() != 1) return false;
    joint.dofs[0].rest = valueAt(joint.dofs[0], origin.inverse(Eigen::Isometry) * stands);
    if (isShown()) return true;
    joint.dofs[0].rest = 0;
    return false;
}

class Joints {
public:
    Joints(const SceneReading& reading, const FindJointEnd& findEnd, int world, Robot& robot,
           LeftOut& leftOut)
        : reading_(reading), findEnd_(findEnd), world_(world), robot_(robot), leftOut_(leftOut) {}

    void read() {
        for (std::size_t i = 0; i < reading_.index.entries.size(); ++i) {
            const PrimReader prim = reading_.reader(static_cast<int>(i));
            const std::string& type = prim.prim().typeName;
            if (isJoint(prim.prim()))
                tryEdge(prim);
            else if (type.find("Joint") != type.npos)
                leftOut_.add("left out: " + type + "s, which tie nothing here", prim.place().path);
        }
        std::stable_partition(edges_.begin(), edges_.end(), [](const Edge& edge) { return !edge.last; });
        stackEdges();
        chooseForest();
        settleLeaders();
    }

private:
    /// One that cannot be read costs itself alone.
    void tryEdge(const PrimReader& prim) {
        try {
            readEdge(prim);
        } catch (const InputError& error) {
            const std::string& path = prim.place().path;
            leftOut_.add("left out: joints that cannot be read, which tie nothing",
                         path + " (" + messageBelow(path, error) + ")");
        }
    }

    void readEdge(const PrimReader& prim) {
        const std::string path = prim.place().path;
        if (!prim.flag(schema::jointEnabled, true))
            return leftOut_.add("left out: joints that are not enabled", path);
        const std::string body0 = prim.target(schema::body0), body1 = prim.target(schema::body1);
        const JointEnd end0 = findEnd_(prim, body0), end1 = findEnd_(prim, body1);
        if (end0.link == end1.link)
            return leftOut_.add("left out: joints that tie a body to itself, or the world", path);
        if (!changingOf(prim.prim()).empty())
            return leftOut_.add(
                "left out: joints whose limits or frames change in time, which tie nothing here", path);
        const std::string& type = prim.prim().typeName;
        if ((type == "PhysicsRevoluteJoint" || type == "PhysicsPrismaticJoint") &&
            prim.limit(schema::lowerLimit, -HUGE_VAL) > prim.limit(schema::upperLimit, HUGE_VAL))
            return leftOut_.add(
                "left out: joints with a lower limit above their upper one, which tie nothing", path);
        Joint read;
        readDofs(prim, read);
        const bool driven = !read.dofs.empty() && (end0.kinematic || end1.kinematic);
        if (driven && !end0.simulated && !end1.simulated)
            return leftOut_.add("left out: joints of bodies that are moved from outside (kinematicEnabled), "
                                "which tie nothing",
                                path);
        const Pose frame0 = frameAt(end0, prim, schema::localPos0, schema::localRot0),
                   frame1 = frameAt(end1, prim, schema::localPos1, schema::localRot1);
        Edge edge;
        edge.last = prim.flag(excluded, false);
        edge.joint.name = freeName(path, names_);
        edge.joint.where = path;
        readMimic(prim, edge.joint);
        edge.joint.parent = end0.link;
        edge.joint.child = end1.link;
        edge.joint.origin = frame0 * frame1.inverse(Eigen::Isometry);
        const bool moves =
            std::ranges::any_of(read.drives, [](const TimeSamples& drive) { return drive.times.size() > 1; });
        for (std::size_t k = 0; k < read.dofs.size(); ++k) {
            Dof dof = read.dofs[k];
            if (dof.lower == 0 && dof.upper == 0) continue; // as good as locked
            if (dof.kind == DofKind::Path) prim.problem("expected no tss:paths in a scene of other software");
            if (!limit(dof, path, edge.joint)) return;
            dof.axis = frame1.linear() * dof.axis;
            dof.origin = frame1.translation();
            edge.joint.dofs.push_back(dof);
            if (moves) edge.joint.drives.push_back(read.drives[k]);
        }
        if (body0.empty() || body1.empty()) tieWhereShown(edge.joint);
        edges_.push_back(std::move(edge));
    }

    /// The frame of a joint in the world is often one below what the robot hangs in, or none at all: who
    /// simulates such joints lets the body stand where the file shows it (newton-physics/newton, PhysX's
    /// articulations).
    void tieWhereShown(RobotJoint& joint) {
        if (findRest(robot_, joint)) return;
        joint.origin = placeOf(robot_, joint.parent).inverse(Eigen::Isometry) * placeOf(robot_, joint.child);
        leftOut_.add(
            "joints to the world, whose frame there is elsewhere than the file shows their body: taken "
            "where it shows it",
            joint.where);
    }

    /// False where it ties nothing.
    bool limit(Dof& dof, const std::string& path, RobotJoint& joint) {
        constexpr double far = 1e30; // some write the largest float for no limit
        if (dof.kind == DofKind::Translation) {
            if (std::abs(dof.lower) < far && std::abs(dof.upper) < far) return true;
            leftOut_.add("left out: joints that slide without limits, which tie nothing", path);
            return false;
        }
        if (!(dof.upper - dof.lower < fullTurn)) {
            setWholeTurn(dof);
            joint.endless = true;
            leftOut_.add(
                "joints without limits of their turn, or with ones of a turn and more, turn once round",
                path);
        }
        return true;
    }

    /// Several joints of the same two bodies become one that has the DOFs of all, in the file's order: what
    /// a body of MuJoCo has and its exporters write like this, for want of such a joint in UsdPhysics
    /// (github.com/newton-physics/newton reads it so too). Where they are meant to hold one another instead,
    /// the poses that are left are among these.
    void stackEdges() {
        std::map<std::pair<int, int>, std::size_t> firsts;
        std::vector<Edge> edges;
        for (Edge& edge : edges_) {
            const std::pair<int, int> links = std::minmax(edge.joint.parent, edge.joint.child);
            const auto [first, isNew] = firsts.try_emplace(links, edges.size());
            if (isNew || edge.last || !stack(edges[first->second], edge.joint))
                edges.push_back(std::move(edge));
        }
        edges_ = std::move(edges);
        for (Edge& edge : edges_) {
            if (!edge.several) continue;
            RobotJoint& joint = edge.joint;
            joint.name = robot_.links[joint.child >= 0 ? joint.child : joint.parent].name + "_joint";
            std::vector<std::string> names;
            for (const Dof& dof : joint.dofs) names.push_back(dof.name);
            leftOut_.add("several joints of the same two bodies, taken one after the other",
                         joint.name + " (" + firstOf(names, names.size()) + ")");
        }
    }

    /// Edges that close no loop, each turned so that its parent is nearer to the world, or to the first link.
    void chooseForest() {
        const int count = static_cast<int>(robot_.links.size());
        UnionFind together(count + 1); // and below by link + 1: the world is first
        std::vector<std::vector<std::size_t>> at(count + 1);
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const RobotJoint& joint = edges_[e].joint;
            if (together.root(joint.parent + 1) == together.root(joint.child + 1)) {
                leftOut_.add(
                    "left out: joints that close a loop (what is proven without them holds with them)",
                    joint.where);
                continue;
            }
            together.join(joint.parent + 1, joint.child + 1);
            at[joint.parent + 1].push_back(e);
            at[joint.child + 1].push_back(e);
        }
        std::vector<bool> reached(count + 1), used(edges_.size());
        for (int k = -1; k < count; ++k) {
            const int root = k < 0 ? world_ : k;
            std::vector<int> open{root};
            if (reached[root + 1]) continue;
            reached[root + 1] = true;
            for (std::size_t next = 0; next < open.size(); ++next)
                for (std::size_t e : at[open[next] + 1]) {
                    if (used[e]) continue;
                    used[e] = true;
                    const RobotJoint& joint = edges_[e].joint;
                    robot_.joints.push_back(joint.parent == open[next] ? joint : turnedRound(joint));
                    reached[robot_.joints.back().child + 1] = true;
                    open.push_back(robot_.joints.back().child);
                }
        }
    }

    /// Leaders by their names, and in radians: in the file it is degrees where a joint turns.
    void settleLeaders() {
        const auto unit = [](const RobotJoint& joint) {
            const bool turns = joint.dofs.size() == 1 && joint.dofs[0].kind == DofKind::Rotation;
            return turns ? fullTurn / 360 : 1;
        };
        for (RobotJoint& joint : robot_.joints) {
            if (joint.leader.empty()) continue;
            if (joint.dofs.size() != 1) {
                leftOut_.add("not read: couplings (mimic) of joints of no value, or of several", joint.where);
                joint.leader.clear();
                continue;
            }
            joint.offset *= unit(joint);
            joint.factor *= unit(joint);
            const auto leader = std::ranges::find(robot_.joints, joint.leader, &RobotJoint::where);
            if (leader == robot_.joints.end()) continue; // which settleRobot() says
            joint.factor /= unit(*leader);
            joint.leader = leader->name;
        }
    }

    const SceneReading& reading_;
    const FindJointEnd& findEnd_;
    const int world_;
    Robot& robot_;
    LeftOut& leftOut_;
    std::vector<Edge> edges_;
    std::set<std::string> names_;
};

} // namespace

std::string freeName(const std::string& path, std::set<std::string>& taken) {
    std::string name = path.substr(path.rfind('/') + 1), above = path.substr(0, path.rfind('/'));
    while (!above.empty() && taken.contains(name)) {
        name = above.substr(above.rfind('/') + 1) + "_" + name;
        above.resize(above.rfind('/'));
    }
    for (int k = 2; taken.contains(name); ++k) name += std::to_string(k);
    taken.insert(name);
    return name;
}

void readUsdJoints(const SceneReading& reading, const FindJointEnd& findEnd, int world, Robot& robot,
                   LeftOut& leftOut) {
    Joints(reading, findEnd, world, robot, leftOut).read();
}

void restAsShown(Robot& robot, LeftOut& leftOut) {
    for (RobotJoint& joint : robot.joints)
        if (!findRest(robot, joint))
            leftOut.add(
                "bodies that the file shows elsewhere than their joint, within its limits, has them at rest; "
                "values count from the joint's frames",
                robot.links[joint.child].name);
}

} // namespace tss
