#include "bake/model/AddPair.h"

#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/SmallSystems.h"

#include <array>
#include <cctype>
#include <cmath>
#include <optional>

namespace tss {

namespace {

/// The coordinate axis nearest to a direction, up to sign.
int nearestAxis(const Vec3& direction) {
    Eigen::Index axis = 0;
    direction.cwiseAbs().maxCoeff(&axis);
    return static_cast<int>(axis);
}

/// A rotation with the given columns where set, the others completed; nothing when they are not orthogonal or
/// would need a mirror. Exact for coordinate axes.
std::optional<Eigen::Matrix3d> completeFrame(const std::array<std::optional<Vec3>, 3>& columns) {
    int given = 0, first = -1;
    for (int k = 0; k < 3; ++k)
        if (columns[k]) {
            ++given;
            if (first < 0) first = k;
        }
    Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
    if (given == 0) return frame;
    if (given == 1) {
        const Vec3 unit = Vec3::Unit(first);
        if (*columns[first] == unit) return frame;
        if (*columns[first] == -unit) { // half a turn about the next axis, exact
            frame = -frame;
            frame((first + 1) % 3, (first + 1) % 3) = 1;
            return frame;
        }
        return turnBetween(unit, *columns[first]).toRotationMatrix();
    }
    for (int k = 0; k < 3; ++k)
        for (int l = k + 1; l < 3; ++l)
            if (columns[k] && columns[l] && std::abs(columns[k]->dot(*columns[l])) > 1e-9)
                return std::nullopt;
    for (int k = 0; k < 3; ++k)
        frame.col(k) = columns[k] ? *columns[k] : Vec3(columns[(k + 1) % 3]->cross(*columns[(k + 2) % 3]));
    if (frame.determinant() < 0) return std::nullopt;
    return frame;
}

/// The frame in which all DOFs of the motion are rotations and slides along X, Y, Z, each at most once.
std::optional<Pose> commonFrame(const Motion& motion, std::vector<int>& axes) {
    std::array<std::optional<Vec3>, 3> columns;
    std::optional<Vec3> centre;
    std::array<std::array<bool, 3>, 2> taken{};
    axes.clear();
    for (const Dof& dof : motion.dofs) {
        if (dof.kind == DofKind::Path) return std::nullopt;
        const Vec3 direction = dof.axis.normalized();
        const int axis = nearestAxis(direction);
        bool& used = taken[dof.kind == DofKind::Rotation ? 0 : 1][axis];
        if (used || (columns[axis] && *columns[axis] != direction)) return std::nullopt;
        used = true;
        columns[axis] = direction;
        axes.push_back(axis);
        if (dof.kind != DofKind::Rotation) continue;
        if (centre && *centre != dof.origin) return std::nullopt;
        centre = dof.origin;
    }
    const auto rotation = completeFrame(columns);
    if (!rotation) return std::nullopt;
    Pose frame = Pose::Identity();
    frame.linear() = *rotation;
    frame.translation() = centre.value_or(Vec3::Zero());
    return frame;
}

/// The DOF as seen from the joint's frame, where its axis is X, Y or Z.
Dof inFrame(const Dof& dof, int axis) {
    Dof local = dof;
    local.frame = Pose::Identity();
    if (dof.kind == DofKind::Path) return local;
    local.origin = Vec3::Zero();
    local.axis = Vec3::Unit(axis) * (dof.kind == DofKind::Rotation ? 1.0 : dof.axis.norm());
    return local;
}

std::string parentOf(const SceneModel& scene) {
    return "/" + scene.defaultPrim + "/";
}

Joint makeJoint(SceneModel& scene, const std::string& name, int body0, int body1, const Pose& frame0,
                const Pose& frame1) {
    Joint joint;
    joint.path = parentOf(scene) + freePrimName(scene, name);
    joint.body0 = body0;
    joint.body1 = body1;
    joint.frame0 = frame0;
    joint.frame1 = frame1;
    return joint;
}

/// One joint a DOF, with an Xform between each two; the links stand where B's parent stands at rest.
std::vector<int> addChain(SceneModel& scene, int bodyA, int bodyB, const Motion& motion,
                          const std::string& name) {
    std::vector<int> chain;
    int last = bodyA;
    Pose link = bodyA < 0 ? Pose::Identity() : scene.bodies[bodyA].placement;
    for (std::size_t k = 0; k < motion.dofs.size(); ++k) {
        const Dof& dof = motion.dofs[k];
        std::vector<int> axes{0};
        Motion alone;
        alone.dofs = {dof};
        const Pose frame = dof.kind == DofKind::Path ? dof.frame : *commonFrame(alone, axes);
        const bool end = k + 1 == motion.dofs.size();
        int next = bodyB;
        if (!end) {
            Body between;
            between.path = parentOf(scene) + freePrimName(scene, name + "Link" + std::to_string(k + 1));
            between.rigid = true;
            link = link * dofPose(dof, dof.rest);
            between.placement = link;
            scene.bodies.push_back(between);
            next = static_cast<int>(scene.bodies.size()) - 1;
        }
        Joint joint = makeJoint(scene, name + std::to_string(k + 1), last, next, frame,
                                end ? Pose(motion.base.inverse(Eigen::Isometry) * frame) : frame);
        joint.dofs = {inFrame(dof, axes[0])};
        joint.drives.resize(1);
        scene.joints.push_back(joint);
        chain.push_back(static_cast<int>(scene.joints.size()) - 1);
        last = next;
    }
    return chain;
}

} // namespace

std::string freePrimName(const SceneModel& scene, const std::string& wanted) {
    std::string name;
    for (char c : wanted) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0]))) name = "_" + name;
    std::string free = name;
    for (int k = 2; hasPath(scene, parentOf(scene) + free); ++k) free = name + std::to_string(k);
    return free;
}

