#pragma once
#include "examples/doghead/implicit/Field.h"

namespace doghead {

/// Room left around the jaw's condyles in their sockets, mm.
constexpr double socketClearance = 0.9;

/// The condyle of the left jaw joint: a roller on the hinge axis (the Y axis) and its neck ends.
constexpr double condyleRadius = 3.8, condyleInner = 30.5, condyleOuter = 40.5;

/// The brain case and the forehead without crests and arches: what the muscles of the brow lie on.
Field cranium();

/// The skull without the mandible, with its upper teeth, one closed surface; about 174 mm long. Origin midway
/// between the jaw joints, +X nose, +Y left, +Z up, millimetres.
Field skull();

} // namespace doghead
