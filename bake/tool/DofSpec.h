#pragma once
#include "bake/motion/DofUnits.h"

#include <string>
#include <vector>

namespace tss::tool {

/// A DOF from its text on the command line (docs/TSS.md, tss make):
///   rot:ORIGIN:AXIS:LO:HI     degrees; the axis is made a unit vector
///   trans:AXIS:LO:HI          multiples of the axis; a limit with a unit is a length along it
///   path:FILE.csv:LO:HI       rows value,tx,ty,tz[,rx,ry,rz], rotation vector in degrees
/// ORIGIN and AXIS are x,y,z. Throws InputError that quotes the text and says what was expected.
Dof parseDof(const std::string& text, double metersPerUnit);

/// Several in turn. They are called rot, trans or path, and numbered from 1 where there are several of a
/// kind.
std::vector<Dof> parseDofs(const std::vector<std::string>& texts, double metersPerUnit);

/// Whether parseDofs() gives this name.
bool isParsedName(const std::string& name);

/// The parts between separators, empty ones too: at least one.
std::vector<std::string> split(const std::string& text, char separator);

/// "x,y,z". Throws InputError.
Vec3 parseVector(const std::string& text, const std::string& what);

/// Comma-separated numbers. Throws InputError.
std::vector<double> parseNumbers(const std::string& text, const std::string& what);

/// "open 0 to 24 degrees, rest 0; push 0 to 2 times 9.04 mm, rest 0; ..."
std::string describeDofs(const Motion& motion, double metersPerUnit);

/// What a unit is long in metres: "0.001", or as well "1mm". Throws InputError that quotes the option.
double parseUnit(const std::string& text, const std::string& option);

} // namespace tss::tool
