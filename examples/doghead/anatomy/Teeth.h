#pragma once
#include "examples/doghead/implicit/Field.h"

namespace doghead {

/// The twenty teeth of the upper jaw (3 incisors, canine, 4 premolars of which the last is the carnassial, 2
/// molars a side), in the skull's frame: origin midway between the jaw joints, +X nose, +Y left, +Z up,
/// millimetres.
Field upperTeeth();

/// The twenty-two teeth of the lower jaw (3 incisors, canine, 4 premolars, 3 molars a side, the first the
/// carnassial), in the same frame with the mouth closed: the lower row stands inside the upper one, the lower
/// canine before the upper canine.
Field lowerTeeth();

} // namespace doghead
