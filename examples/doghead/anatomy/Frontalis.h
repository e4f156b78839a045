#pragma once
#include "examples/doghead/implicit/Field.h"

namespace doghead {

/// The frontalis: a sheet over the forehead, from the crest of the skull forward to the brows, in the skull's
/// frame.
Field frontalis();

/// Its fibre line in the middle plane, from the origin on the crest to the insertion at the brow.
std::vector<Vec3> frontalisFibre();

} // namespace doghead
