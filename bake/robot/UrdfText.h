#pragma once
#include "bake/robot/Robot.h"

#include <tinyxml2.h>

namespace tss {

/// A shape that is none of URDF's.
struct LostShape {
    std::string link;
    bool visual = false;
    RobotShape shape; ///< its place in the file and its problem
};

/// Takes out of the tree of a URDF all that this software does not use (inertias, transmissions, what belongs
/// to simulators) and shapes that are none of URDF's, which it returns; checks what is left where urdfdom
/// names no line: names that are there once, numbers, types, limits. Throws InputError with file, line and
/// element.
std::vector<LostShape> pruneUrdf(tinyxml2::XMLElement& robot, const std::string& file);

/// The tree as text for urdfdom, whose own XML reader then meets nothing odd.
std::string urdfText(const tinyxml2::XMLElement& robot);

/// The colour of a link's first visual that has one, linear RGB.
std::optional<Vec3> urdfColor(const std::string& file, const tinyxml2::XMLElement& link);

} // namespace tss
