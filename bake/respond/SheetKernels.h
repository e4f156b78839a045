#pragma once
#include "bake/respond/SheetPatch.h"
#include "bake/table/Kernels.h"

namespace tss {

/// What a sweep changes. The fourth lane of a displacement holds the vertex's inverse mass, which one load
/// then brings along; multipliers' fourth lanes and those of places left over stay 0.
struct SheetState {
    std::vector<Move> u;        ///< #vertices + 1
    std::vector<float> stretch; ///< 8 a pack of edges: multipliers
    std::vector<float> bend;    ///< 8 a pack of bends: x, y, z, 0 of both
    std::vector<Move> rim;      ///< one a bend along a rim

    explicit SheetState(const PackedSheet& sheet);
    /// As it was made.
    void reset(const PackedSheet& sheet);
};

/// Vertices from the first to before the last.
struct SheetRun {
    std::uint32_t first = 0, last = 0;
};

/// What a sweep came to.
struct SheetMeasure {
    float change = 0; ///< largest of a coordinate of a displacement
    double dual = 0;  ///< sum over vertices of mass (u - b).(u + b)/2, b the displacement before
};

/// The loops over a packed sheet, or some blocks of it, rising, for one kind of vectors.
struct SheetKernels {
    using Blocks = std::span<const std::uint32_t>;

    /// u = reference + w J^T m.
    void (*displace)(const PackedSheet&, const Move* reference, SheetState&);
    /// Every edge and bend once, in order.
    void (*sweepTo)(const PackedSheet&, Blocks, SheetState&);
    /// Every bend and edge once, in reverse order. Returns 1/2 sum compliance m^2.
    double (*sweepFro)(const PackedSheet&, Blocks, SheetState&);
    /// The same sum without a sweep.
    double (*strainEnergy)(const PackedSheet&, Blocks, const SheetState&);
    SheetMeasure (*measure)(const PackedSheet&, std::span<const SheetRun>, const Move* before, const Move* u);
    /// now += momentum (now - before); before: the old now.
    void (*extrapolate)(float momentum, float* now, float* before, std::size_t count);
};

/// target: must be available. The results differ between targets by rounding.
const SheetKernels& sheetKernels(KernelTarget target = KernelTarget::Best);

} // namespace tss
