#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace osgTSS {

/// Points in cells of a grid, to find one within the size of a cell. Keeps a reference to the points.
class PointGrid {
public:
    PointGrid(const std::vector<tss::Vec3>& points, double cell) : _points(points), _cell(cell) {
        for (std::size_t i = 0; i < points.size(); ++i)
            _cells[key(at(points[i]))].push_back(static_cast<std::uint32_t>(i));
    }

    /// The nearest within one cell; -1: none.
    int nearest(const tss::Vec3& point) const {
        const auto centre = at(point);
        int best = -1;
        double least = _cell * _cell;
        for (int n = 0; n < 27; ++n) {
            const auto cell =
                _cells.find(key({centre[0] + n % 3 - 1, centre[1] + n / 3 % 3 - 1, centre[2] + n / 9 - 1}));
            if (cell == _cells.end()) continue;
            for (const std::uint32_t i : cell->second)
                if (const double away = (_points[i] - point).squaredNorm(); away <= least) {
                    if (best >= 0 && away == least) continue;
                    least = away;
                    best = static_cast<int>(i);
                }
        }
        return best;
    }

private:
    using Cell = std::array<std::int64_t, 3>;
    Cell at(const tss::Vec3& p) const {
        return {std::llround(p.x() / _cell), std::llround(p.y() / _cell), std::llround(p.z() / _cell)};
    }
    static std::uint64_t key(const Cell& c) {
        std::uint64_t hash = 0;
        for (const std::int64_t part : c)
            hash = (hash ^ static_cast<std::uint64_t>(part)) * 0x9e3779b97f4a7c15ull;
        return hash;
    }

    const std::vector<tss::Vec3>& _points;
    double _cell;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> _cells;
};

} // namespace osgTSS
