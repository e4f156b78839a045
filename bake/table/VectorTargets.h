#pragma once
// For sources that Highway compiles once for each kind of vectors (foreach_target): which kinds, and the way
// to the one that was asked for. To be included before Highway; between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE such a source is seen several times, below HWY_ONCE once.
// SVE's vectors have no size that a compiler knows, and the kernels keep theirs in arrays.
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#include <hwy/detect_targets.h>

// TSS_TARGETS(call): returns `call` of the namespace that `target` names, and goes on where there is none.
// Each namespace exists only where this build compiles for it.
#if HWY_TARGETS & HWY_SSSE3
#define TSS_SSE2(call)                                                                                       \
    if (target == KernelTarget::Sse2) return N_SSSE3::call;
#else
#define TSS_SSE2(call)
#endif
#if HWY_TARGETS & HWY_AVX2
#define TSS_AVX2(call)                                                                                       \
    if (target == KernelTarget::Avx2) return N_AVX2::call;
#else
#define TSS_AVX2(call)
#endif
#if HWY_TARGETS & HWY_AVX3
#define TSS_AVX512(call)                                                                                     \
    if (target == KernelTarget::Avx512) return N_AVX3::call;
#else
#define TSS_AVX512(call)
#endif
#if HWY_TARGETS & HWY_NEON
#define TSS_NEON(call)                                                                                       \
    if (target == KernelTarget::Neon) return N_NEON::call;
#else
#define TSS_NEON(call)
#endif
#define TSS_TARGETS(call)                                                                                    \
    (void)target;                                                                                            \
    TSS_SSE2(call) TSS_AVX2(call) TSS_AVX512(call) TSS_NEON(call)
