#include "bake/table/Kernels.h"

#include "bake/table/KernelsScalar.h"
#include "bake/table/KernelsVector.h"

namespace tss {

template <class T>
KernelSet foldKernels(KernelTarget target, std::uint32_t features, std::size_t dofs) {
    if (target == KernelTarget::Best) target = bestTarget();
    if (target == KernelTarget::Scalar) return scalarFoldKernels<T>();
    KernelSet set = vectorFoldQueries<T>(target, features);
    addFoldCrowd<T>(target, features, set);
    addFoldPoses<T>(target, dofs, set);
    addContact(target, set);
    return set;
}
template <class T>
KernelSet directKernels(KernelTarget target) {
    if (target == KernelTarget::Best) target = bestTarget();
    if (target == KernelTarget::Scalar) return scalarDirectKernels<T>();
    KernelSet set = vectorDirectQueries<T>(target);
    addDirectCrowd<T>(target, set);
    addDirectPoses<T>(target, set);
    addContact(target, set);
    return set;
}
template KernelSet foldKernels<float>(KernelTarget, std::uint32_t, std::size_t);
template KernelSet foldKernels<double>(KernelTarget, std::uint32_t, std::size_t);
template KernelSet directKernels<float>(KernelTarget);
template KernelSet directKernels<double>(KernelTarget);

} // namespace tss
