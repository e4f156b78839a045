#include "bake/geometry/TriangleMesh.h"
#include "bake/respond/SkinRigParts.h"

#include <algorithm>
#include <numeric>

namespace tss::rig {
namespace {

constexpr int bitsAnAxis = 20;

/// Puts two zero bits between each two bits.
std::uint64_t spread(std::uint64_t x) {
    std::uint64_t result = 0;
    for (int bit = 0; bit < bitsAnAxis; ++bit) result |= (x >> bit & 1) << (3 * bit);
    return result;
}

} // namespace

std::vector<std::uint32_t> alongCurve(const std::vector<Vec3>& points) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : points) box.extend(p);
    const double size = points.empty() ? 0 : box.sizes().maxCoeff();
    const double scale = size > 0 ? ((1 << bitsAnAxis) - 1) / size : 0;
    std::vector<std::uint64_t> code;
    for (const Vec3& p : points) {
        const Vec3 cell = scale * (p - box.min());
        std::uint64_t bits = 0;
        for (int k = 0; k < 3; ++k) bits |= spread(static_cast<std::uint64_t>(cell[k])) << k;
        code.push_back(bits);
    }
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return code[a] < code[b]; });
    return order;
}

} // namespace tss::rig
