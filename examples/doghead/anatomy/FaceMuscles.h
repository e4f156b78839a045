#pragma once
#include "examples/doghead/implicit/Field.h"

#include <string>
#include <vector>

namespace doghead {

/// A muscle of the face as a strap under the skin.
struct Strap {
    std::string name;
    std::vector<Vec3> fibre; ///< from origin to insertion
    Field field;
    double contraction = 0.2; ///< greatest shortening, of the chord
};

/// The muscles of the left side that move lips, eyelids and cheek: zygomaticus, levator nasolabialis,
/// orbicularis oris, retractor anguli oculi, masseter and temporalis. Each lies wholly under the skin,
/// closely.
std::vector<Strap> faceStraps();

/// The strap of the other side.
Strap mirroredStrap(const Strap& strap);

} // namespace doghead
