#include "bake/respond/SkinSolver.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Compliance of a contact as a share of its inverse mass. Contacts hardly fight each other, so far less than
/// the sheet's floor keeps their multipliers from creeping, and the skin stays nearer to the surface.
constexpr float contactFloor = 0.01f;

} // namespace

SkinSolver::SkinSolver(const PackedSheet& sheet, KernelTarget target)
    : sheet_(sheet), kernels_(sheetKernels(target)), state_(sheet), before_(sheet),
      pushed_(sheet.vertexCount(), 0) {}

void SkinSolver::reset() {
    state_ = SheetState(sheet_);
}

void SkinSolver::scale(float factor) {
    for (float& m : state_.stretch) m *= factor;
    for (float& m : state_.bend) m *= factor;
    for (Move& m : state_.rim) m *= factor;
}

float SkinSolver::solve(std::span<const Move> reference, std::vector<SheetPlane>& planes, int sweeps,
                        float tolerance) {
    prepare(planes);
    kernels_.displace(sheet_, reference.data(), state_);
    for (const std::uint32_t i : used_) {
        const SheetPlane& p = planes[i];
        for (int k = 0; k < p.vertices && p.multiplier > 0; ++k) {
            Move& u = state_.u[p.vertex[k]];
            u += (u[3] * p.multiplier * p.weight[k]) * p.normal;
        }
    }
    keep(planes);
    energy_ = kernels_.strainEnergy(sheet_, state_);
    // 1/2 |W^1/2 J^T m|^2 + m . J reference + 1/2 compliance m^2 - bound . m, with W J^T m = u - reference.
    const auto measure = [&] {
        SheetMeasure measured = kernels_.measure(sheet_, reference.data(), before_.u.data(), state_.u.data());
        measured.dual += energy_ + planeEnergy(planes);
        return measured;
    };
    double lowest = measure().dual;
    float t = 3, change = 0;
    for (int i = 0; i < sweeps; ++i) {
        sweep(planes);
        const SheetMeasure now = measure();
        change = now.change;
        if (change <= tolerance) break;
        if (now.dual > lowest && i > 0 && t > 1) {
            takeBack(planes);
            t = 1;
            continue;
        }
        lowest = now.dual;
        if (i + 1 == sweeps) break;
        const float next = (1 + std::sqrt(1 + 4 * t * t)) / 2;
        accelerate((t - 1) / next, planes);
        t = next;
    }
    return change;
}

void SkinSolver::prepare(std::vector<SheetPlane>& planes) {
    used_.clear();
    for (std::uint32_t i = 0; i < planes.size(); ++i) {
        SheetPlane& p = planes[i];
        float mass = 0;
        for (int k = 0; k < p.vertices; ++k)
            mass += sheet_.inverseMass[p.vertex[k]] * p.weight[k] * p.weight[k];
        mass *= p.normal.squaredNorm();
        p.compliance = contactFloor * mass;
        p.inverse = mass > 0 ? 1 / (mass + p.compliance) : 0;
        if (p.used())
            used_.push_back(i);
        else
            p.multiplier = 0;
    }
}

inline void SkinSolver::push(SheetPlane& p) {
    float c = p.weight[0] * p.normal.dot(state_.u[p.vertex[0]]) - p.bound;
    for (int k = 1; k < p.vertices; ++k) c += p.weight[k] * p.normal.dot(state_.u[p.vertex[k]]);
    if (c >= 0 && p.multiplier == 0) return; // most of them
    const float next = std::max(0.0f, p.multiplier - (c + p.compliance * p.multiplier) * p.inverse);
    const float step = next - p.multiplier;
    p.multiplier = next;
    if (step == 0) return;
    for (int k = 0; k < p.vertices; ++k) {
        Move& u = state_.u[p.vertex[k]];
        u += (u[3] * step * p.weight[k]) * p.normal;
        pushed_[p.vertex[k]] = sweep_;
    }
}

/// Whether a second push may find anything to do: the plane pushed, or another did where it is.
inline bool SkinSolver::stirred(const SheetPlane& p) const {
    bool result = p.multiplier != 0;
    for (int k = 0; k < p.vertices && !result; ++k) result = pushed_[p.vertex[k]] == sweep_;
    return result;
}

void SkinSolver::sweep(std::vector<SheetPlane>& planes) {
    // To and fro: only then is a sweep a step in one fixed metric, which momentum needs.
    ++sweep_;
    kernels_.sweepTo(sheet_, state_);
    for (const std::uint32_t i : used_) push(planes[i]);
    for (std::size_t i = used_.size(); i-- > 0;)
        if (SheetPlane& p = planes[used_[i]]; stirred(p)) push(p);
    energy_ = kernels_.sweepFro(sheet_, state_);
}

double SkinSolver::planeEnergy(const std::vector<SheetPlane>& planes) const {
    double sum = 0;
    for (const std::uint32_t i : used_) {
        const SheetPlane& p = planes[i];
        if (p.multiplier == 0) continue;
        sum += static_cast<double>((0.5f * p.compliance * p.multiplier - p.bound) * p.multiplier);
    }
    return sum;
}

void SkinSolver::keep(const std::vector<SheetPlane>& planes) {
    before_ = state_;
    planeBefore_.clear();
    for (const std::uint32_t i : used_) planeBefore_.push_back(planes[i].multiplier);
}

void SkinSolver::takeBack(std::vector<SheetPlane>& planes) {
    state_ = before_;
    for (std::size_t k = 0; k < used_.size(); ++k) planes[used_[k]].multiplier = planeBefore_[k];
}

/// Moves on along the last change. The displacements are affine in the multipliers, so they move alike; a
/// multiplier that gets below 0 is put right by the next sweep.
void SkinSolver::accelerate(float momentum, std::vector<SheetPlane>& planes) {
    const auto extrapolate = [&](std::vector<Move>& now, std::vector<Move>& before) {
        kernels_.extrapolate(momentum, now.data()->data(), before.data()->data(), 4 * now.size());
    };
    extrapolate(state_.u, before_.u);
    if (!state_.rim.empty()) extrapolate(state_.rim, before_.rim);
    kernels_.extrapolate(momentum, state_.stretch.data(), before_.stretch.data(), state_.stretch.size());
    kernels_.extrapolate(momentum, state_.bend.data(), before_.bend.data(), state_.bend.size());
    for (std::size_t k = 0; k < used_.size(); ++k) {
        float& now = planes[used_[k]].multiplier;
        const float last = now;
        now += momentum * (now - planeBefore_[k]);
        planeBefore_[k] = last;
    }
}

} // namespace tss
