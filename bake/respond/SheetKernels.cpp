#include "bake/table/VectorTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/respond/SheetKernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/respond/SheetKernels.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

// One vertex in 128 bits, two side by side where vectors are wider. Wider still is not worth it: each vertex
// is a load of its own.
#undef TSS_SHEET_PAIRS
#if HWY_TARGET == HWY_SCALAR
#define TSS_SHEET_PAIRS 0
using V = Eigen::Array4f;
constexpr std::size_t lanes = 4;

HWY_INLINE V load(const float* from) {
    return V::Map(from);
}
HWY_INLINE void store(const V& value, float* to) {
    V::Map(to) = value;
}
HWY_INLINE V all(float x) {
    return V::Constant(x);
}
HWY_INLINE V mulAdd(const V& a, const V& b, const V& c) {
    return a * b + c;
}
HWY_INLINE V negMulAdd(const V& a, const V& b, const V& c) {
    return c - a * b;
}
HWY_INLINE V larger(const V& a, const V& b) {
    return a.max(b);
}
template <int k>
HWY_INLINE V broadcast(const V& value) {
    return V::Constant(value[k]);
}
/// Sum of the lanes of each of four vertices, a lane each.
HWY_INLINE V sums(const V& a, const V& b, const V& c, const V& d) {
    return {a.sum(), b.sum(), c.sum(), d.sum()};
}
#else
namespace hn = hwy::HWY_NAMESPACE;
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3
#define TSS_SHEET_PAIRS 1
constexpr std::size_t lanes = 8;
#else
#define TSS_SHEET_PAIRS 0
constexpr std::size_t lanes = 4;
#endif
using One = hn::FixedTag<float, 4>;
using Floats = hn::FixedTag<float, lanes>;
using V = hn::Vec<Floats>;

HWY_INLINE V load(const float* from) {
    return hn::LoadU(Floats(), from);
}
HWY_INLINE void store(V value, float* to) {
    hn::StoreU(value, Floats(), to);
}
HWY_INLINE V all(float x) {
    return hn::Set(Floats(), x);
}
HWY_INLINE V mulAdd(V a, V b, V c) {
    return hn::MulAdd(a, b, c);
}
HWY_INLINE V negMulAdd(V a, V b, V c) {
    return hn::NegMulAdd(a, b, c);
}
HWY_INLINE V larger(V a, V b) {
    return hn::Max(a, b);
}
/// Of each half its own lane.
template <int k>
HWY_INLINE V broadcast(V value) {
    return hn::Broadcast<k>(value);
}
HWY_INLINE V sums(V a, V b, V c, V d) {
    const Floats f;
    const hn::Repartition<double, Floats> pairs;
    const V ab = hn::Add(hn::InterleaveLower(f, a, b), hn::InterleaveUpper(f, a, b));
    const V cd = hn::Add(hn::InterleaveLower(f, c, d), hn::InterleaveUpper(f, c, d));
    const auto x = hn::BitCast(pairs, ab), y = hn::BitCast(pairs, cd);
    return hn::Add(hn::BitCast(f, hn::InterleaveLower(pairs, x, y)),
                   hn::BitCast(f, hn::InterleaveUpper(pairs, x, y)));
}
#endif

/// One vertex, or beside it the one `stride` later in the list.
HWY_INLINE V gather(const float* u, const std::uint32_t* list, std::size_t stride) {
#if TSS_SHEET_PAIRS
    return hn::Combine(Floats(), hn::Load(One(), u + list[stride]), hn::Load(One(), u + list[0]));
#else
    (void)stride;
    return load(u + list[0]);
#endif
}
/// Of one vertex, or of it and the next.
HWY_INLINE V masses(const float* mass) {
#if TSS_SHEET_PAIRS
    return hn::Combine(Floats(), hn::Set(One(), mass[1]), hn::Set(One(), mass[0]));
#else
    return all(mass[0]);
#endif
}
/// One vertex, and nothing beside it.
HWY_INLINE V one(const float* u) {
#if TSS_SHEET_PAIRS
    return hn::ZeroExtendVector(Floats(), hn::Load(One(), u));
#else
    return load(u);
#endif
}
HWY_INLINE void scatter(const V& value, float* u, const std::uint32_t* list, std::size_t stride) {
#if TSS_SHEET_PAIRS
    hn::Store(hn::LowerHalf(One(), value), One(), u + list[0]);
    hn::Store(hn::UpperHalf(One(), value), One(), u + list[stride]);
#else
    (void)stride;
    store(value, u + list[0]);
#endif
}

