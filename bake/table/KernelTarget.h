#pragma once
#include <string_view>

namespace tss {

/// Which instructions the query kernels use. Best: the widest that this processor has.
enum class KernelTarget { Best, Scalar, Sse2, Avx2, Avx512, Neon };

/// "scalar", "sse2", ... ; sse2 stands for vectors of 128 bits, which also take SSSE3.
const char* name(KernelTarget target);

/// The target of that name ("best" too), and whether there is one.
bool kernelTarget(std::string_view name, KernelTarget& target);

/// Whether this processor can run it and this build has it.
bool available(KernelTarget target);

/// The widest available one.
KernelTarget bestTarget();

} // namespace tss
