#pragma once
#include "bake/table/Kernels.h"

namespace tss {

/// The queries of one pose of a vector target; empty pointers where the build has none.
template <class T>
KernelSet vectorFoldQueries(KernelTarget target, std::uint32_t features);
template <class T>
KernelSet vectorDirectQueries(KernelTarget target);

/// KernelSet's hits and gaps, likewise.
template <class T>
void addFoldCrowd(KernelTarget target, std::uint32_t features, KernelSet& set);
template <class T>
void addDirectCrowd(KernelTarget target, KernelSet& set);

/// KernelSet's pose and poses of a fold, of a motion of `dofs` DOFs; left null where the target has none.
template <class T>
void addFoldPoses(KernelTarget target, std::size_t dofs, KernelSet& set);
/// KernelSet's pose and poses of direct kernels, likewise.
template <class T>
void addDirectPoses(KernelTarget target, KernelSet& set);

/// KernelSet's contact.
void addContact(KernelTarget target, KernelSet& set);

} // namespace tss
