#include "bake/table/KernelTarget.h"

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

} // namespace tss
