#pragma once
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"

namespace tss {

/// Warns of properties that begin as osgTSS's or UsdPhysics' do and are none of them, with the name that was
/// meant where one is near: a misspelt property is else kept and does nothing.
void remarkTypos(const Layer& layer, Problems& problems);

} // namespace tss
