#pragma once
#include "bake/respond/SheetKernels.h"

#include <span>

namespace tss {

/// normal . sum weight_k u_k >= bound.
struct SheetPlane {
    Move normal = Move::Zero(); ///< zero: not in use
    std::uint32_t vertex[3] = {0, 0, 0};
    float weight[3] = {0, 0, 0};
    int vertices = 3; ///< of the three, from the first on; the others weigh 0
    float bound = 0;
    float compliance = 0, inverse = 0; ///< set by SkinSolver
    float multiplier = 0;              ///< >= 0, kept from one solve to the next

    bool used() const { return inverse > 0; }
};

/// Balances a sheet between its holds, its elasticity and the planes: minimises
///   1/2 sum |u - reference|^2 / w + 1/2 sum C^2 / compliance   where the planes allow.
/// XPBD sweeps to and fro over the multipliers, which is coordinate descent on the dual, sped up by momentum.
/// A step that does not lower the dual is taken back and the momentum dropped, so that the way is downhill
/// all along, at any stiffness. Multipliers are kept for the next solve.
class SkinSolver {
public:
    explicit SkinSolver(const PackedSheet& sheet, KernelTarget target = KernelTarget::Best);

    /// Forgets all multipliers.
    void reset();

    /// Multiplies all multipliers: a better start for a problem that is nearly so many times the last one.
    void scale(float factor);

    /// reference: #vertices, fourth lane 0. Stops early when no displacement changes by more than `tolerance`
    /// in a sweep. Returns the last such change.
    float solve(std::span<const Move> reference, std::vector<SheetPlane>& planes, int sweeps,
                float tolerance);

    /// #vertices; the fourth lane is not part of the displacement.
    std::span<const Move> displacements() const { return {state_.u.data(), sheet_.vertexCount()}; }

private:
    void prepare(std::vector<SheetPlane>& planes);
    void push(SheetPlane& plane);
    bool stirred(const SheetPlane& plane) const;
    void sweep(std::vector<SheetPlane>& planes);
    double planeEnergy(const std::vector<SheetPlane>& planes) const;
    void keep(const std::vector<SheetPlane>& planes);
    void takeBack(std::vector<SheetPlane>& planes);
    void accelerate(float momentum, std::vector<SheetPlane>& planes);

    const PackedSheet& sheet_;
    const SheetKernels& kernels_;
    SheetState state_, before_;
    double energy_ = 0;                 ///< 1/2 compliance m^2 of edges and bends, after the last sweep
    std::vector<std::uint32_t> used_;   ///< planes in use
    std::vector<float> planeBefore_;    ///< #used
    std::vector<std::uint32_t> pushed_; ///< #vertices: the last sweep in which a plane pushed it
    std::uint32_t sweep_ = 0;
};

} // namespace tss
