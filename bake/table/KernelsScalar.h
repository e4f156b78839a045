#pragma once
#include "bake/table/Kernels.h"

namespace tss {

/// The kernels in plain C++, a pair at a time: what every processor has, and what the others are held to.
template <class T>
KernelSet scalarFoldKernels();
template <class T>
KernelSet scalarDirectKernels();

/// The kernels of a vector target; empty pointers where the build has none.
template <class T>
KernelSet vectorFoldKernels(KernelTarget target, std::uint32_t features);
template <class T>
KernelSet vectorDirectKernels(KernelTarget target);

} // namespace tss
