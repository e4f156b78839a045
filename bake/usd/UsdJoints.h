#pragma once
#include "bake/robot/Robot.h"
#include "bake/scene/SceneParts.h"
#include "bake/usd/LeftOut.h"

#include <functional>

namespace tss {

/// Where the end of a joint is: a link (-1: the world), and the prim's frame in the link's. Points of the
/// prim may be stretched on their way.
struct JointEnd {
    int link = -1;
    Eigen::Affine3d points = Eigen::Affine3d::Identity();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    bool simulated = false; ///< joints move it: a rigid body that is not kinematic
    bool kinematic = false; ///< it is moved from outside
};

/// The end that a path names; the world for an empty one.
using FindJointEnd = std::function<JointEnd(const PrimReader& joint, const std::string& path)>;

/// Reads all joints of a stage into the robot, as a forest of `links` links from the world down. What cannot
/// be one is left out by name.
void readUsdJoints(const SceneReading& reading, const FindJointEnd& findEnd, Robot& robot, LeftOut& leftOut);

} // namespace tss
