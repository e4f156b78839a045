#pragma once
#include "bake/reduce/Reduced.h"
#include "bake/search/CandidatePairs.h"

namespace tss {

/// The paper's reduction of a rigid pair (METHOD 3.1), Tc -> Msm. The co-occurrence table Ta counts in how
/// many rows of Tc (spheres of A) two spheres of B appear together; a sphere of B that never appears without
/// some kept other is removed, then rows of A that test the same spheres of B become one (the first stays).
/// It looks at who meets whom, not at when: poses can be lost.
Reduced reduceCooccurrence(const CandidatePairs& candidates);

} // namespace tss
