#include "examples/doghead/mesh/SizeField.h"

#include "bake/base/Parallel.h"

#include <algorithm>
#include <cmath>

namespace doghead {

SizeField::SizeField(const tss::TriangleMesh& fine, const Field& field, const RemeshOptions& options) {
    const Box box = bounds(fine);
    origin_ = box.min() - Vec3::Constant(step_);
    count_ = ((box.max() - origin_) / step_).array().cast<int>() + 2;
    size_.assign(std::size_t(count_.x()) * count_.y() * count_.z(), options.longest);

    std::vector<Vec3> normals(fine.vertices.size());
    tss::parallelFor(fine.vertices.size(),
                     [&](std::size_t i) { normals[i] = normal(field, fine.vertices[i], 0.5); });
    for (const tss::Tri& t : fine.triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            // Very short edges of the raw mesh tell noise, not curvature.
            const double length = std::max((fine.vertices[a] - fine.vertices[b]).norm(), 0.7);
            const double curvature = (normals[a] - normals[b]).norm() / length;
            double wanted = curvature > 0 ? std::sqrt(8 * options.deviation / curvature) : options.longest;
            if (options.limit) wanted = std::min(wanted, options.limit(fine.vertices[a]));
            const Eigen::Vector3i i = ((fine.vertices[a] - origin_) / step_).array().cast<int>();
            size_[cell(i)] = std::clamp(wanted, options.shortest, size_[cell(i)]);
        }
    limitGrowth(options.gradation);
}

void SizeField::limitGrowth(double gradation) {
    // A chamfer transform: forward and backward sweeps over the 26 neighbours until nothing changes much.
    for (int round = 0; round < 4; ++round) {
        const int forward = round % 2 == 0 ? 1 : -1;
        const auto range = [&](int n, int i) { return forward > 0 ? i : n - 1 - i; };
        for (int zi = 0; zi < count_.z(); ++zi)
            for (int yi = 0; yi < count_.y(); ++yi)
                for (int xi = 0; xi < count_.x(); ++xi) {
                    const Eigen::Vector3i at(range(count_.x(), xi), range(count_.y(), yi),
                                             range(count_.z(), zi));
                    double& here = size_[cell(at)];
                    for (int n = 0; n < 27; ++n) {
                        const Eigen::Vector3i step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1), to = at + step;
                        if ((to.array() < 0).any() || (to.array() >= count_.array()).any()) continue;
                        here =
                            std::min(here, size_[cell(to)] + gradation * step_ * step.cast<double>().norm());
                    }
                }
    }
}

double SizeField::operator()(const Vec3& p) const {
    const Vec3 scaled = ((p - origin_) / step_ - Vec3::Constant(0.5))
                            .cwiseMax(Vec3::Zero())
                            .cwiseMin((count_.cast<double>() - Vec3::Constant(1.001)).eval());
    const Eigen::Vector3i i = scaled.array().floor().cast<int>();
    const Vec3 t = scaled - i.cast<double>();
    double size = 0;
    for (int c = 0; c < 8; ++c) {
        const Eigen::Vector3i corner(c & 1, c >> 1 & 1, c >> 2);
        const Eigen::Vector3i at = (i + corner).cwiseMin((count_.array() - 1).matrix());
        double weight = 1;
        for (int k = 0; k < 3; ++k) weight *= corner[k] ? t[k] : 1 - t[k];
        size += weight * size_[cell(at)];
    }
    return size;
}

} // namespace doghead
