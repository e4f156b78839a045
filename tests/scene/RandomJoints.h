#pragma once
#include "bake/model/SceneModel.h"

#include <random>

/// Joints of all kinds, for tests that hold of any.
namespace samples {

inline double uniform(std::mt19937_64& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

inline tss::Pose randomPose(std::mt19937_64& random) {
    tss::Pose pose = tss::Pose::Identity();
    const Eigen::Vector4d q(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1),
                            uniform(random, 0.1, 1));
    pose.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
    pose.translation() = tss::Vec3(uniform(random, -2, 2), uniform(random, -2, 2), uniform(random, -2, 2));
    return pose;
}

inline tss::Dof randomDof(std::mt19937_64& random, int axis, bool turns) {
    tss::Dof dof;
    dof.name = "d" + std::to_string(axis) + (turns ? "r" : "t");
    dof.kind = turns ? tss::DofKind::Rotation : tss::DofKind::Translation;
    dof.axis = tss::Vec3::Unit(axis) * (turns ? 1.0 : uniform(random, 0.5, 2));
    dof.lower = uniform(random, -1, 0);
    dof.upper = uniform(random, 0, 1);
    return dof;
}

/// A path that turns about a place, or travels without turning: its inverse is one as well.
inline tss::Dof randomPath(std::mt19937_64& random) {
    tss::Dof dof;
    dof.name = "path";
    dof.kind = tss::DofKind::Path;
    dof.frame = randomPose(random);
    const bool turns = random() % 2;
    const tss::Pose still = randomPose(random);
    for (int k = 0; k < 4; ++k) {
        const tss::Pose row = randomPose(random);
        dof.path.push_back({double(k), turns ? still.translation() : row.translation(),
                            Eigen::Quaterniond(turns ? row.linear() : still.linear())});
    }
    dof.lower = 0.5;
    dof.upper = 2.7;
    return dof;
}

inline tss::Joint randomJoint(std::mt19937_64& random, const std::string& name, int body0, int body1) {
    tss::Joint joint;
    joint.path = "/Scene/" + name;
    joint.body0 = body0;
    joint.body1 = body1;
    joint.frame0 = randomPose(random);
    joint.frame1 = randomPose(random);
    for (int axis = 0; axis < 3; ++axis)
        if (random() % 2) joint.dofs.push_back(randomDof(random, axis, random() % 2));
    if (random() % 3 == 0)
        joint.dofs.insert(joint.dofs.begin() +
                              static_cast<std::ptrdiff_t>(random() % (joint.dofs.size() + 1)),
                          randomPath(random));
    joint.drives.resize(joint.dofs.size());
    tss::LimitPlane plane;
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) plane.coefficients.push_back(uniform(random, 0.5, 1));
    plane.bound = 100;
    if (!joint.dofs.empty()) joint.planes = {plane};
    return joint;
}

/// Straight from the definition: T = frame0 * D1...Dd * frame1^-1.
inline tss::Pose jointMatrix(const tss::Joint& joint, const std::vector<double>& q) {
    tss::Pose pose = joint.frame0;
    for (std::size_t k = 0; k < q.size(); ++k) pose = pose * tss::dofPose(joint.dofs[k], q[k]);
    return pose * joint.frame1.inverse();
}

} // namespace samples
