#include "bake/table/Kernels.h"

namespace tss {

template <class T>
KernelSet makeKernels(KernelTarget target, const KernelShape& shape) {
    if (target == KernelTarget::Best) target = bestTarget();
    KernelSet set;
    addQueries<T>(target, shape, set);
    addPoses<T>(target, shape, set);
    addContact(target, set);
    return set;
}
template KernelSet makeKernels<float>(KernelTarget, const KernelShape&);
template KernelSet makeKernels<double>(KernelTarget, const KernelShape&);

} // namespace tss
