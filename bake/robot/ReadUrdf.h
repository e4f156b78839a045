#pragma once
#include "bake/robot/Robot.h"

namespace tss {

/// Reads a robot from the text of a URDF. Radians and metres as there; a continuous joint turns once round; a
/// joint that mimics another goes as far as the other's limits lead it. Left out with a note: floating
/// and planar joints and those that cannot be read (their links are tied to nothing), shapes that cannot be
/// read or are none of URDF's (capsules are). Throws InputError with file, line and element.
Robot readUrdf(const std::string& text, const std::string& file);

/// Adds the pairs of links whose collision the text of an SRDF switches off to those of the robot. Throws
/// InputError as readUrdf() does; a link that the robot does not have is noted.
void readSrdf(Robot& robot, const std::string& text, const std::string& file);

} // namespace tss
