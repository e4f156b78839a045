// Others' headers that most sources of the command include: compiled once for all of them
// (OSGTSS_PRECOMPILE).
#include "bake/base/Precompiled.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
