#include "bake/table/PoseRecipe.h"

#include <algorithm>

namespace tss {

namespace {

PoseRecipe::Matrix rows(const Eigen::Matrix3d& linear, const Vec3& translation) {
    PoseRecipe::Matrix m;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) m[4 * r + c] = linear(r, c);
        m[4 * r + 3] = translation[r];
    }
    return m;
}

/// left * right, both affine.
void compose(const PoseRecipe::Matrix& left, const PoseRecipe::Matrix& right, PoseRecipe::Matrix& out) {
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            out[4 * r + c] =
                left[4 * r] * right[c] + left[4 * r + 1] * right[4 + c] + left[4 * r + 2] * right[8 + c];
        out[4 * r + 3] += left[4 * r + 3];
    }
}

} // namespace

PoseRecipe::PoseRecipe(const Motion& motion, const Vec3& originA, const Vec3& originB) {
    const Pose toA{Eigen::Translation3d(-originA)}, fromB{Eigen::Translation3d(originB)};
    const Pose last = motion.base * fromB;
    if (motion.dofs.empty()) {
        const Pose whole = toA * last;
        fixed_ = rows(whole.linear(), whole.translation());
    }
    for (std::size_t k = 0; k < motion.dofs.size(); ++k) {
        const Dof& dof = motion.dofs[k];
        Step step;
        step.factor = dofFactor(dof);
        step.before = k == 0 ? toA : Pose::Identity();
        step.after = k + 1 == motion.dofs.size() ? last : Pose::Identity();
        step.path = dof.kind == DofKind::Path;
        if (step.path) {
            step.dof = dof;
            steps_.push_back(step);
            continue;
        }
        const Pose middle = step.before * dofPose(dof, step.factor.middle) * step.after;
        step.constant = rows(middle.linear(), middle.translation());
        if (dof.kind == DofKind::Translation) {
            step.first = rows(Eigen::Matrix3d::Zero(), dof.axis);
            step.second.fill(0);
        } else {
            Eigen::Matrix3d cross;
            cross << 0, -dof.axis.z(), dof.axis.y(), dof.axis.z(), 0, -dof.axis.x(), -dof.axis.y(),
                dof.axis.x(), 0;
            const Pose turned = dofPose(dof, step.factor.middle) * step.after;
            const Vec3 arm = turned.translation() - dof.origin;
            step.first = rows(cross * turned.linear(), cross * arm);
            step.second = rows(cross * cross * turned.linear(), cross * (cross * arm));
        }
        steps_.push_back(step);
    }
}

bool PoseRecipe::affine() const {
    return !steps_.empty() &&
           std::none_of(steps_.begin(), steps_.end(), [](const Step& s) { return s.path; });
}

void PoseRecipe::evaluate(const double* q, double* out) const {
    Matrix whole = fixed_;
    for (std::size_t k = steps_.size(); k-- > 0;) {
        const Step& step = steps_[k];
        Matrix own;
        if (step.path) {
            const Pose p = step.before * dofPose(step.dof, q[k]) * step.after;
            own = rows(p.linear(), p.translation());
        } else {
            double first, second;
            step.factor.evaluate(q[k], first, second);
            for (int i = 0; i < 12; ++i)
                own[i] = step.constant[i] + (first * step.first[i] + second * step.second[i]);
        }
        if (k + 1 == steps_.size()) {
            whole = own;
        } else {
            Matrix product;
            compose(own, whole, product);
            whole = product;
        }
    }
    std::copy(whole.begin(), whole.end(), out);
}

} // namespace tss
