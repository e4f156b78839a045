#include "bake/table/VectorTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/respond/SkinKernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/respond/SkinKernels.h"

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace tss {
namespace HWY_NAMESPACE {
namespace {

// Four doubles: of one vertex in memory, of one coordinate of four vertices in between.
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3
namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::FixedTag<double, 4>;
using V = hn::Vec<Doubles>;

HWY_INLINE V load(const double* from) {
    return hn::LoadU(Doubles(), from);
}
HWY_INLINE void store(V value, double* to) {
    hn::StoreU(value, Doubles(), to);
}
HWY_INLINE V all(double x) {
    return hn::Set(Doubles(), x);
}
HWY_INLINE void transpose(V& a, V& b, V& c, V& d) {
    const Doubles f;
    const V ab = hn::InterleaveLower(f, a, b), cd = hn::InterleaveLower(f, c, d);
    const V AB = hn::InterleaveUpper(f, a, b), CD = hn::InterleaveUpper(f, c, d);
    a = hn::ConcatLowerLower(f, cd, ab);
    b = hn::ConcatLowerLower(f, CD, AB);
    c = hn::ConcatUpperUpper(f, cd, ab);
    d = hn::ConcatUpperUpper(f, CD, AB);
}
HWY_INLINE V root(V x) {
    return hn::Sqrt(x);
}
using M = hn::Mask<Doubles>;
HWY_INLINE M above(V a, V b) {
    return hn::Gt(a, b);
}
HWY_INLINE M atLeast(V a, V b) {
    return hn::Ge(a, b);
}
HWY_INLINE M both(M a, M b) {
    return hn::And(a, b);
}
/// A bit for each lane in which it does not hold.
HWY_INLINE std::uint64_t fails(M mask) {
    const Doubles f;
    if (hn::AllTrue(f, mask)) return 0;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(f, hn::Not(mask), bits);
    return bits[0];
}
#else
using V = Eigen::Array4d;

HWY_INLINE V load(const double* from) {
    return V::Map(from);
}
HWY_INLINE void store(const V& value, double* to) {
    V::Map(to) = value;
}
HWY_INLINE V all(double x) {
    return V::Constant(x);
}
HWY_INLINE void transpose(V& a, V& b, V& c, V& d) {
    const V A = a, B = b, C = c, D = d;
    a = {A[0], B[0], C[0], D[0]};
    b = {A[1], B[1], C[1], D[1]};
    c = {A[2], B[2], C[2], D[2]};
    d = {A[3], B[3], C[3], D[3]};
}
HWY_INLINE V root(const V& x) {
    return x.sqrt();
}
using M = Eigen::Array<bool, 4, 1>;
HWY_INLINE M above(const V& a, const V& b) {
    return a > b;
}
HWY_INLINE M atLeast(const V& a, const V& b) {
    return a >= b;
}
HWY_INLINE M both(const M& a, const M& b) {
    return a && b;
}
HWY_INLINE std::uint64_t fails(const M& mask) {
    std::uint64_t bits = 0;
    for (int k = 0; k < 4; ++k) bits |= static_cast<std::uint64_t>(!mask[k]) << k;
    return bits;
}
#endif

struct Vectors {
    V x, y, z;
};

HWY_INLINE Vectors minus(const Vectors& a, const Vectors& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
/// In the order in which Eigen adds.
HWY_INLINE V dot(const Vectors& a, const Vectors& b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}
HWY_INLINE Vectors cross(const Vectors& a, const Vectors& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Those at index(0) to index(3).
template <class Index>
HWY_INLINE Vectors gather(const SkinPlace* places, const Index& index) {
    V a = load(places[index(0)].data()), b = load(places[index(1)].data()), c = load(places[index(2)].data()),
      d = load(places[index(3)].data());
    transpose(a, b, c, d);
    return {a, b, c};
}

/// The normals of triangles t to t + 3, twice the area long.
HWY_INLINE Vectors normalsOf(const Tri* t, const SkinPlace* places) {
    const Vectors a = gather(places, [&](int k) { return t[k][0]; });
    return cross(minus(gather(places, [&](int k) { return t[k][1]; }), a),
                 minus(gather(places, [&](int k) { return t[k][2]; }), a));
}

/// The rest of a list whose length is no multiple of four.
Vec3 normalOf(const Tri& t, const SkinPlace* places) {
    const Vec3 a = places[t[0]].head<3>(), b = places[t[1]].head<3>(), c = places[t[2]].head<3>();
    return (b - a).cross(c - a);
}

HWY_INLINE void mark(std::uint64_t bits, std::size_t first, std::uint64_t* marks) {
    marks[first / 64] |= bits << (first % 64); // four together are in one word
}

void links(const SkinWeave& weave, const SkinPlace* places, std::uint64_t* beyond) {
    const SkinLink* l = weave.links.data();
    const std::size_t count = weave.links.size(), whole = count / 4 * 4;
    const V low = all(strain::allowed2 * strain::low2), high = all(strain::beyond2 * strain::high2);
    for (std::size_t e = 0; e < whole; e += 4) {
        const Vectors d = minus(gather(places, [&](int k) { return l[e + k].i; }),
                                gather(places, [&](int k) { return l[e + k].j; }));
        const V now = dot(d, d), squared = load(&weave.squared[e]);
        mark(fails(both(atLeast(now, low * squared), atLeast(high * squared, now))), e, beyond);
    }
    for (std::size_t e = whole; e < count; ++e) {
        const double now = (places[l[e].i] - places[l[e].j]).head<3>().squaredNorm();
        mark(!strain::within(now, weave.squared[e]), e, beyond);
    }
}

void triangles(const SkinWeave& weave, const SkinPlace* places, std::uint64_t* over) {
    const Tri* t = weave.triangles.data();
    const std::size_t count = weave.triangles.size(), whole = count / 4 * 4;
    const V share = all(strain::leastCosine * strain::leastCosine), none = all(0);
    for (std::size_t e = 0; e < whole; e += 4) {
        const Vectors now = normalsOf(t + e, places);
        Vectors before;
        const SkinPlace* rest = &weave.normals[e];
        V squared = load(rest[3].data());
        before.x = load(rest[0].data());
        before.y = load(rest[1].data());
        before.z = load(rest[2].data());
        transpose(before.x, before.y, before.z, squared);
        const V along = dot(now, before);
        mark(fails(both(above(along, none), atLeast(along * along, share * dot(now, now) * squared))), e,
             over);
    }
    for (std::size_t e = whole; e < count; ++e)
        mark(!strain::lies(normalOf(t[e], places), weave.normals[e]), e, over);
}

void normals(std::span<const Tri> triangles, const SkinPlace* places, SkinPlace* sums) {
    const std::size_t count = triangles.size(), whole = count / 4 * 4;
    for (std::size_t e = 0; e < whole; e += 4) {
        const Tri* t = &triangles[e];
        const Vectors n = normalsOf(t, places);
        V of[4] = {n.x, n.y, n.z, all(0)};
        transpose(of[0], of[1], of[2], of[3]);
        for (int k = 0; k < 4; ++k)
            for (int corner = 0; corner < 3; ++corner) {
                double* sum = sums[t[k][corner]].data();
                store(load(sum) + of[k], sum);
            }
    }
    for (std::size_t e = whole; e < count; ++e)
        for (int corner = 0; corner < 3; ++corner)
            sums[triangles[e][corner]].head<3>() += normalOf(triangles[e], places);
}

void normalise(const SkinPlace* sums, std::span<Vec3> normals) {
    const std::size_t count = normals.size(), whole = count / 4 * 4;
    const auto one = [&](std::size_t v) {
        const Vec3 n = sums[v].head<3>();
        const double squared = n.x() * n.x() + (n.y() * n.y() + n.z() * n.z());
        normals[v] = squared > 0 ? Vec3(n / std::sqrt(squared)) : n;
    };
    for (std::size_t v = 0; v < whole; v += 4) {
        const Vectors n = gather(sums + v, [](int k) { return k; });
        const V squared = dot(n, n);
        if (fails(above(squared, all(0))) != 0) {
            for (std::size_t k = v; k < v + 4; ++k) one(k);
            continue;
        }
        const V length = root(squared);
        V of[4] = {n.x / length, n.y / length, n.z / length, all(0)};
        transpose(of[0], of[1], of[2], of[3]);
        SkinPlace last;
        for (int k = 0; k < 3; ++k) store(of[k], normals[v + k].data()); // and over the start of the next one
        store(of[3], last.data());
        normals[v + 3] = last.head<3>();
    }
    for (std::size_t v = whole; v < count; ++v) one(v);
}

constexpr SkinKernels kernels{links, triangles, normals, normalise};

const SkinKernels* choose() {
    return &kernels;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace tss
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tss {
namespace {

const SkinKernels* kernelsFor(KernelTarget target) {
    TSS_TARGETS(choose())
    (void)target;
    return HWY_STATIC_DISPATCH(choose)();
}

} // namespace

const SkinKernels& skinKernels(KernelTarget target) {
    return *kernelsFor(target == KernelTarget::Best ? bestTarget() : target);
}

} // namespace tss
#endif
