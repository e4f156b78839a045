#include "bake/table/KernelTarget.h"

#include "bake/table/VectorTargets.h"

#include <algorithm>
#include <cstdint>
#include <hwy/targets.h>
#include <iterator>

namespace tss {

namespace {

constexpr std::int64_t everywhere = 0;

/// From the widest vectors to none.
constexpr struct Target {
    KernelTarget target;
    const char* name;
    std::int64_t bit; ///< Highway's, of instructions that a build or a processor may lack
} targets[] = {{KernelTarget::Avx512, "avx512", HWY_AVX3},   {KernelTarget::Avx2, "avx2", HWY_AVX2},
               {KernelTarget::Neon, "neon", HWY_NEON},       {KernelTarget::Sse2, "sse2", HWY_SSSE3},
               {KernelTarget::Scalar, "scalar", everywhere}, {KernelTarget::Best, "best", everywhere}};

const Target& entryOf(KernelTarget target) {
    return *std::ranges::find(targets, target, &Target::target);
}

} // namespace

const char* name(KernelTarget target) {
    return entryOf(target).name;
}

bool kernelTarget(std::string_view text, KernelTarget& target) {
    const Target* found =
        std::ranges::find(targets, text, [](const Target& t) { return std::string_view(t.name); });
    if (found == std::end(targets)) return false;
    target = found->target;
    return true;
}

bool available(KernelTarget target) {
    const std::int64_t bit = entryOf(target).bit;
    return bit == everywhere || (hwy::SupportedTargets() & HWY_TARGETS & bit) != 0;
}

KernelTarget bestTarget() {
    return std::ranges::find_if(targets, available, &Target::target)->target;
}

} // namespace tss
