#include "bake/play/ChainPoses.h"

#include "bake/model/Kinematics.h"
#include "bake/table/RoundingBand.h"

#include <algorithm>

namespace tss {

namespace {

/// The pair that a chain of joints from one body to another would be.
Pair over(std::vector<int> joints, int from, int to) {
    Pair pair;
    pair.bodyA = from;
    pair.bodyB = to;
    pair.joints = std::move(joints);
    return pair;
}

void compose(const ChainPoses::Matrix& left, const ChainPoses::Matrix& right, ChainPoses::Matrix& out) {
    for (int r = 0; r < 12; r += 4) {
        for (int c = 0; c < 4; ++c)
            out[r + c] = left[r] * right[c] + left[r + 1] * right[4 + c] + left[r + 2] * right[8 + c];
        out[r + 3] += left[r + 3];
    }
}

} // namespace

ChainPoses::ChainPoses(const SceneModel& scene, const std::vector<int>& pairs) {
    std::vector<bool> wanted(scene.joints.size(), false);
    for (const int pair : pairs)
        for (const int joint : scene.pairs[pair].joints) {
            const std::vector<Dof>& dofs = scene.joints[joint].dofs;
            wanted[joint] =
                std::ranges::none_of(dofs, [](const Dof& dof) { return dof.kind == DofKind::Path; });
        }
    const std::vector<std::size_t> firstValue = firstValues(scene);
    served_.assign(scene.joints.size(), false);
    toOrigin_.resize(scene.bodies.size());

    // Outwards from the world, then from the first body of each other tree of joints.
    std::vector<bool> placed(scene.bodies.size(), false);
    std::vector<std::vector<int>> chains(scene.bodies.size());
    for (int first = -1; first < static_cast<int>(scene.bodies.size()); ++first) {
        if (first >= 0 && placed[first]) continue;
        if (first >= 0) {
            placed[first] = true;
            steps_.push_back({-1, first, {}, PoseRecipe(Motion(), Vec3::Zero(), Vec3::Zero()), {}});
        }
        std::vector<int> front{first};
        for (std::size_t i = 0; i < front.size(); ++i)
            for (int j = 0; j < static_cast<int>(scene.joints.size()); ++j) {
                const Joint& joint = scene.joints[j];
                const int body = front[i];
                if (!wanted[j] || served_[j] || (joint.body0 != body && joint.body1 != body)) continue;
                const int next = joint.body0 == body ? joint.body1 : joint.body0;
                if (next < 0 || placed[next]) continue;
                placed[next] = served_[j] = true;
                front.push_back(next);
                if (body >= 0) chains[next] = chains[body];
                chains[next].push_back(j);
                Step step{body == first ? -1 : body, next, {}, {}, {}};
                const Pair one = over({j}, body, next);
                for (const JointDof& dof : pairDofs(scene, one))
                    step.values.push_back(firstValue[j] + dof.dof);
                step.recipe = PoseRecipe(pairMotion(scene, one), Vec3::Zero(), Vec3::Zero());
                if (step.recipe.affine()) step.plan = PosePlan(step.recipe);
                steps_.push_back(std::move(step));
                toOrigin_[next] = pairMotion(scene, over(chains[next], first, next));
            }
    }
}

bool ChainPoses::links(const Pair& pair) const {
    return std::ranges::all_of(pair.joints, [&](int joint) { return served_[joint]; });
}

double ChainPoses::error(const Pair& pair, double farthest) const {
    const Motion &a = toOrigin_[pair.bodyA], &b = toOrigin_[pair.bodyB];
    // As far as a point may come to lie from any of the origins on its way.
    const double mostApart = farthest + motionSize(a) + motionSize(b);
    // The way back from the origin to A leaves out what A's turn and its shift are off by, and both once more
    // where they meet.
    return 4 * (poseError(a, doubleRoundoff, mostApart) + poseError(b, doubleRoundoff, mostApart));
}

void ChainPoses::evaluate(const double* values, Matrix* places) const {
    for (const Step& step : steps_) {
        DofValues own;
        for (std::size_t k = 0; k < step.values.size(); ++k) own[k] = values[step.values[k]];
        if (step.parent < 0) {
            step.recipe.evaluate(own.data(), places[step.body].data());
            continue;
        }
        Matrix toParent;
        step.recipe.evaluate(own.data(), toParent.data());
        compose(places[step.parent], toParent, places[step.body]);
    }
}

void ChainPoses::ownLanes(const Step& step, const double* const* values, PoseLanes& own) const {
    const std::size_t dofs = step.values.size();
    double q[poseLanes * maxDofs];
    for (std::uint32_t i = 0; i < poseLanes; ++i)
        for (std::size_t k = 0; k < dofs; ++k) q[i * dofs + k] = values[i][step.values[k]];
    if (dofs > 0 && kernels_.poses) return kernels_.poses(step.plan, q, poseLanes, poseLanes, own.doubles);
    Matrix place;
    for (std::uint32_t i = 0; i < poseLanes; ++i) {
        if (i == 0 || dofs > 0) step.recipe.evaluate(q + i * dofs, place.data());
        for (std::size_t n = 0; n < place.size(); ++n) own.doubles[n + 1][i] = place[n];
    }
}

void ChainPoses::evaluate(const double* const* values, BodyLanes* places) const {
    PoseLanes own;
    for (const Step& step : steps_) {
        ownLanes(step, values, own);
        if (step.parent < 0)
            std::copy_n(&own.doubles[1][0], 12 * poseLanes, &places[step.body].numbers[0][0]);
        else
            laneKernels_.compose(places[step.parent], own, places[step.body]);
    }
}

void ChainPoses::between(const Matrix& a, const Matrix& b, Matrix& out) {
    const double move[3] = {b[3] - a[3], b[7] - a[7], b[11] - a[11]};
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) out[4 * r + c] = a[r] * b[c] + a[4 + r] * b[4 + c] + a[8 + r] * b[8 + c];
        out[4 * r + 3] = a[r] * move[0] + a[4 + r] * move[1] + a[8 + r] * move[2];
    }
}

} // namespace tss
