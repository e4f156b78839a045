#pragma once
#include "bake/motion/Motion.h"

#include <string>

namespace tss::tool {

/// A DOF from its text on the command line (DESIGN "tss make"):
///   rot:ORIGIN:AXIS:LO:HI     degrees; the axis is made a unit vector
///   trans:AXIS:LO:HI          multiples of the axis; a limit with a unit is a length along it
///   path:FILE.csv:LO:HI       rows value,tx,ty,tz[,rx,ry,rz], rotation vector in degrees
/// ORIGIN and AXIS are x,y,z. Throws InputError that quotes the text and says what was expected.
Dof parseDof(const std::string& text, double metersPerUnit);

/// "x,y,z". Throws InputError.
Vec3 parseVector(const std::string& text, const std::string& what);

/// Comma-separated numbers. Throws InputError.
std::vector<double> parseNumbers(const std::string& text, const std::string& what);

/// "open 0 to 24 degrees, rest 0; ..."
std::string describeDofs(const Motion& motion);

/// Values of a DOF as people write them: degrees for rotations, else as they are.
double toUser(const Dof& dof, double q);
double fromUser(const Dof& dof, double value);

} // namespace tss::tool