std::vector<int> addJoints(SceneModel& scene, int bodyA, int bodyB, const Motion& motion,
                           const std::string& name) {
    checkMotion(motion);
    const int count = static_cast<int>(scene.bodies.size());
    if (bodyA < -1 || bodyA >= count || bodyB < 0 || bodyB >= count || bodyA == bodyB)
        throw InputError("a joint: expected the indices of two of the scene's " + std::to_string(count) +
                         " bodies, found " + std::to_string(bodyA) + " and " + std::to_string(bodyB));
    const Pose placement = bodyA < 0 ? Pose::Identity() : scene.bodies[bodyA].placement;
    if (bodyA >= 0) scene.bodies[bodyA].rigid = true;
    scene.bodies[bodyB].rigid = true;
    scene.bodies[bodyB].placement = placement * pose(motion, restValues(motion));

    std::vector<int> axes;
    const auto frame = commonFrame(motion, axes);
    if (!frame && motion.dofs.size() > 1) {
        if (!motion.planes.empty())
            throw InputError("limit planes couple DOFs that one joint cannot hold: expected DOFs with one "
                             "centre, along the axes of one frame");
        return addChain(scene, bodyA, bodyB, motion, name);
    }
    const Pose frame0 = frame ? *frame : motion.dofs[0].frame;
    axes.resize(motion.dofs.size(), 0);
    Joint joint = makeJoint(scene, name, bodyA, bodyB, frame0, motion.base.inverse(Eigen::Isometry) * frame0);
    for (std::size_t k = 0; k < motion.dofs.size(); ++k)
        joint.dofs.push_back(inFrame(motion.dofs[k], axes[k]));
    joint.planes = motion.planes;
    joint.drives.resize(joint.dofs.size());
    scene.joints.push_back(joint);
    return {static_cast<int>(scene.joints.size()) - 1};
}

int addJoint(SceneModel& scene, Joint joint, const std::string& name) {
    std::vector<double> rest;
    for (const Dof& dof : joint.dofs) rest.push_back(dof.rest);
    Pose above = Pose::Identity();
    if (joint.body0 >= 0) {
        scene.bodies[joint.body0].rigid = true;
        above = scene.bodies[joint.body0].placement;
    }
    scene.bodies[joint.body1].rigid = true;
    scene.bodies[joint.body1].placement = above * jointPose(joint, rest);
    joint.path = parentOf(scene) + freePrimName(scene, name);
    joint.drives.resize(joint.dofs.size());
    scene.joints.push_back(std::move(joint));
    return static_cast<int>(scene.joints.size()) - 1;
}

int addPair(SceneModel& scene, int bodyA, int bodyB, const Motion& motion, const std::string& name) {
    if (bodyA < 0) throw InputError("a pair: expected two bodies, found the world for one");
    Pair pair;
    pair.bodyA = bodyA;
    pair.bodyB = bodyB;
    pair.joints = addJoints(scene, bodyA, bodyB, motion, name);
    pair.path = pair.joints.size() == 1 ? scene.joints[pair.joints[0]].path
                                        : parentOf(scene) + freePrimName(scene, name);
    scene.pairs.push_back(pair);
    return static_cast<int>(scene.pairs.size()) - 1;
}

void addShowMotion(SceneModel& scene, const std::set<std::size_t>& others) {
    const double codes = 2 * scene.timeCodesPerSecond;
    double start = scene.startTimeCode;
    for (std::size_t j = 0; j < scene.joints.size(); ++j) {
        if (others.contains(j)) continue;
        Joint& joint = scene.joints[j];
        joint.drives.resize(joint.dofs.size());
        for (std::size_t k = 0; k < joint.dofs.size(); ++k, start += codes) {
            const Dof& dof = joint.dofs[k];
            joint.drives[k] = {{start, start + codes / 4, start + codes * 3 / 4, start + codes},
                               {dof.rest, dof.lower, dof.upper, dof.rest}};
        }
    }
    for (MuscleModel& muscle : scene.muscles) {
        muscle.activation = {{start, start + codes / 2, start + codes}, {0, 1, 0}};
        start += codes;
    }
    scene.endTimeCode = start;
}

} // namespace tss
