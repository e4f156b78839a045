#pragma once
#include "bake/pipeline/SelectTests.h"

namespace tss {

/// Turns the clearance of the spheres in a proof into that of the meshes, which is less by both coverages.
/// Where nothing is left, or the meshes meet at rest, the proof is dropped and leaves a certified table
/// without tests.
void boundProof(Selection& selection, const PairTask& task);

/// Fills in the bounds of a certified table against the meshes, the exempt region apart (METHOD 3.5).
void boundTable(Table& table, const PairTask& task);

} // namespace tss
