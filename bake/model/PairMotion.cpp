#include "bake/base/Error.h"
#include "bake/model/SceneModel.h"

namespace tss {

namespace {

std::string primName(const std::string& path) {
    return path.substr(path.rfind('/') + 1);
}

/// The DOF of a joint, with its axis as seen from A: x -> place * D * place^-1.
Dof placed(const Dof& dof, const Pose& place) {
    Dof seen = dof;
    if (dof.kind == DofKind::Path) {
        seen.frame = place * dof.frame;
    } else {
        seen.axis = place.linear() * dof.axis;
        seen.origin = place * dof.origin;
        if (dof.kind == DofKind::Rotation) seen.axis.normalize();
    }
    return seen;
}

/// D^-1 as a DOF of the same value. A path has none: what is linear between its rows is not when inverted.
Dof inverted(const Dof& dof, const Joint& joint) {
    if (dof.kind == DofKind::Path)
        throw InputError(
            {"", "", joint.path},
            "expected a joint with a path to be crossed from physics:body0 to physics:body1: swap its "
            "bodies or those of the pair");
    Dof back = dof;
    back.axis = -dof.axis;
    return back;
}

/// Appends one joint to the motion; `place` is A from the body reached so far, and grows by the joint.
void append(Motion& motion, Pose& place, const Joint& joint, bool backwards, bool several) {
    const std::size_t first = motion.dofs.size(), count = joint.dofs.size();
    place = place * (backwards ? joint.frame1 : joint.frame0);
    for (std::size_t k = 0; k < count; ++k) {
        const Dof& dof = joint.dofs[backwards ? count - 1 - k : k];
        Dof seen = placed(backwards ? inverted(dof, joint) : dof, place);
        if (several) seen.name = primName(joint.path) + ":" + dof.name;
        motion.dofs.push_back(std::move(seen));
    }
    place = place * (backwards ? joint.frame0 : joint.frame1).inverse();
    for (const LimitPlane& plane : joint.planes) {
        LimitPlane whole{std::vector<double>(first, 0.0), plane.bound};
        for (std::size_t k = 0; k < count; ++k)
            whole.coefficients.push_back(plane.coefficients[backwards ? count - 1 - k : k]);
        motion.planes.push_back(std::move(whole));
    }
}

} // namespace

Motion pairMotion(const SceneModel& scene, const Pair& pair) {
    Motion motion;
    Pose place = Pose::Identity();
    int body = pair.bodyA;
    for (int index : pair.joints) {
        const Joint& joint = scene.joints[index];
        const bool backwards = joint.body0 != body;
        append(motion, place, joint, backwards, pair.joints.size() > 1);
        body = backwards ? joint.body0 : joint.body1;
    }
    for (LimitPlane& plane : motion.planes) plane.coefficients.resize(motion.dofs.size(), 0.0);
    motion.base = place;
    return motion;
}

int findBody(const SceneModel& scene, const std::string& path) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (scene.bodies[i].path == path) return static_cast<int>(i);
    return -1;
}

int findPair(const SceneModel& scene, const std::string& path) {
    for (std::size_t i = 0; i < scene.pairs.size(); ++i)
        if (scene.pairs[i].path == path) return static_cast<int>(i);
    return -1;
}

} // namespace tss
