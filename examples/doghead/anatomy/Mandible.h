#pragma once
#include "examples/doghead/implicit/Field.h"

namespace doghead {

/// The mandible with its lower teeth, one closed surface, in the skull's frame with the mouth closed (the
/// teeth just free of each other). It hinges about the Y axis.
Field mandible();

} // namespace doghead