double sum(const V& values) {
    alignas(32) float list[lanes];
    store(values, list);
    double result = 0;
    for (const float x : list) result += static_cast<double>(x);
    return result;
}

/// The lanes of four edges, or of four in each half.
struct Edges {
    V ui[4], uj[4], direction[4];
};

template <int k>
HWY_INLINE V read(const EdgePack& pack, std::size_t lane, const float* u, Edges& e) {
    e.ui[k] = gather(u, pack.i + lane + k, 4);
    e.uj[k] = gather(u, pack.j + lane + k, 4);
    e.direction[k] = load(pack.direction[2 * k + lane / 4]);
    return e.direction[k] * (e.ui[k] - e.uj[k]);
}

template <int k>
HWY_INLINE void move(const EdgePack& pack, std::size_t lane, const V& step, float* u, const Edges& e) {
    const V along = broadcast<k>(step) * e.direction[k];
    scatter(mulAdd(broadcast<3>(e.ui[k]), along, e.ui[k]), u, pack.i + lane + k, 4);
    scatter(negMulAdd(broadcast<3>(e.uj[k]), along, e.uj[k]), u, pack.j + lane + k, 4);
}

/// Returns compliance m^2 of each edge.
HWY_INLINE V stretch(const EdgePack& pack, std::size_t lane, float* multipliers, float* u) {
    Edges e;
    const V a = read<0>(pack, lane, u, e), b = read<1>(pack, lane, u, e), c = read<2>(pack, lane, u, e),
            d = read<3>(pack, lane, u, e);
    const V m = load(multipliers + lane), compliance = load(pack.compliance + lane);
    const V step = negMulAdd(mulAdd(compliance, m, sums(a, b, c, d)), load(pack.inverse + lane), all(0));
    const V now = m + step;
    store(now, multipliers + lane);
    move<0>(pack, lane, step, u, e);
    move<1>(pack, lane, step, u, e);
    move<2>(pack, lane, step, u, e);
    move<3>(pack, lane, step, u, e);
    return compliance * now * now;
}

/// The same of a bend, or of two. `size`: of their rings, or 0: as the pack says, read twice in place of kept
/// in registers.
template <std::size_t size>
HWY_INLINE V bend(const PackedSheet& sheet, const BendPack& pack, std::size_t lane, float* multipliers,
                  float* u) {
    const std::uint32_t* ring = sheet.ring.data() + pack.first + lane / 4;
    const std::uint32_t* end = ring + 2 * pack.size;
    V kept[size + 1], sum = all(0);
    if constexpr (size > 0)
        for (std::size_t k = 0; k < size; ++k) sum = sum + (kept[k] = gather(u, ring + 2 * k, 1));
    else
        for (const std::uint32_t* v = ring; v != end; v += 2) sum = sum + gather(u, v, 1);
    const std::uint32_t* centre = pack.centre + lane / 4;
    const V share = all(1.0f / static_cast<float>(pack.size)), at = gather(u, centre, 1);
    const V m = load(multipliers + lane), compliance = load(pack.compliance + lane);
    // The fourth lane of `inverse` is 0, whatever the inverse masses came to.
    const V step =
        negMulAdd(mulAdd(compliance, m, negMulAdd(share, sum, at)), load(pack.inverse + lane), all(0));
    const V now = m + step;
    store(now, multipliers + lane);
    scatter(mulAdd(broadcast<3>(at), step, at), u, centre, 1);
    const V back = share * step;
    const auto move = [&](const V& x, const std::uint32_t* v) {
        scatter(negMulAdd(broadcast<3>(x), back, x), u, v, 1);
    };
    if constexpr (size > 0)
        for (std::size_t k = 0; k < size; ++k) move(kept[k], ring + 2 * k);
    else
        for (const std::uint32_t* v = ring; v != end; v += 2) move(gather(u, v, 1), v);
    return compliance * now * now;
}

HWY_INLINE V bend(const PackedSheet& sheet, const BendPack& pack, std::size_t lane, float* multipliers,
                  float* u) {
    switch (pack.size) {
    case 4:
        return bend<4>(sheet, pack, lane, multipliers, u);
    case 5:
        return bend<5>(sheet, pack, lane, multipliers, u);
    case 6:
        return bend<6>(sheet, pack, lane, multipliers, u);
    case 7:
        return bend<7>(sheet, pack, lane, multipliers, u);
    case 8:
        return bend<8>(sheet, pack, lane, multipliers, u);
    default:
        return bend<0>(sheet, pack, lane, multipliers, u);
    }
}

