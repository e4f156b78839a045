#include "bake/respond/SkinSolver.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Compliance of a contact as a share of its inverse mass. Contacts hardly fight each other, so far less than
/// the sheet's floor keeps their multipliers from creeping, and the skin stays nearer to the surface.
constexpr float contactFloor = 0.01f;

} // namespace

SkinSolver::SkinSolver(const SkinSheet& sheet)
    : sheet_(sheet), u_(sheet.inverseMass.size(), Move::Zero()), stretch_(sheet.edges.size(), 0),
      bend_(sheet.bends.size(), Move::Zero()) {}

void SkinSolver::reset() {
    std::fill(u_.begin(), u_.end(), Move::Zero());
    std::fill(stretch_.begin(), stretch_.end(), 0.0f);
    std::fill(bend_.begin(), bend_.end(), Move::Zero());
}

void SkinSolver::scale(float factor) {
    for (float& m : stretch_) m *= factor;
    for (Move& m : bend_) m *= factor;
}

float SkinSolver::solve(std::span<const Move> reference, std::vector<SheetPlane>& planes, int sweeps,
                        float tolerance) {
    prepare(planes);
    warmStart(reference, planes);
    keep(planes);
    double lowest = dual(reference, planes);
    float t = 3, change = 0;
    for (int i = 0; i < sweeps; ++i) {
        sweep(planes);
        change = 0;
        for (std::size_t v = 0; v < u_.size(); ++v)
            change = std::max(change, (u_[v] - uBefore_[v]).cwiseAbs().maxCoeff());
        if (change <= tolerance) break;
        const double now = dual(reference, planes);
        if (now > lowest && i > 0 && t > 1) {
            takeBack(planes);
            t = 1;
            continue;
        }
        lowest = now;
        if (i + 1 == sweeps) break;
        const float next = (1 + std::sqrt(1 + 4 * t * t)) / 2;
        accelerate((t - 1) / next, planes);
        t = next;
    }
    return change;
}

void SkinSolver::prepare(std::vector<SheetPlane>& planes) const {
    for (SheetPlane& p : planes) {
        float mass = 0;
        for (int k = 0; k < 3; ++k) mass += sheet_.inverseMass[p.vertex[k]] * p.weight[k] * p.weight[k];
        mass *= p.normal.squaredNorm();
        p.compliance = contactFloor * mass;
        p.inverse = mass > 0 ? 1 / (mass + p.compliance) : 0;
        if (!p.used()) p.multiplier = 0;
    }
}

void SkinSolver::warmStart(std::span<const Move> reference, const std::vector<SheetPlane>& planes) {
    std::fill(u_.begin(), u_.end(), Move::Zero());
    for (std::size_t e = 0; e < stretch_.size(); ++e) {
        const SheetEdge& edge = sheet_.edges[e];
        u_[edge.i] += stretch_[e] * edge.direction;
        u_[edge.j] -= stretch_[e] * edge.direction;
    }
    for (std::size_t b = 0; b < bend_.size(); ++b) {
        const SheetBend& bend = sheet_.bends[b];
        u_[bend.centre] += bend_[b];
        for (std::uint32_t k = bend.first; k < bend.last; ++k)
            u_[sheet_.ring[k]] -= sheet_.ringShare[k] * bend_[b];
    }
    for (const SheetPlane& p : planes)
        if (p.multiplier > 0)
            for (int k = 0; k < 3; ++k) u_[p.vertex[k]] += p.multiplier * p.weight[k] * p.normal;
    for (std::size_t v = 0; v < u_.size(); ++v) u_[v] = reference[v] + sheet_.inverseMass[v] * u_[v];
}

inline void SkinSolver::stretch(std::size_t e) {
    const SheetEdge& edge = sheet_.edges[e];
    Move &ui = u_[edge.i], &uj = u_[edge.j];
    const float c = edge.direction.dot(ui - uj);
    const float step = -(c + edge.compliance * stretch_[e]) * edge.inverse;
    stretch_[e] += step;
    ui += (edge.massI * step) * edge.direction;
    uj -= (edge.massJ * step) * edge.direction;
}

