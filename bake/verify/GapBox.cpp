#include "bake/verify/GapBox.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss::verify {

GapBox::GapBox(const Table& table)
    : motion_(table.motion), tests_(meshTests(table)), moving_(table.b.size()), movedAt_(table.b.size(), 0),
      low_(tests_.size()) {
    double reach = 0;
    for (const Sphere& s : table.a) size_ = std::max(size_, s.centre.norm() + s.radius);
    for (const Sphere& s : table.b) reach = std::max(reach, s.centre.norm() + s.radius);
    size_ = std::max(size_, coordinateBound(table.motion, reach));
}

double GapBox::bound(const Box& box, std::span<const std::uint32_t> list) {
    const PoseBox pose(motion_, box, size_);
    ++stamp_;
    double high = std::numeric_limits<double>::infinity();
    for (const std::uint32_t p : list) {
        const MeshTest& test = tests_[p];
        MovingPoint& point = moving_[test.sphereB];
        if (movedAt_[test.sphereB] != stamp_) {
            point = pose.carry(test.centreB, true);
            movedAt_[test.sphereB] = stamp_;
        }
        const Vec3 apart = point.at - test.centreA;
        const double distance = apart.norm();
        double along = 0, across = 0;
        for (std::size_t k = 0; k < pose.dofs(); ++k) {
            along += std::abs(apart.dot(point.velocity[k])) * pose.half(k);
            across += point.velocity[k].norm() * pose.half(k);
        }
        along = distance > 0 ? along / distance : across;
        const double hair = 1e-15 * size_;
        low_[p] = distance - std::min(point.move, along + point.bend) - test.contactDistance - hair;
        high = std::min(high,
                        std::min(distance + point.move, std::hypot(distance + along, across) + point.bend) -
                            test.contactDistance + hair);
    }
    return high;
}

} // namespace tss::verify
