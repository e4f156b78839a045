#pragma once
#include "bake/robot/Robot.h"

#include <tinyxml2.h>

namespace tss {

/// A shape that urdfdom does not read: a capsule, or one with a problem.
struct OwnShape {
    std::string link;
    bool visual = false;
    RobotShape shape;
};

/// What was taken out of the tree of a URDF and is not lost.
struct PrunedUrdf {
    std::vector<OwnShape> shapes;
    std::vector<std::string> notes; ///< joints that were left out
};

/// What is said of a joint that is left out; `child`: the link that it holds, empty where there is none.
std::string leftOutJoint(const std::string& joint, const std::string& where, const std::string& why,
                         const std::string& child);

/// Takes out of the tree of a URDF all that this software does not use (inertias, transmissions, what belongs
/// to simulators), and shapes and joints that cannot be read: numbers that are none, types that are unknown,
/// links that are not there. Throws InputError with file, line and element for links and joints without a
/// name of their own, and where there is no link.
PrunedUrdf pruneUrdf(tinyxml2::XMLElement& robot, const std::string& file);

/// The tree as text for urdfdom, whose own XML reader then meets nothing odd.
std::string urdfText(const tinyxml2::XMLElement& robot);

/// The colour of a link's first visual that has one, linear RGB.
std::optional<Vec3> urdfColor(const std::string& file, const tinyxml2::XMLElement& link);

} // namespace tss