HWY_INLINE double bendRim(const RimBend& bend, Move& multiplier, Move* u) {
    Move &centre = u[bend.centre], &a = u[bend.neighbour[0]], &b = u[bend.neighbour[1]];
    Move step =
        -bend.inverse * (centre - bend.share[0] * a - bend.share[1] * b + bend.compliance * multiplier);
    step[3] = 0;
    multiplier += step;
    centre += centre[3] * step;
    a -= (a[3] * bend.share[0]) * step;
    b -= (b[3] * bend.share[1]) * step;
    return static_cast<double>(bend.compliance * multiplier.squaredNorm());
}

void displace(const PackedSheet& sheet, const Move* reference, SheetState& s) {
    std::fill(s.u.begin(), s.u.end(), Move::Zero());
    float* u = s.u.data()->data();
    for (std::size_t p = 0; p < sheet.edges.size(); ++p)
        for (std::size_t lane = 0; lane < 8; lane += lanes) {
            const EdgePack& pack = sheet.edges[p];
            const V m = load(&s.stretch[8 * p + lane]);
            const auto add = [&](const V& along, std::size_t k) {
                scatter(gather(u, pack.i + lane + k, 4) + along, u, pack.i + lane + k, 4);
                scatter(gather(u, pack.j + lane + k, 4) - along, u, pack.j + lane + k, 4);
            };
            add(broadcast<0>(m) * load(pack.direction[lane / 4]), 0);
            add(broadcast<1>(m) * load(pack.direction[2 + lane / 4]), 1);
            add(broadcast<2>(m) * load(pack.direction[4 + lane / 4]), 2);
            add(broadcast<3>(m) * load(pack.direction[6 + lane / 4]), 3);
        }
    for (std::size_t p = 0; p < sheet.bends.size(); ++p)
        for (std::size_t lane = 0; lane < 8; lane += lanes) {
            const BendPack& pack = sheet.bends[p];
            const V m = load(&s.bend[8 * p + lane]);
            const std::uint32_t* centre = pack.centre + lane / 4;
            scatter(gather(u, centre, 1) + m, u, centre, 1);
            const V back = all(1.0f / static_cast<float>(pack.size)) * m;
            const std::uint32_t* ring = sheet.ring.data() + pack.first + lane / 4;
            for (const std::uint32_t* v = ring; v != ring + 2 * pack.size; v += 2)
                scatter(gather(u, v, 1) - back, u, v, 1);
        }
    for (std::size_t r = 0; r < sheet.rims.size(); ++r) {
        const RimBend& bend = sheet.rims[r];
        s.u[bend.centre] += s.rim[r];
        for (int k = 0; k < 2; ++k) s.u[bend.neighbour[k]] -= bend.share[k] * s.rim[r];
    }
    for (std::size_t v = 0; v < sheet.vertexCount(); ++v) {
        const float w = sheet.inverseMass[v];
        s.u[v] = reference[v] + w * s.u[v];
        s.u[v][3] = w;
    }
}

void sweepTo(const PackedSheet& sheet, SheetKernels::Blocks blocks, SheetState& s) {
    float* u = s.u.data()->data();
    for (const std::uint32_t b : blocks) {
        const SheetBlock from = sheet.blockStart(b), &to = sheet.blocks[b];
        for (std::size_t p = from.edges; p < to.edges; ++p)
            for (std::size_t lane = 0; lane < 8; lane += lanes)
                stretch(sheet.edges[p], lane, &s.stretch[8 * p], u);
        for (std::size_t p = from.bends; p < to.bends; ++p)
            for (std::size_t lane = 0; lane < 8; lane += lanes)
                bend(sheet, sheet.bends[p], lane, &s.bend[8 * p], u);
        for (std::size_t r = from.rims; r < to.rims; ++r) bendRim(sheet.rims[r], s.rim[r], s.u.data());
    }
}

