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

    /// Forgets all multipliers: all displacements are 0.
    void reset();

    /// Multiplies all multipliers: a better start for a problem that is nearly so many times the last one.
    /// Only before solve().
    void scale(float factor);

    /// reference: #vertices, fourth lane 0. Stops early when no displacement changes by more than `tolerance`
    /// in a sweep. Returns the last such change.
    float solve(std::span<const Move> reference, std::vector<SheetPlane>& planes, int sweeps,
                float tolerance);

    /// The same with the reference of the last solve, or 0 after a reset, for planes that have moved on
    /// since. Only where displacements have changed by more than `calm` since all that bears on them was last
    /// balanced: what is hardly moved waits until it is.
    float follow(std::vector<SheetPlane>& planes, int sweeps, float tolerance, float calm);

    /// #vertices; the fourth lane is not part of the displacement.
    std::span<const Move> displacements() const { return {state_.u.data(), sheet_.vertexCount()}; }

    /// How far the displacements are from a plane's bound; < 0: beyond it.
    float slack(const SheetPlane& p) const {
        float c = p.weight[0] * p.normal.dot(state_.u[p.vertex[0]]) - p.bound;
        for (int k = 1; k < p.vertices; ++k) c += p.weight[k] * p.normal.dot(state_.u[p.vertex[k]]);
        return c;
    }

private:
    /// What a plane has moved a vertex by.
    struct Push {
        std::uint32_t vertex = 0;
        Move move = Move::Zero();
    };

    void prepare(std::vector<SheetPlane>& planes);
    void displace();
    void pushBy(const std::vector<SheetPlane>& planes);
    void pushNoMore();
    void noteOld(const std::vector<SheetPlane>& planes);
    bool movedOn(std::uint32_t vertex, float calm) const;
    void wake(std::uint32_t vertex);
    void findRestless(const std::vector<SheetPlane>& planes, float calm);
    void chooseBlocks();
    void choosePlanes(const std::vector<SheetPlane>& planes, float calm);
    void takeNear(const std::vector<SheetPlane>& planes, float calm);
    void chooseRuns();
    bool moves(std::uint32_t vertex) const {
        return isSwept_[PackedSheet::blockOf(vertex)] != 0 || beside_[vertex] == solve_;
    }

    float balance(std::vector<SheetPlane>& planes, int sweeps, float tolerance, float calm);
    void push(SheetPlane& plane);
    bool stirred(const SheetPlane& plane) const;
    double sweep(std::vector<SheetPlane>& planes);
    double planeEnergy(const std::vector<SheetPlane>& planes) const;
    template <class Visit>
    void visitMoving(SheetState& now, SheetState& before, const Visit& visit) const;
    void keep(const std::vector<SheetPlane>& planes);
    void takeBack(std::vector<SheetPlane>& planes);
    void accelerate(float momentum, std::vector<SheetPlane>& planes);

    const PackedSheet& sheet_;
    const SheetKernels& kernels_;
    SheetState state_, before_; ///< the same where nothing moves
    std::uint32_t solve_ = 0, sweep_ = 0;
    std::uint32_t follows_ = 0; ///< since the displacements were last found from the multipliers

    std::vector<std::uint32_t> used_;        ///< planes in use
    std::vector<float> slack_;               ///< #used, as a solve begins
    std::vector<std::uint32_t> taken_, far_; ///< planes that this solve sweeps; that it may come to sweep
    std::vector<float> planeBefore_;         ///< #taken
    std::vector<std::uint32_t> pushed_;      ///< #vertices: the last sweep in which a plane pushed it
    std::vector<Push> old_;                  ///< of the planes of the last solve

    std::vector<std::uint8_t> isRestless_, isSwept_; ///< #blocks; those that the next solve has to sweep
    std::vector<std::uint32_t> swept_;               ///< blocks that this solve sweeps, rising
    std::vector<std::uint32_t> beside_; ///< #vertices: the last solve that moved it from outside its block
    std::vector<std::uint32_t> besideList_;
    std::vector<SheetRun> runs_;  ///< vertices that this solve may move
    std::vector<Move> reference_; ///< #vertices, of the last solve
    std::vector<Move> balanced_;  ///< #vertices: where it was when all that bears on it was last swept
};

} // namespace tss
