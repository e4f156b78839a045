#pragma once
#include "bake/compare/CollisionMethod.h"
#include "bake/motion/Motion.h"
#include "bake/table/Table.h"

namespace tss::compare {

/// Two bodies as all methods are given them. B's frame moves in A's by the motion.
struct ComparedPair {
    TriangleMesh meshA, meshB;
    Motion motion;
    SphereSet a, b;       ///< the whole sphere sets (the paper's Ms)
    FitRecord fitA, fitB; ///< of a and b, as far as it is known
    Table table;          ///< the reduced pairs, and which spheres of a and b they use
};

/// What a yes/no answer over the whole sphere sets promises against the meshes. miss: where the meshes touch,
/// the gap of the spheres is at most the sum of both coverages, which is 0 for spheres that contain the
/// surfaces. early: where spheres touch, the meshes are no farther apart than the sum of both protrusions.
inline StatedError statedBySpheres(const ComparedPair& pair) {
    const FitRecord &a = pair.fitA, &b = pair.fitB;
    StatedError stated;
    if (a.coverage && b.coverage) stated.miss = std::max(0.0, *a.coverage + *b.coverage);
    if (a.protrusion && b.protrusion) stated.early = *a.protrusion + *b.protrusion;
    return stated;
}

} // namespace tss::compare
