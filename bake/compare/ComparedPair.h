#pragma once
#include "bake/motion/Motion.h"
#include "bake/table/Table.h"

#include <optional>

namespace tss::compare {

/// Two bodies as all methods are given them. B's frame moves in A's by the motion.
struct ComparedPair {
    TriangleMesh meshA, meshB;
    Motion motion;
    SphereSet a, b;       ///< the whole sphere sets (the paper's Ms)
    FitRecord fitA, fitB; ///< of a and b, as far as it is known
    Table table;          ///< the reduced pairs, and which spheres of a and b they use
};

/// What a yes/no over the whole sphere sets can promise against the meshes. A contact is a common point: with
/// spheres that lack at most `coverage` of each surface the gap there is at most the sum of both, so only
/// spheres that contain the surface miss nothing; with protrusion, spheres touch where the meshes are as near
/// as both protrusions together.
inline std::optional<double> earlyOf(const FitRecord& a, const FitRecord& b) {
    if (!a.protrusion || !b.protrusion) return std::nullopt;
    return *a.protrusion + *b.protrusion;
}
inline std::optional<double> missOf(const FitRecord& a, const FitRecord& b) {
    if (!a.coverage || !b.coverage) return std::nullopt;
    return std::max(0.0, *a.coverage + *b.coverage);
}

} // namespace tss::compare