inline void SkinSolver::bend(std::size_t b) {
    const SheetBend& bend = sheet_.bends[b];
    Move mean = Move::Zero();
    for (std::uint32_t k = bend.first; k < bend.last; ++k) mean += sheet_.ringShare[k] * u_[sheet_.ring[k]];
    const Move c = u_[bend.centre] - mean;
    const Move step = -bend.inverse * (c + bend.compliance * bend_[b]);
    bend_[b] += step;
    u_[bend.centre] += bend.mass * step;
    for (std::uint32_t k = bend.first; k < bend.last; ++k) u_[sheet_.ring[k]] -= sheet_.ringMass[k] * step;
}

inline void SkinSolver::push(SheetPlane& p) {
    if (!p.used()) return;
    float c = -p.bound;
    for (int k = 0; k < 3; ++k) c += p.weight[k] * p.normal.dot(u_[p.vertex[k]]);
    const float next = std::max(0.0f, p.multiplier - (c + p.compliance * p.multiplier) * p.inverse);
    const float step = next - p.multiplier;
    p.multiplier = next;
    if (step == 0) return;
    for (int k = 0; k < 3; ++k)
        u_[p.vertex[k]] += (sheet_.inverseMass[p.vertex[k]] * step * p.weight[k]) * p.normal;
}

void SkinSolver::sweep(std::vector<SheetPlane>& planes) {
    // To and fro: only then is a sweep a step in one fixed metric, which momentum needs.
    for (std::size_t e = 0; e < stretch_.size(); ++e) stretch(e);
    for (std::size_t b = 0; b < bend_.size(); ++b) bend(b);
    for (SheetPlane& p : planes) push(p);
    for (std::size_t p = planes.size(); p-- > 0;) push(planes[p]);
    for (std::size_t b = bend_.size(); b-- > 0;) bend(b);
    for (std::size_t e = stretch_.size(); e-- > 0;) stretch(e);
}

/// 1/2 |W^1/2 J^T m|^2 + m . J reference + 1/2 compliance m^2 - bound . m, with W J^T m = u - reference.
double SkinSolver::dual(std::span<const Move> reference, const std::vector<SheetPlane>& planes) const {
    double sum = 0;
    for (std::size_t v = 0; v < u_.size(); ++v) {
        if (!(sheet_.inverseMass[v] > 0)) continue;
        const Move moved = u_[v] - reference[v];
        sum += moved.dot(0.5f * moved + reference[v]) / sheet_.inverseMass[v];
    }
    for (std::size_t e = 0; e < stretch_.size(); ++e)
        sum += 0.5f * (sheet_.edges[e].compliance * stretch_[e]) * stretch_[e];
    for (std::size_t b = 0; b < bend_.size(); ++b)
        sum += 0.5f * (sheet_.bends[b].compliance * bend_[b]).dot(bend_[b]);
    for (const SheetPlane& p : planes) sum += (0.5f * p.compliance * p.multiplier - p.bound) * p.multiplier;
    return sum;
}

void SkinSolver::keep(const std::vector<SheetPlane>& planes) {
    uBefore_ = u_;
    stretchBefore_ = stretch_;
    bendBefore_ = bend_;
    planeBefore_.resize(planes.size());
    for (std::size_t p = 0; p < planes.size(); ++p) planeBefore_[p] = planes[p].multiplier;
}

void SkinSolver::takeBack(std::vector<SheetPlane>& planes) {
    u_ = uBefore_;
    stretch_ = stretchBefore_;
    bend_ = bendBefore_;
    for (std::size_t p = 0; p < planes.size(); ++p) planes[p].multiplier = planeBefore_[p];
}

/// Moves on along the last change. The displacements are affine in the multipliers, so they move alike; a
/// multiplier that gets below 0 is put right by the next sweep.
void SkinSolver::accelerate(float momentum, std::vector<SheetPlane>& planes) {
    const auto extrapolate = [&](auto& now, auto& before) {
        const auto last = now;
        now += momentum * (now - before);
        before = last;
    };
    for (std::size_t v = 0; v < u_.size(); ++v) extrapolate(u_[v], uBefore_[v]);
    for (std::size_t e = 0; e < stretch_.size(); ++e) extrapolate(stretch_[e], stretchBefore_[e]);
    for (std::size_t b = 0; b < bend_.size(); ++b) extrapolate(bend_[b], bendBefore_[b]);
    for (std::size_t p = 0; p < planes.size(); ++p) extrapolate(planes[p].multiplier, planeBefore_[p]);
}

} // namespace tss
