#pragma once
#include "bake/table/Kernels.h"

namespace tss {

// Each puts some kernels of a target into the set; what the target or the build has none of is left.

/// lanes, and the queries of one pose and of many.
template <class T>
void addQueries(KernelTarget target, const KernelShape& shape, KernelSet& set);
/// pose and poses.
template <class T>
void addPoses(KernelTarget target, const KernelShape& shape, KernelSet& set);
void addContact(KernelTarget target, KernelSet& set);

} // namespace tss
