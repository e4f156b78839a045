#pragma once
#include "bake/motion/Motion.h"

#include <string>
#include <vector>

namespace osgTSS {

/// Words such as "rotZ:-24:18": a turn in degrees, or a slide in units of length, with its limits. `tag` is
/// named in errors: throws tss::InputError for another word, and for reversed limits.
std::vector<tss::Dof> parseDofWords(const std::string& words, const std::string& tag);

} // namespace osgTSS
