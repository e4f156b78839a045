#include "bake/verify/GapBox.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss::verify {

GapBox::GapBox(const Table& table)
    : table_(table), tests_(tests(table)), moving_(table.b.size()), movedAt_(table.b.size(), 0),
      low_(tests_.size()) {
    double reach = 0;
    for (const Sphere& s : table.a) size_ = std::max(size_, s.centre.norm() + s.radius);
    for (const Sphere& s : table.b) reach = std::max(reach, s.centre.norm() + s.radius);
    size_ = std::max(size_, coordinateBound(table.motion, reach));
}

double GapBox::bound(const Box& box, std::span<const std::uint32_t> list) {
    const PoseBox pose(table_.motion, box, size_);
    ++stamp_;
    double high = std::numeric_limits<double>::infinity();
    for (const std::uint32_t p : list) {
        const Sphere &a = table_.a[tests_[p].a], &b = table_.b[tests_[p].b];
        const double reach = a.radius + b.radius + (table_.restGaps.empty() ? 0 : table_.restGaps[p]);
        MovingPoint& point = moving_[tests_[p].b];
        if (movedAt_[tests_[p].b] != stamp_) {
            point = pose.carry(b.centre, true);
            movedAt_[tests_[p].b] = stamp_;
        }
        const Vec3 apart = point.at - a.centre;
        const double distance = apart.norm();
        double along = 0, across = 0;
        for (std::size_t k = 0; k < pose.dofs(); ++k) {
            along += std::abs(apart.dot(point.velocity[k])) * pose.half(k);
            across += point.velocity[k].norm() * pose.half(k);
        }
        along = distance > 0 ? along / distance : across;
        const double hair = 1e-15 * size_;
        low_[p] = distance - std::min(point.move, along + point.bend) - reach - hair;
        high = std::min(high,
                        std::min(distance + point.move, std::hypot(distance + along, across) + point.bend) -
                            reach + hair);
    }
    return high;
}

} // namespace tss::verify
