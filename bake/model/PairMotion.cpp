#include "bake/base/Error.h"
#include "bake/model/SceneModel.h"

#include <algorithm>

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

bool oneTurn(const std::vector<PathRow>& rows) {
    return std::all_of(rows.begin(), rows.end(), [&](const PathRow& row) {
        return row.rotation.coeffs() == rows.front().rotation.coeffs();
    });
}

bool onePlace(const std::vector<PathRow>& rows) {
    return std::all_of(rows.begin(), rows.end(),
                       [&](const PathRow& row) { return row.translation == rows.front().translation; });
}

/// The path's inverse at the same values, all that is linear between its rows: `after` is what of it is left
/// for what follows. The inverse of a turn R about a place t is x -> R^-1 (x - t), linear where R or t is one
/// and the same; where both change it is not.
Dof invertedPath(const Dof& dof, const Joint& joint, Pose& after) {
    Dof back = dof;
    if (onePlace(dof.path)) {
        after.translation() = -dof.path.front().translation;
        for (PathRow& row : back.path) {
            row.translation = Vec3::Zero();
            row.rotation = row.rotation.conjugate();
        }
    } else if (oneTurn(dof.path)) {
        after.linear() = dof.path.front().rotation.conjugate().toRotationMatrix();
        back.frame = dof.frame * after;
        for (PathRow& row : back.path) {
            row.translation = -row.translation;
            row.rotation = Eigen::Quaterniond::Identity();
        }
    } else {
        throw InputError({"", "", joint.path},
                         "expected a joint with a path that both turns and travels to be crossed from "
                         "physics:body0 to physics:body1: swap its bodies or those of the pair");
    }
    after = dof.frame * after * dof.frame.inverse(Eigen::Isometry);
    return back;
}

/// D^-1 as a DOF of the same value, and then `after`.
Dof inverted(const Dof& dof, const Joint& joint, Pose& after) {
    if (dof.kind == DofKind::Path) return invertedPath(dof, joint, after);
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
        Pose after = Pose::Identity();
        Dof seen = placed(backwards ? inverted(dof, joint, after) : dof, place);
        if (several) seen.name = primName(joint.path) + ":" + dof.name;
        motion.dofs.push_back(std::move(seen));
        if (dof.kind == DofKind::Path) place = place * after;
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
