#include "bake/model/Kinematics.h"

#include "bake/base/Error.h"

#include <algorithm>

namespace tss {

namespace {

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
    return std::ranges::all_of(
        rows, [&](const PathRow& row) { return row.rotation.coeffs() == rows.front().rotation.coeffs(); });
}

bool onePlace(const std::vector<PathRow>& rows) {
    return std::ranges::all_of(
        rows, [&](const PathRow& row) { return row.translation == rows.front().translation; });
}

/// The inverse of a path at the same values, split into a path, which must be linear between its rows, and a
/// constant motion `after` that is applied before it. The inverse of x -> R x + t is x -> R^-1 (x - t):
/// linear in the rows where R or t is the same in all of them, otherwise not.
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
        throw InputError(
            {"", "", joint.path},
            "its path both turns and travels, which cannot be followed backwards: expected one that "
            "leads from physics:body0 to physics:body1 on the way from body A of the pair to B");
    }
    after = dof.frame * after * dof.frame.inverse(Eigen::Isometry);
    return back;
}

/// D^-1 as the product of a DOF of the same value, which is returned, and `after`.
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

std::vector<std::size_t> firstValues(const SceneModel& scene) {
    std::vector<std::size_t> first{0};
    for (const Joint& joint : scene.joints) first.push_back(first.back() + joint.dofs.size());
    return first;
}

std::vector<double> restValues(const SceneModel& scene) {
    std::vector<double> values;
    for (const Joint& joint : scene.joints)
        for (const Dof& dof : joint.dofs) values.push_back(dof.rest);
    return values;
}

bool isDriven(const Joint& joint, std::size_t dof) {
    return dof < joint.drives.size() && !joint.drives[dof].empty();
}

std::vector<double> drivenValues(const SceneModel& scene, double timeCode) {
    std::vector<double> values;
    for (const Joint& joint : scene.joints)
        for (std::size_t k = 0; k < joint.dofs.size(); ++k)
            values.push_back(isDriven(joint, k) ? joint.drives[k].at(timeCode) : joint.dofs[k].rest);
    return values;
}

std::vector<JointDof> pairDofs(const SceneModel& scene, const Pair& pair) {
    std::vector<JointDof> dofs;
    int body = pair.bodyA;
    for (int index : pair.joints) {
        const Joint& joint = scene.joints[index];
        const bool backwards = joint.body0 != body;
        for (std::size_t k = 0; k < joint.dofs.size(); ++k)
            dofs.push_back({index, backwards ? joint.dofs.size() - 1 - k : k});
        body = backwards ? joint.body0 : joint.body1;
    }
    return dofs;
}

Pose jointPose(const Joint& joint, std::span<const double> values) {
    Pose pose = joint.frame0;
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) pose = pose * dofPose(joint.dofs[k], values[k]);
    return pose * joint.frame1.inverse(Eigen::Isometry);
}

std::vector<int> movers(const SceneModel& scene) {
    std::vector<int> mover(scene.bodies.size(), -1);
    for (int j = 0; j < static_cast<int>(scene.joints.size()); ++j) {
        const Joint& joint = scene.joints[j];
        if (!joint.enabled || joint.body1 < 0 || mover[joint.body1] >= 0) continue;
        int above = joint.body0;
        while (above >= 0 && above != joint.body1)
            above = mover[above] < 0 ? -1 : scene.joints[mover[above]].body0;
        if (above < 0) mover[joint.body1] = j;
    }
    return mover;
}

std::vector<int> rigidRoots(const SceneModel& scene) {
    const std::vector<int> mover = movers(scene);
    std::vector<int> roots(scene.bodies.size(), -1);
    for (std::size_t body = 0; body < roots.size(); ++body) {
        int root = static_cast<int>(body);
        while (root >= 0 && mover[root] >= 0 && scene.joints[mover[root]].dofs.empty())
            root = scene.joints[mover[root]].body0;
        roots[body] = root >= 0 && mover[root] >= 0 ? root : -1;
    }
    return roots;
}

std::vector<bool> softBodies(const SceneModel& scene) {
    std::vector<bool> soft(scene.bodies.size(), false);
    for (const MuscleModel& muscle : scene.muscles)
        if (muscle.body >= 0) soft[muscle.body] = true;
    for (const SkinModel& skin : scene.skins)
        if (skin.body >= 0) soft[skin.body] = true;
    return soft;
}

std::vector<int> movingAsOne(const SceneModel& scene, int bone) {
    const std::vector<bool> soft = softBodies(scene);
    const std::vector<int> roots = rigidRoots(scene);
    std::vector<int> bodies;
    for (int k = 0; k < static_cast<int>(scene.bodies.size()); ++k)
        if (k == bone || (!soft[k] && roots[k] == roots[bone])) bodies.push_back(k);
    return bodies;
}

void requireMoved(const SceneModel& scene, const Pair& pair, const std::vector<int>& movers) {
    for (const int index : pair.joints) {
        const Joint& joint = scene.joints[index];
        const std::string expected = "expected that " + joint.path + " moves its physics:body1, found that ";
        if (joint.body1 < 0) throw InputError(expected + "this is the world");
        if (const int by = movers[joint.body1]; by != index)
            throw InputError(expected + scene.bodies[joint.body1].path +
                             (by < 0 ? " stands" : " moves by " + scene.joints[by].path));
    }
}

std::vector<Pose> posedBodies(const SceneModel& scene, std::span<const double> values) {
    const std::vector<int> mover = movers(scene);
    const std::vector<std::size_t> first = firstValues(scene);
    std::vector<Pose> placements;
    for (const Body& body : scene.bodies) placements.push_back(body.placement);
    std::vector<bool> placed(scene.bodies.size(), false);
    std::vector<int> way; // up from a body to what is placed already, then back
    for (int body = 0; body < static_cast<int>(scene.bodies.size()); ++body) {
        for (int at = body; at >= 0 && !placed[at];) {
            placed[at] = true;
            if (mover[at] < 0) break;
            way.push_back(mover[at]);
            at = scene.joints[mover[at]].body0;
        }
        for (; !way.empty(); way.pop_back()) {
            const Joint& joint = scene.joints[way.back()];
            const Pose parent = joint.body0 < 0 ? Pose::Identity() : placements[joint.body0];
            const auto own = values.subspan(first[way.back()], joint.dofs.size());
            placements[joint.body1] = parent * jointPose(joint, own);
        }
    }
    return placements;
}

bool tiesDirectly(const SceneModel& scene, const Pair& pair) {
    const auto between = [&](int body) {
        return body < 0 || body == pair.bodyA || body == pair.bodyB || scene.bodies[body].mesh.empty();
    };
    return std::ranges::all_of(pair.joints, [&](int joint) {
        return between(scene.joints[joint].body0) && between(scene.joints[joint].body1);
    });
}

} // namespace tss
