#pragma once
#include "bake/geometry/Bvh.h"

#include <algorithm>
#include <climits>

namespace osgTSS {

/// Points, to find one within a distance. Keeps a reference to them.
class NearPoints {
public:
    NearPoints(const std::vector<tss::Vec3>& points, double within)
        : _points(points), _within(within),
          _tree(tss::buildBvh(std::vector<Eigen::AlignedBox3d>(points.begin(), points.end()))) {}

    /// The nearest within the distance, the first of equally near ones; -1: none.
    int nearest(const tss::Vec3& point) const {
        std::pair<double, int> best{_within * _within, INT_MAX};
        tss::visitBall(_tree, point, _within, [&](std::uint32_t i) {
            best = std::min(best, std::pair((_points[i] - point).squaredNorm(), static_cast<int>(i)));
        });
        return best.second == INT_MAX ? -1 : best.second;
    }

private:
    const std::vector<tss::Vec3>& _points;
    double _within;
    tss::Bvh _tree;
};

} // namespace osgTSS
