#pragma once
#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace tss {

/// x, y, z of a displacement and a zero: one aligned load.
using Move = Eigen::Vector4f;

/// direction . (u_i - u_j) = 0, direction along the edge at rest.
struct SheetEdge {
    Move direction;
    std::uint32_t i = 0, j = 0;
    float compliance = 0;
    float inverse = 0;          ///< 1 / (w_i + w_j + compliance)
    float massI = 0, massJ = 0; ///< w_i, w_j
};

/// u_centre - weighted mean of u over the ring = 0: three equations at once.
struct SheetBend {
    std::uint32_t centre = 0, first = 0, last = 0; ///< ring: range in SkinSheet::ring
    float compliance = 0, inverse = 0, mass = 0;
};

/// An elastic sheet in which all equations are linear in the displacements (METHOD 6.3), so that the problem
/// is convex: one answer, whatever came before. Immutable.
struct SkinSheet {
    std::vector<float> inverseMass; ///< w of each vertex, with everything that holds it; 0: fixed
    std::vector<SheetEdge> edges;
    std::vector<SheetBend> bends;
    std::vector<std::uint32_t> ring;
    std::vector<float> ringShare; ///< #ring: what that vertex weighs in the mean, 1 together
    std::vector<float> ringMass;  ///< #ring: w of that vertex times its share
};

/// A part of a sheet; what lies around it does not move.
struct SheetPatch {
    std::vector<std::uint32_t> vertices; ///< of the whole sheet, rising
    SkinSheet sheet;                     ///< its own indices are into `vertices`
};

/// inside: #vertices of the whole sheet.
SheetPatch patchOf(const SkinSheet& whole, const std::vector<bool>& inside);

/// normal . sum weight_k u_k >= bound.
struct SheetPlane {
    Move normal = Move::Zero(); ///< zero: not in use
    std::uint32_t vertex[3] = {0, 0, 0};
    float weight[3] = {0, 0, 0};
    float bound = 0;
    float compliance = 0, inverse = 0; ///< set by SkinSolver
    float multiplier = 0;              ///< >= 0, kept from one solve to the next

    bool used() const { return inverse > 0; }
};

/// Balances a sheet between its holds, its elasticity and the planes: minimises
///   1/2 sum |u - reference|^2 / w + 1/2 sum C^2 / compliance   where the planes allow.
/// XPBD sweeps to and fro over the multipliers, which is coordinate descent on the dual, sped up by momentum.
/// A step that does not lower the dual is taken back and the momentum dropped, so that the way is downhill
/// all along, at any stiffness. Multipliers are kept for the next solve. Vertices are four floats, so that
/// each equation is a few vector instructions without any colouring.
class SkinSolver {
public:
    explicit SkinSolver(const SkinSheet& sheet);

    /// Forgets all multipliers.
    void reset();

    /// Multiplies all multipliers: a better start for a problem that is nearly so many times the last one.
    void scale(float factor);

    /// reference: #vertices. Stops early when no displacement changes by more than `tolerance` in a sweep.
    /// Returns the last such change.
    float solve(std::span<const Move> reference, std::vector<SheetPlane>& planes, int sweeps,
                float tolerance);

    std::span<const Move> displacements() const { return u_; }

private:
    void prepare(std::vector<SheetPlane>& planes) const;
    void warmStart(std::span<const Move> reference, const std::vector<SheetPlane>& planes);
    void stretch(std::size_t edge);
    void bend(std::size_t bend);
    void push(SheetPlane& plane);
    void sweep(std::vector<SheetPlane>& planes);
    double dual(std::span<const Move> reference, const std::vector<SheetPlane>& planes) const;
    void keep(const std::vector<SheetPlane>& planes);
    void takeBack(std::vector<SheetPlane>& planes);
    void accelerate(float momentum, std::vector<SheetPlane>& planes);

    const SkinSheet& sheet_;
    std::vector<Move> u_, uBefore_;
    std::vector<float> stretch_, stretchBefore_;
    std::vector<Move> bend_, bendBefore_;
    std::vector<float> planeBefore_;
};

} // namespace tss
