#pragma once
#include "bake/fill/HollowBodies.h"

#include <algorithm>
#include <cstdint>
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

/// How long nested bodies are looked for.
struct NestingEffort {
    /// The search gives up after so many probes. A probe is a distance query of a vertex, a tenth of a
    /// microsecond where most vertices are far from the surface, or a look at two triangles.
    std::uint64_t probes = 30'000'000;
    bool walks = true; ///< then random steps look for a pose with the part inside
};

/// Whether at some pose of Q a connected part of one body's surface is wholly inside the other body (its
/// openings closed) while the surfaces are farther apart than `reach`, > 0. That is no contact, but spheres
/// that fill the outer body would report it. Branch and bound over Q: a cell is done where one vertex of the
/// part stays outside, where a ball inside the part does not fit, or where the surfaces stay within reach of
/// each other. If
/// neither `outer` nor `undecided` is set, it is proven that there is no such pose. Distances between three
/// quarters of the reach and the reach may count as either. A part that only reaches into an opening is the
/// business of findHollow(). The same result for any number of threads.
Nesting findNested(const Solid& a, const Solid& b, const Motion& motion, double reach,
                   const Progress& progress = {}, const NestingEffort& effort = {});

/// What is known without a search where one body inside the other counts as contact: no part stands inside a
/// body deeper than `deepest`.
Nesting insideIsContact(const Solid& a, const Solid& b);

} // namespace tss
