#pragma once
#include "bake/scene/Layer.h"
#include "bake/usd/LeftOut.h"

namespace tss {

/// What others write of UsdPhysics' and UsdGeom's attributes in another type of as many numbers, as in
/// `float3 physics:localPos0`, `point3f xformOp:translate` or `double physics:lowerLimit`, in the type of the
/// schema; quaternions of any length but 0 as ones of length 1, noted; operations in xformOpOrder that have no
/// property left out, noted. Throws InputError with the path where a number does not fit.
void adaptTypes(Layer& layer, const std::string& file, LeftOut& leftOut);

} // namespace tss
