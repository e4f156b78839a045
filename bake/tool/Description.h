#pragma once
#include "bake/tool/Command.h"

namespace tss::tool {

/// A summary of a scene (Summary.h) for people: one block of lines for each pair and skin (docs/TSS.md,
/// section 2, has what each line says).
std::string describe(const Json& summaryOfScene);

} // namespace tss::tool
