#pragma once
#include "bake/table/Kernels.h"

namespace tss {

/// The kernels in plain C++, a pair at a time: what every processor has, and what the others are held to.
template <class T>
KernelSet scalarFoldKernels();
template <class T>
KernelSet scalarDirectKernels();

} // namespace tss
