#pragma once
#include "bake/fill/HollowBodies.h"

#include <algorithm>
#include <limits>

namespace tss {

/// What is known of two bodies of which one may stand wholly inside the other.
struct Nesting {
    HollowBodies outer;     ///< a part of the other body stands inside it at some pose, surfaces apart
    HollowBodies undecided; ///< neither that nor the contrary was shown within the effort
    double settled = 0;     ///< scene units: inside a body that is neither, no part stands with the surfaces
                            ///< farther apart than this

    /// Scene units: no point inside a body that is not `outer` is farther from its surface than this.
    double deepest = std::numeric_limits<double>::infinity();

    /// How far apart the surfaces may be while a part stands inside a body that is not `outer`, scene units;
    /// infinity: no bound was shown.
    double apart() const { return undecided ? std::max(settled, deepest) : settled; }
};

/// Whether a connected part of one body's surface ever stands inside the other body's solid, its openings
/// closed, while the surfaces are farther apart than `reach`, > 0: not contact, though solids that are filled
/// would say so. Branch and bound over Q: a part is not inside all over a cell where one of its vertices
/// stays outside, a ball that it encloses has no room, or the surfaces stay within reach of each other; where
/// the effort will not suffice to show that, random steps look for a pose inside. Where neither `outer` nor
/// `undecided` is set that is proven for all of Q. (What reaches into an opening without being inside as a
/// whole findHollow() looks for.) Surfaces from three quarters of the reach on may count as farther. The same
/// for any number of threads.
Nesting findNested(const Solid& a, const Solid& b, const Motion& motion, double reach,
                   const Progress& progress = {});

} // namespace tss
