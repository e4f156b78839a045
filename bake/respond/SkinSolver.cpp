#include "bake/respond/SkinSolver.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Compliance of a contact as a share of its inverse mass. Contacts hardly fight each other, so far less than
/// the sheet's floor keeps their multipliers from creeping, and the skin stays nearer to the surface.
constexpr float contactFloor = 0.01f;

/// After so many times of going on from the displacements of before, these are found anew from the
/// multipliers: what rounding adds each time would grow.
constexpr std::uint32_t followsAtMost = 256;

constexpr int lookAround = 3;     ///< sweeps from one look for planes that have come near to the next
constexpr float nearCalms = 4.0f; ///< how near that is, in the least change that is followed

} // namespace

SkinSolver::SkinSolver(const PackedSheet& sheet, KernelTarget target)
    : sheet_(sheet), kernels_(sheetKernels(target)), state_(sheet), before_(sheet),
      pushed_(sheet.vertexCount(), 0), isRestless_(sheet.blocks.size(), 1), isSwept_(sheet.blocks.size(), 0),
      beside_(sheet.vertexCount(), 0), reference_(sheet.vertexCount(), Move::Zero()),
      balanced_(state_.u.begin(), state_.u.end() - 1) {}

void SkinSolver::reset() {
    state_.reset(sheet_);
    before_.reset(sheet_);
    std::fill(reference_.begin(), reference_.end(), Move::Zero());
    balanced_.assign(state_.u.begin(), state_.u.end() - 1);
    std::fill(isRestless_.begin(), isRestless_.end(), 1);
    old_.clear();
    follows_ = 0; // or rounding would depend on how long ago it began
}

void SkinSolver::scale(float factor) {
    for (float& m : state_.stretch) m *= factor;
    for (float& m : state_.bend) m *= factor;
    for (Move& m : state_.rim) m *= factor;
}

float SkinSolver::solve(std::span<const Move> reference, std::vector<SheetPlane>& planes, int sweeps,
                        float tolerance) {
    ++solve_;
    prepare(planes);
    reference_.assign(reference.begin(), reference.end());
    displace();
    pushBy(planes);
    std::fill(isRestless_.begin(), isRestless_.end(), 1);
    chooseBlocks();
    taken_ = used_;
    far_.clear();
    chooseRuns();
    const float change = balance(planes, sweeps, tolerance, 0);
    // It may be as far from balanced as can be: the next one looks at everything.
    std::fill(isRestless_.begin(), isRestless_.end(), 1);
    return change;
}

float SkinSolver::follow(std::vector<SheetPlane>& planes, int sweeps, float tolerance, float calm) {
    ++solve_;
    prepare(planes);
    if (++follows_ % followsAtMost == 0)
        displace();
    else
        pushNoMore();
    pushBy(planes);
    findRestless(planes, calm);
    chooseBlocks();
    choosePlanes(planes, calm);
    chooseRuns();
    const float change = balance(planes, sweeps, tolerance, calm);
    std::fill(isRestless_.begin(), isRestless_.end(), 0);
    for (const SheetRun& run : runs_)
        for (std::uint32_t v = run.first; v < run.last; ++v)
            if (movedOn(v, calm)) wake(v);
    return change;
}

/// As the multipliers of the sheet say, without planes.
void SkinSolver::displace() {
    kernels_.displace(sheet_, reference_.data(), state_);
    follows_ = 0;
}

void SkinSolver::pushBy(const std::vector<SheetPlane>& planes) {
    for (const std::uint32_t i : used_) {
        const SheetPlane& p = planes[i];
        for (int k = 0; k < p.vertices && p.multiplier > 0; ++k) {
            Move& u = state_.u[p.vertex[k]];
            u += (u[3] * p.multiplier * p.weight[k]) * p.normal;
        }
    }
}

/// Takes back what the planes of the last solve had pushed, as they were then.
void SkinSolver::pushNoMore() {
    for (const Push& p : old_) state_.u[p.vertex] -= p.move;
}

void SkinSolver::noteOld(const std::vector<SheetPlane>& planes) {
    old_.clear();
    for (const std::uint32_t i : used_) {
        const SheetPlane& p = planes[i];
        for (int k = 0; k < p.vertices && p.multiplier > 0; ++k) {
            const std::uint32_t v = p.vertex[k];
            old_.push_back({v, (state_.u[v][3] * p.multiplier * p.weight[k]) * p.normal});
        }
    }
}

