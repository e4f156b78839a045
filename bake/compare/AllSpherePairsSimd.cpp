#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/compare/AllSpherePairsSimd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/compare/Methods.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace tss::compare::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Does the sphere (x, y, z, r) overlap one of the `count` spheres? count: a multiple of 16.
HWY_ATTR bool overlapsOne(float x, float y, float z, float r, const float* bx, const float* by,
                          const float* bz, const float* br, std::size_t count) {
    const hn::CappedTag<float, 16> d;
    const auto vx = hn::Set(d, x), vy = hn::Set(d, y), vz = hn::Set(d, z), vr = hn::Set(d, r);
    for (std::size_t j = 0; j < count; j += hn::Lanes(d)) {
        const auto dx = hn::Sub(hn::LoadU(d, bx + j), vx);
        const auto dy = hn::Sub(hn::LoadU(d, by + j), vy);
        const auto dz = hn::Sub(hn::LoadU(d, bz + j), vz);
        const auto sum = hn::Add(hn::LoadU(d, br + j), vr);
        const auto squared = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
        if (!hn::AllFalse(d, hn::Le(squared, hn::Mul(sum, sum)))) return true;
    }
    return false;
}

} // namespace tss::compare::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tss::compare {

HWY_EXPORT(overlapsOne);

std::unique_ptr<CollisionMethod> makeAllPairsSimd(const ComparedPair& problem) {
    constexpr std::size_t padding = 16;
    const std::size_t count = (problem.b.size() + padding - 1) / padding * padding;
    Eigen::AlignedBox3d box;
    for (const Sphere& s : problem.b) box.extend(s.centre);
    // Of B's spheres: floats are finest about it.
    const Vec3 centre = problem.b.empty() ? Vec3(Vec3::Zero()) : Vec3(box.center());
    double size = 0;
    for (const SphereSet* spheres : {&problem.a, &problem.b})
        for (const Sphere& s : *spheres) size = std::max(size, (s.centre - centre).norm() + s.radius);
    // Padding spheres stand far away with radius 0; they never overlap anything of this size.
    std::vector<float> x(count, 1e15f), y(count), z(count), r(count);
    for (std::size_t j = 0; j < problem.b.size(); ++j) {
        const Vec3 c = problem.b[j].centre - centre;
        x[j] = static_cast<float>(c.x());
        y[j] = static_cast<float>(c.y());
        z[j] = static_cast<float>(c.z());
        r[j] = static_cast<float>(problem.b[j].radius);
    }
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    const auto overlaps = HWY_DYNAMIC_DISPATCH(overlapsOne); // chosen once: a choice each call costs 3 ns
    // Coordinates and differences are off by a few float steps of the whole size, the root of the squares no
    // more than that again.
    const double band = 16 * 6e-8 * 2 * size;
    Description about{"all-pairs-simd", "all pairs",
                      "every sphere of A against every sphere of B, float vectors, first hit out",
                      statedBySpheres(problem).widened(band, band),
                      problem.a.size() * sizeof(Sphere) + count * 4 * sizeof(float)};
    about.slow = true;
    return makeMethod(std::move(about), [=, &problem](const PoseQuery& query) {
        const Pose inverse = query.pose.inverse(Eigen::Isometry);
        return std::ranges::any_of(problem.a, [&](const Sphere& a) {
            const Vec3 c = inverse * a.centre - centre;
            return overlaps(static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z()),
                            static_cast<float>(a.radius), x.data(), y.data(), z.data(), r.data(), x.size());
        });
    });
}

} // namespace tss::compare
#endif
