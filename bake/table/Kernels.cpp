#include "bake/table/Kernels.h"

#include "bake/table/KernelsScalar.h"
#include "bake/table/KernelsVector.h"

namespace tss {

namespace {

constexpr KernelTarget named[] = {KernelTarget::Best, KernelTarget::Scalar, KernelTarget::Sse2,
                                  KernelTarget::Avx2, KernelTarget::Avx512, KernelTarget::Neon};

} // namespace

const char* name(KernelTarget target) {
    switch (target) {
    case KernelTarget::Best:
        return "best";
    case KernelTarget::Scalar:
        return "scalar";
    case KernelTarget::Sse2:
        return "sse2";
    case KernelTarget::Avx2:
        return "avx2";
    case KernelTarget::Avx512:
        return "avx512";
    case KernelTarget::Neon:
        return "neon";
    }
    return "?";
}

bool kernelTarget(std::string_view text, KernelTarget& target) {
    for (KernelTarget t : named)
        if (text == name(t)) {
            target = t;
            return true;
        }
    return false;
}

KernelTarget bestTarget() {
    for (KernelTarget t : {KernelTarget::Avx512, KernelTarget::Avx2, KernelTarget::Neon, KernelTarget::Sse2})
        if (available(t)) return t;
    return KernelTarget::Scalar;
}

template <class T>
KernelSet foldKernels(KernelTarget target, std::uint32_t features, std::size_t dofs) {
    if (target == KernelTarget::Best) target = bestTarget();
    if (target == KernelTarget::Scalar) return scalarFoldKernels<T>();
    KernelSet set = vectorFoldQueries<T>(target, features);
    addFoldPoses<T>(target, dofs, set);
    addContact(target, set);
    return set;
}
template <class T>
KernelSet directKernels(KernelTarget target) {
    if (target == KernelTarget::Best) target = bestTarget();
    if (target == KernelTarget::Scalar) return scalarDirectKernels<T>();
    KernelSet set = vectorDirectQueries<T>(target);
    addDirectPoses<T>(target, set);
    addContact(target, set);
    return set;
}
template KernelSet foldKernels<float>(KernelTarget, std::uint32_t, std::size_t);
template KernelSet foldKernels<double>(KernelTarget, std::uint32_t, std::size_t);
template KernelSet directKernels<float>(KernelTarget);
template KernelSet directKernels<double>(KernelTarget);

} // namespace tss
