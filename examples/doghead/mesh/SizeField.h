#pragma once
#include "examples/doghead/mesh/Meshing.h"

namespace doghead {

/// The edge length asked for at a place near a surface: sqrt(8 deviation / curvature), within the limits,
/// growing no faster than the gradation. Kept on a grid over the surface.
class SizeField {
public:
    SizeField(const tss::TriangleMesh& fine, const Field& field, const RemeshOptions& options);

    double operator()(const Vec3& p) const;

private:
    std::size_t cell(const Eigen::Vector3i& i) const {
        return (i.z() * count_.y() + i.y()) * count_.x() + i.x();
    }
    void limitGrowth(double gradation);

    Vec3 origin_;
    double step_ = 1.5;
    Eigen::Vector3i count_;
    std::vector<double> size_;
};

} // namespace doghead
