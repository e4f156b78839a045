#pragma once
#include "bake/pipeline/SelectTests.h"

namespace tss {

/// What a proof over spheres says of the meshes: these stay as far apart as the spheres do, less what they
/// lack of the surfaces. Where that is nothing, or the meshes meet at rest, there is no proof but a certified
/// table without tests.
void boundProof(Selection& selection, const PairTask& task);

/// What the meshes may expect of a certified table, but for the region that overlaps at rest (METHOD 3.5).
void boundTable(Table& table, const PairTask& task);

} // namespace tss
