#pragma once
#include "bake/robot/Robot.h"

#include <tinyxml2.h>

namespace tss {

/// Takes out of the tree of a URDF all that this software does not use (inertias, transmissions, what belongs
/// to simulators) and shapes that are none of URDF's, these with a note; checks what is left where urdfdom
/// names no line: names that are there once, numbers, types, limits. Throws InputError with file, line and
/// element.
void pruneUrdf(tinyxml2::XMLElement& robot, const std::string& file, std::vector<std::string>& notes);

/// The tree as text for urdfdom, whose own XML reader then meets nothing odd.
std::string urdfText(const tinyxml2::XMLElement& robot);

/// The colour of a link's first visual that has one, linear RGB.
std::optional<Vec3> urdfColor(const std::string& file, const tinyxml2::XMLElement& link);

} // namespace tss
