#pragma once
#include "bake/robot/RobotScene.h"

namespace tss {

/// Folders of packages by name, as on the command line: "NAME=DIR"; empty: the package is left out.
using Packages = std::map<std::string, std::string>;

/// "NAME=DIR" or "NAME=" parts. Throws InputError for what is none, or where DIR is no folder.
Packages parsePackages(const std::vector<std::string>& texts);

/// Finds the meshes that the robot file `file` names:
///   package://NAME/PATH, model://NAME/PATH   in the folder given for NAME; else in the nearest folder
///   upwards from
///                                            the file that is called NAME, holds one called NAME, or has a
///                                            package.xml that says so
///   PATH, file://PATH, package://FILE        beside the file; where it is not there, in the package or the
///                                            checkout of git that the file is in
/// No file outside the package, outside the folder given, or, for a plain path, outside the package and the
/// checkout the file is in (its folder's parent where it is in none) is read, through links neither. Throws
/// InputError that says where it was looked for. Empty for a package that is left out; whether there is such
/// a file is not looked at.
FindMesh meshesOf(const std::string& file, const Packages& packages);

} // namespace tss
