#pragma once
#include <cstdint>
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

/// Pairs as the kernels read them. Blocks of `lanes` pairs, each column of a block contiguous:
///   fold:   [constant - reach|reach|] [weights of feature 0] ... [constant] [reach]
///   direct: [b.x] [b.y] [b.z] [a.x] [a.y] [a.z] [reach|reach|] [reach]
/// Lanes beyond the last pair are far away from everything.
template <class T>
struct KernelData {
    const T* blocks = nullptr;
    std::uint32_t blockCount = 0;
    std::uint32_t columns = 0; ///< features of the fold
};

template <class T>
struct KernelGap {
    T gap = 0;
    std::int32_t test = -1;
};

/// The queries of one target, form and number of features; plain function pointers, fetched once per table.
/// pose: the features (fold), or the 12 numbers of R and t, row-major (direct); shared: the fold's shared
/// term, 0 for direct.
template <class T>
struct KernelSet {
    std::uint32_t lanes = 1;

    bool (*hit)(const KernelData<T>& data, const T* pose, T shared) = nullptr;
    KernelGap<T> (*gap)(const KernelData<T>& data, const T* pose, T shared) = nullptr;

    /// Numbers of the tests whose gap is at most `margin` >= 0, rising, into `out` (room for all lanes of
    /// all blocks). Returns how many; lanes beyond the last pair never qualify.
    std::uint32_t (*under)(const KernelData<T>& data, const T* pose, T shared, T margin,
                           std::uint32_t* out) = nullptr;

    /// Many poses at once against data of lanes 1: value k of pose i at poses[k * stride + i], shared terms
    /// at shared[i]; i up to count rounded up to 16. least: smallest d^2 - reach^2 of each pose (<= 0: hit).
    void (*hits)(const KernelData<T>& rows, const T* poses, std::uint32_t stride, const T* shared,
                 std::uint32_t count, T* least) = nullptr;
    /// Smallest gap and its test, likewise.
    void (*gaps)(const KernelData<T>& rows, const T* poses, std::uint32_t stride, const T* shared,
                 std::uint32_t count, T* gap, std::int32_t* test) = nullptr;
};

inline constexpr std::uint32_t directColumns = 8;
inline constexpr std::uint32_t foldColumns(std::uint32_t features) {
    return features + 3;
}

/// The kernels of a target that is available. features: up to 10 for the fold.
template <class T>
KernelSet<T> foldKernels(KernelTarget target, std::uint32_t features);
template <class T>
KernelSet<T> directKernels(KernelTarget target);

} // namespace tss