double sweepFro(const PackedSheet& sheet, SheetKernels::Blocks blocks, SheetState& s) {
    float* u = s.u.data()->data();
    double energy = 0;
    for (std::size_t k = blocks.size(); k-- > 0;) {
        const SheetBlock from = sheet.blockStart(blocks[k]), &to = sheet.blocks[blocks[k]];
        for (std::size_t r = to.rims; r-- > from.rims;)
            energy += bendRim(sheet.rims[r], s.rim[r], s.u.data());
        V energies = all(0); // of a block in floats
        for (std::size_t p = to.bends; p-- > from.bends;)
            for (std::size_t lane = 8; lane > 0;) {
                lane -= lanes;
                energies = energies + bend(sheet, sheet.bends[p], lane, &s.bend[8 * p], u);
            }
        for (std::size_t p = to.edges; p-- > from.edges;)
            for (std::size_t lane = 8; lane > 0;) {
                lane -= lanes;
                energies = energies + stretch(sheet.edges[p], lane, &s.stretch[8 * p], u);
            }
        energy += sum(energies);
    }
    return energy / 2;
}

double strainEnergy(const PackedSheet& sheet, SheetKernels::Blocks blocks, const SheetState& s) {
    double energy = 0;
    for (const std::uint32_t b : blocks) {
        const SheetBlock from = sheet.blockStart(b), &to = sheet.blocks[b];
        V energies = all(0);
        const auto add = [&](const float* multipliers, const float* compliances) {
            for (std::size_t lane = 0; lane < 8; lane += lanes) {
                const V m = load(multipliers + lane);
                energies = energies + load(compliances + lane) * m * m;
            }
        };
        for (std::size_t p = from.edges; p < to.edges; ++p) add(&s.stretch[8 * p], sheet.edges[p].compliance);
        for (std::size_t p = from.bends; p < to.bends; ++p) add(&s.bend[8 * p], sheet.bends[p].compliance);
        energy += sum(energies);
        for (std::size_t r = from.rims; r < to.rims; ++r)
            energy += static_cast<double>(sheet.rims[r].compliance * s.rim[r].squaredNorm());
    }
    return energy / 2;
}

SheetMeasure measure(const PackedSheet& sheet, std::span<const SheetRun> runs, const Move* before,
                     const Move* u) {
    constexpr std::size_t together = lanes / 4;
    constexpr std::uint32_t most = 256; // vertices in floats, then in doubles
    SheetMeasure result;
    V farthest = all(0), energies = all(0); // the fourth lanes never change: 0
    std::uint32_t count = 0;
    const auto add = [&](const V& mass, const V& was, const V& is) {
        const V moved = is - was;
        farthest = larger(farthest, larger(moved, was - is));
        energies = mulAdd(mass * moved, is + was, energies);
    };
    for (const SheetRun& run : runs) {
        std::size_t v = run.first;
        for (; v + together <= run.last; v += together) {
            add(masses(&sheet.mass[v]), load(before[v].data()), load(u[v].data()));
            if (++count == most) {
                result.dual += sum(energies);
                energies = all(0);
                count = 0;
            }
        }
        for (; v < run.last; ++v) add(all(sheet.mass[v]), one(before[v].data()), one(u[v].data()));
    }
    result.dual = (result.dual + sum(energies)) / 2;
    float lane[lanes];
    store(farthest, lane);
    result.change = *std::max_element(lane, lane + lanes);
    return result;
}

void extrapolate(float momentum, float* now, float* before, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const float x = now[i];
        now[i] += momentum * (x - before[i]);
        before[i] = x;
    }
}

constexpr SheetKernels kernels{displace, sweepTo, sweepFro, strainEnergy, measure, extrapolate};

const SheetKernels* choose() {
    return &kernels;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tss {

SheetState::SheetState(const PackedSheet& sheet)
    : u(sheet.vertexCount() + 1, Move::Zero()), stretch(8 * sheet.edges.size()), bend(8 * sheet.bends.size()),
      rim(sheet.rims.size()) {
    reset(sheet);
}

void SheetState::reset(const PackedSheet& sheet) {
    for (std::size_t v = 0; v < sheet.vertexCount(); ++v) u[v] = Move(0, 0, 0, sheet.inverseMass[v]);
    u.back().setZero();
    std::fill(stretch.begin(), stretch.end(), 0.0f);
    std::fill(bend.begin(), bend.end(), 0.0f);
    std::fill(rim.begin(), rim.end(), Move::Zero());
}

namespace {

const SheetKernels* kernelsFor(KernelTarget target) {
    TSS_TARGETS(choose())
    (void)target;
    return HWY_STATIC_DISPATCH(choose)();
}

} // namespace

const SheetKernels& sheetKernels(KernelTarget target) {
    return *kernelsFor(target == KernelTarget::Best ? bestTarget() : target);
}

} // namespace tss
#endif
