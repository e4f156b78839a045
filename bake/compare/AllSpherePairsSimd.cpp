#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/compare/AllSpherePairsSimd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bake/compare/Methods.h"

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

namespace {

constexpr std::size_t padding = 16;

class AllPairsSimd final : public CollisionMethodLoop<AllPairsSimd> {
public:
    explicit AllPairsSimd(const ComparedPair& problem) : problem_(problem) {
        const std::size_t count = (problem.b.size() + padding - 1) / padding * padding;
        // Padding spheres stand far away with radius 0; they never overlap anything of this size.
        Eigen::AlignedBox3d box;
        for (const Sphere& s : problem.b) box.extend(s.centre);
        if (!problem.b.empty()) centre_ = box.center();
        double size = 0;
        for (const Sphere& s : problem.a) size = std::max(size, (s.centre - centre_).norm() + s.radius);
        for (const Sphere& s : problem.b) size = std::max(size, (s.centre - centre_).norm() + s.radius);
        x_.assign(count, 1e15f);
        y_.assign(count, 0);
        z_.assign(count, 0);
        r_.assign(count, 0);
        for (std::size_t j = 0; j < problem.b.size(); ++j) {
            const Vec3 c = problem.b[j].centre - centre_;
            x_[j] = static_cast<float>(c.x());
            y_[j] = static_cast<float>(c.y());
            z_[j] = static_cast<float>(c.z());
            r_[j] = static_cast<float>(problem.b[j].radius);
        }
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        overlaps_ = HWY_DYNAMIC_DISPATCH(overlapsOne); // chosen once: a choice each call would cost 3 ns
        // Coordinates and differences are off by a few float steps of the whole size, the root of the
        // squares no more than that again.
        const double band = 16 * 6e-8 * 2 * size;
        description() = {"all-pairs-simd", "all pairs",
                         "every sphere of A against every sphere of B, float vectors, first hit out",
                         statedBySpheres(problem).widened(band, band),
                         problem.a.size() * sizeof(Sphere) + count * 4 * sizeof(float)};
        description().slow = true;
    }

    bool hit(const PoseQuery& query) const override {
        const Pose inverse = query.pose.inverse(Eigen::Isometry);
        for (const Sphere& a : problem_.a) {
            const Vec3 c = inverse * a.centre - centre_;
            if (overlaps_(static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z()),
                          static_cast<float>(a.radius), x_.data(), y_.data(), z_.data(), r_.data(),
                          x_.size()))
                return true;
        }
        return false;
    }

private:
    const ComparedPair& problem_;
    Vec3 centre_ = Vec3::Zero(); ///< of B's spheres: floats are finest about it
    std::vector<float> x_, y_, z_, r_;
    bool (*overlaps_)(float, float, float, float, const float*, const float*, const float*, const float*,
                      std::size_t) = nullptr;
};

} // namespace

std::unique_ptr<CollisionMethod> makeAllPairsSimd(const ComparedPair& problem) {
    return std::make_unique<AllPairsSimd>(problem);
}

} // namespace tss::compare
#endif