bool SkinSolver::movedOn(std::uint32_t v, float calm) const {
    return (state_.u[v] - balanced_[v]).squaredNorm() > calm * calm; // the fourth lanes are the same
}

/// Marks all that bears on a vertex.
void SkinSolver::wake(std::uint32_t v) {
    for (const std::uint32_t block : sheet_.owners[v]) isRestless_[block] = 1;
}

/// Beside what the last solve has left restless: where planes no longer push as they did, or are about to.
void SkinSolver::findRestless(const std::vector<SheetPlane>& planes, float calm) {
    for (const Push& p : old_)
        if (movedOn(p.vertex, calm)) wake(p.vertex);
    slack_.resize(used_.size());
    for (std::size_t i = 0; i < used_.size(); ++i) {
        const SheetPlane& p = planes[used_[i]];
        const float c = slack_[i] = slack(p);
        if (c >= 0 && p.multiplier == 0) continue;
        const float step = std::max(-p.multiplier, -(c + p.compliance * p.multiplier) * p.inverse);
        for (int k = 0; k < p.vertices; ++k) {
            const std::uint32_t v = p.vertex[k];
            if (sheet_.inverseMass[v] * std::abs(step * p.weight[k]) > calm || movedOn(v, calm)) wake(v);
        }
    }
}

void SkinSolver::chooseBlocks() {
    isSwept_ = isRestless_;
    swept_.clear();
    besideList_.clear();
    for (std::uint32_t b = 0; b < isSwept_.size(); ++b)
        if (isSwept_[b]) swept_.push_back(b);
    const auto isSwept = [&](std::uint32_t block) { return isSwept_[block] != 0; };
    for (const std::uint32_t b : swept_) {
        for (std::uint32_t v = sheet_.blockStart(b).vertices; v < sheet_.blocks[b].vertices; ++v)
            if (std::ranges::all_of(sheet_.owners[v], isSwept)) balanced_[v] = state_.u[v];
        for (const std::uint32_t v : sheet_.halo[b])
            if (!moves(v)) {
                beside_[v] = solve_;
                besideList_.push_back(v);
            }
    }
}

/// Those that push or may come to push, and what they move.
void SkinSolver::choosePlanes(const std::vector<SheetPlane>& planes, float calm) {
    taken_.clear();
    far_.clear();
    planeBefore_.clear();
    const std::size_t sheetOnly = besideList_.size();
    for (std::size_t i = 0; i < used_.size(); ++i) {
        const SheetPlane& p = planes[used_[i]];
        bool may = p.multiplier > 0 || slack_[i] < 0;
        for (int k = 0; k < p.vertices; ++k) may = may || moves(p.vertex[k]);
        if (!may) continue;
        far_.push_back(used_[i]);
        for (int k = 0; k < p.vertices; ++k)
            if (!moves(p.vertex[k])) besideList_.push_back(p.vertex[k]);
    }
    for (std::size_t k = sheetOnly; k < besideList_.size(); ++k) beside_[besideList_[k]] = solve_;
    takeNear(planes, calm);
}

/// Of the planes that may come to push, those that are near enough to do so soon.
void SkinSolver::takeNear(const std::vector<SheetPlane>& planes, float calm) {
    std::erase_if(far_, [&](std::uint32_t i) {
        const SheetPlane& p = planes[i];
        if (p.multiplier == 0 && slack(p) > nearCalms * calm) return false;
        taken_.push_back(i);
        planeBefore_.push_back(p.multiplier);
        return true;
    });
}

void SkinSolver::chooseRuns() {
    runs_.clear();
    for (const std::uint32_t b : swept_) {
        const std::uint32_t first = sheet_.blockStart(b).vertices, last = sheet_.blocks[b].vertices;
        if (!runs_.empty() && runs_.back().last == first)
            runs_.back().last = last;
        else
            runs_.push_back({first, last});
    }
    std::sort(besideList_.begin(), besideList_.end());
    besideList_.erase(std::unique(besideList_.begin(), besideList_.end()), besideList_.end());
    for (const std::uint32_t v : besideList_) {
        if (!runs_.empty() && runs_.back().last == v)
            ++runs_.back().last;
        else
            runs_.push_back({v, v + 1});
    }
}

