#pragma once
#include "bake/robot/Robot.h"

#include <functional>

namespace tss {

/// Reads a robot from the text of a URDF. Radians and metres as there; a continuous joint turns once round; a
/// joint that mimics another goes as far as the other's limits lead it. Left out with a note: floating
/// and planar joints and those that cannot be read (their links are tied to nothing), shapes that cannot be
/// read or are none of URDF's (capsules are). Throws InputError with file, line and element.
Robot readUrdf(const std::string& text, const std::string& file);

/// Adds the pairs of links whose collision the text of an SRDF switches off to those of the robot. Throws
/// InputError as readUrdf() does; a link that the robot does not have is noted.
void readSrdf(Robot& robot, const std::string& text, const std::string& file);

/// The text of a file that a model includes, from its name there. Throws InputError.
using ReadOther = std::function<std::string(const std::string& name)>;

/// Reads a model from the text of an MJCF of MuJoCo: bodies, geoms, joints, default classes, frames,
/// excludes. Hinges and balls without limits turn once round; a ball becomes three turns about x, y, z whose
/// limits hold all that its own angle does. Left out with a note, by name: free joints and slides without
/// limits (their bodies are tied to nothing), planes, height fields and the like, shapes fitted to a mesh,
/// equalities, what makes bodies by a rule. Throws InputError with file, line and element.
Robot readMjcf(const std::string& text, const std::string& file, const ReadOther& readOther);

} // namespace tss
