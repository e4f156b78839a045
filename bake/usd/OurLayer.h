#pragma once
#include "bake/scene/Layer.h"

namespace tss {

/// Whether a layer is a scene of this software: one that writeUsda() marked, or one with Tss schemas. What
/// writeUsda() had no word for is put back where it was. Throws InputError where that cannot be read, or for
/// names that a scene file cannot have.
bool restoreOurs(Layer& layer, const std::string& file);

} // namespace tss