float SkinSolver::balance(std::vector<SheetPlane>& planes, int sweeps, float tolerance, float calm) {
    keep(planes);
    // 1/2 |W^1/2 J^T m|^2 + m . J reference + 1/2 compliance m^2 - bound . m, with W J^T m = u - reference:
    // of the first two only the difference to the step before is looked at.
    double energy = kernels_.strainEnergy(sheet_, swept_, state_) + planeEnergy(planes);
    float t = 3, change = 0;
    for (int i = 0; i < sweeps; ++i) {
        if (i % lookAround == lookAround - 1) takeNear(planes, calm);
        const double now = sweep(planes);
        const SheetMeasure measured = kernels_.measure(sheet_, runs_, before_.u.data(), state_.u.data());
        change = measured.change;
        if (change <= tolerance) break;
        if (now - energy + measured.dual > 0 && i > 0 && t > 1) {
            takeBack(planes);
            t = 1;
            continue;
        }
        energy = now;
        if (i + 1 == sweeps) break;
        const float next = (1 + std::sqrt(1 + 4 * t * t)) / 2;
        accelerate((t - 1) / next, planes);
        t = next;
    }
    keep(planes);
    noteOld(planes);
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
    const float c = slack(p);
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

/// Returns the energy of what it swept.
double SkinSolver::sweep(std::vector<SheetPlane>& planes) {
    // To and fro: only then is a sweep a step in one fixed metric, which momentum needs.
    ++sweep_;
    kernels_.sweepTo(sheet_, swept_, state_);
    for (const std::uint32_t i : taken_) push(planes[i]);
    for (std::size_t i = taken_.size(); i-- > 0;)
        if (SheetPlane& p = planes[taken_[i]]; stirred(p)) push(p);
    return kernels_.sweepFro(sheet_, swept_, state_) + planeEnergy(planes);
}

double SkinSolver::planeEnergy(const std::vector<SheetPlane>& planes) const {
    double sum = 0;
    for (const std::uint32_t i : taken_) {
        const SheetPlane& p = planes[i];
        if (p.multiplier == 0) continue;
        sum += static_cast<double>((0.5f * p.compliance * p.multiplier - p.bound) * p.multiplier);
    }
    return sum;
}

/// Visits what this solve may change, as lists of `count` floats of two states.
template <class Visit>
void SkinSolver::visitMoving(SheetState& now, SheetState& before, const Visit& visit) const {
    for (const SheetRun& run : runs_)
        visit(now.u[run.first].data(), before.u[run.first].data(), 4 * (run.last - run.first));
    for (const std::uint32_t b : swept_) {
        const SheetBlock from = sheet_.blockStart(b), &to = sheet_.blocks[b];
        visit(now.stretch.data() + 8 * from.edges, before.stretch.data() + 8 * from.edges,
              8 * (to.edges - from.edges));
        visit(now.bend.data() + 8 * from.bends, before.bend.data() + 8 * from.bends,
              8 * (to.bends - from.bends));
        if (to.rims > from.rims)
            visit(now.rim[from.rims].data(), before.rim[from.rims].data(), 4 * (to.rims - from.rims));
    }
}

void SkinSolver::keep(const std::vector<SheetPlane>& planes) {
    visitMoving(state_, before_,
                [](const float* now, float* before, std::size_t count) { std::copy_n(now, count, before); });
    planeBefore_.clear();
    for (const std::uint32_t i : taken_) planeBefore_.push_back(planes[i].multiplier);
}

void SkinSolver::takeBack(std::vector<SheetPlane>& planes) {
    visitMoving(state_, before_,
                [](float* now, const float* before, std::size_t count) { std::copy_n(before, count, now); });
    for (std::size_t k = 0; k < taken_.size(); ++k) planes[taken_[k]].multiplier = planeBefore_[k];
}

/// Moves on along the last change. The displacements are affine in the multipliers, so they move alike; a
/// multiplier that gets below 0 is put right by the next sweep.
void SkinSolver::accelerate(float momentum, std::vector<SheetPlane>& planes) {
    visitMoving(state_, before_, [&](float* now, float* before, std::size_t count) {
        kernels_.extrapolate(momentum, now, before, count);
    });
    for (std::size_t k = 0; k < taken_.size(); ++k) {
        float& now = planes[taken_[k]].multiplier;
        const float last = now;
        now += momentum * (now - planeBefore_[k]);
        planeBefore_[k] = last;
    }
}

} // namespace tss
