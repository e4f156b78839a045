#include "bake/model/Kinematics.h"

#include "bake/base/Error.h"

#include <algorithm>
#include <numeric>

namespace tss {

namespace {

template <class Items>
int indexOf(const Items& items, const std::string& path) {
    const auto found = std::ranges::find(items, path, &Items::value_type::path);
    return found == items.end() ? -1 : static_cast<int>(found - items.begin());
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
    return std::ranges::all_of(
        rows, [&](const PathRow& row) { return row.rotation.coeffs() == rows.front().rotation.coeffs(); });
}

bool onePlace(const std::vector<PathRow>& rows) {
    return std::ranges::all_of(
        rows, [&](const PathRow& row) { return row.translation == rows.front().translation; });
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
        throw InputError(
            {"", "", joint.path},
            "its path both turns and travels, which cannot be followed backwards: expected one that "
            "leads from physics:body0 to physics:body1 on the way from body A of the pair to B");
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

JointWays::JointWays(const std::vector<Joint>& joints) : only_(joints.size(), true) {
    int most = -1;
    for (const Joint& joint : joints) most = std::max({most, joint.body0, joint.body1});
    std::vector<std::vector<Step>> from(static_cast<std::size_t>(most + 2)); // each body, the world first
    for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
        const Joint& joint = joints[j];
        if (!joint.enabled || joint.body0 == joint.body1) continue;
        from[joint.body0 + 1].push_back({j, joint.body1 + 1});
        from[joint.body1 + 1].push_back({j, joint.body0 + 1});
    }
    const int bodies = static_cast<int>(from.size());
    above_.assign(from.size(), Step{-1, -1});
    depth_.assign(from.size(), -1);
    for (int root = 0; root < bodies; ++root) {
        if (depth_[root] >= 0) continue;
        depth_[root] = 0;
        std::vector<int> reached{root};
        for (std::size_t i = 0; i < reached.size(); ++i)
            for (const Step& step : from[reached[i]]) {
                if (depth_[step.body] >= 0) continue;
                depth_[step.body] = depth_[reached[i]] + 1;
                above_[step.body] = {step.joint, reached[i]};
                reached.push_back(step.body);
            }
    }
    // A joint that is not in the forest leads round all those in it between its two bodies.
    std::vector<int> top(from.size()); // of each body, as far up as such loops have led already
    std::iota(top.begin(), top.end(), 0);
    const auto climbed = [&](int body) {
        while (top[body] != body) body = top[body] = top[top[body]];
        return body;
    };
    for (int body = 0; body < bodies; ++body)
        for (const Step& step : from[body]) {
            if (step.joint == above_[body].joint || step.joint == above_[step.body].joint) continue;
            int a = climbed(body), b = climbed(step.body);
            while (a != b) {
                int& lower = depth_[a] > depth_[b] ? a : b;
                only_[above_[lower].joint] = false;
                top[lower] = above_[lower].body;
                lower = climbed(lower);
            }
        }
}

std::optional<std::vector<int>> JointWays::chain(int bodyA, int bodyB) const {
    std::vector<int> way, back;
    int a = bodyA + 1, b = bodyB + 1;
    if (std::max(a, b) >= static_cast<int>(above_.size())) return way;
    while (a != b) {
        const bool fromA = depth_[a] >= depth_[b];
        const Step up = above_[fromA ? a : b];
        if (up.joint < 0) return std::vector<int>(); // two trees
        (fromA ? way : back).push_back(up.joint);
        (fromA ? a : b) = up.body;
    }
    way.insert(way.end(), back.rbegin(), back.rend());
    if (!std::ranges::all_of(way, [&](int joint) { return only_[joint]; })) return std::nullopt;
    return way;
}

std::optional<std::vector<int>> findChain(const std::vector<Joint>& joints, int bodyA, int bodyB) {
    return JointWays(joints).chain(bodyA, bodyB);
}

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
    return indexOf(scene.bodies, path);
}

int findPair(const SceneModel& scene, const std::string& path) {
    return indexOf(scene.pairs, path);
}
int findMuscle(const SceneModel& scene, const std::string& path) {
    return indexOf(scene.muscles, path);
}
int findSkin(const SceneModel& scene, const std::string& path) {
    return indexOf(scene.skins, path);
}

bool hasPath(const SceneModel& scene, const std::string& path) {
    return indexOf(scene.bodies, path) >= 0 || indexOf(scene.joints, path) >= 0 ||
           indexOf(scene.muscles, path) >= 0 || indexOf(scene.pairs, path) >= 0;
}

double largestDiagonal(const SceneModel& scene) {
    double largest = 0;
    for (const Body& body : scene.bodies)
        if (!body.mesh.vertices.empty()) largest = std::max(largest, diagonal(body.mesh));
    return largest;
}

std::string primName(const std::string& path) {
    return path.substr(path.rfind('/') + 1);
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

std::vector<UnderSkin> underSkin(const SceneModel& scene, const SkinModel& skin) {
    std::vector<UnderSkin> under;
    for (const int index : skin.muscles) {
        const MuscleModel& muscle = scene.muscles.at(static_cast<std::size_t>(index));
        under.push_back({index, muscle.body, muscle.bone, -1});
    }
    for (const int bone : skin.bones) under.push_back({-1, bone, bone, -1});
    for (const int joint : skin.weights.joints)
        if (std::ranges::find(skin.bones, joint) == skin.bones.end()) under.push_back({-1, -1, joint, -1});
    for (std::size_t m = 0; m < skin.muscles.size(); ++m) {
        const int bone = scene.muscles[skin.muscles[m]].insertionBone;
        if (bone < 0) continue;
        const auto moves = [&](const UnderSkin& u) { return u.bone == bone; };
        auto found = std::ranges::find_if(under, moves);
        if (found == under.end()) found = under.insert(under.end(), UnderSkin{-1, -1, bone, -1});
        under[m].insertion = static_cast<int>(found - under.begin());
    }
    return under;
}

const std::string& pathOf(const SceneModel& scene, const UnderSkin& under) {
    return under.muscle >= 0 ? scene.muscles[under.muscle].path : scene.bodies[under.bone].path;
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

std::vector<int> movingAsOne(const SceneModel& scene, int bone) {
    std::vector<char> soft(scene.bodies.size(), 0);
    for (const MuscleModel& muscle : scene.muscles)
        if (muscle.body >= 0) soft[muscle.body] = 1;
    for (const SkinModel& skin : scene.skins)
        if (skin.body >= 0) soft[skin.body] = 1;
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
