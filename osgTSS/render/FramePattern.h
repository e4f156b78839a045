#pragma once
#include <string>

namespace osgTSS {

/// A file name with one conversion of a whole number in it, as printf has it: f_%04d.png.
bool isFramePattern(const std::string& pattern);

/// The name of a frame. The pattern must be one.
std::string frameName(const std::string& pattern, unsigned int frame);

} // namespace osgTSS
