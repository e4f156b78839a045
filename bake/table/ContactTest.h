#pragma once
#include "bake/motion/MotionFrame.h"
#include "bake/table/Contact.h"
#include "bake/table/TablePairs.h"

namespace tss {

/// A test as the contact kernels read it: centres with a 1 behind, in their own frames.
struct alignas(32) ContactTest {
    double a[4], b[4];
    double contactDistance = 0; ///< of the gap: sum of radii, and the gap at rest
    double middle = 0;          ///< half of radius A less radius B
};

inline ContactTest contactTest(const TablePair& p) {
    return {{p.a.x(), p.a.y(), p.a.z(), 1},
            {p.b.x(), p.b.y(), p.b.z(), 1},
            p.contactDistance,
            0.5 * (p.radiusA - p.radiusB)};
}

/// Gap, point, normal and, of `dofs` DOFs, gradient of one test; `test` is left as it is. A vector kernel of
/// 256 bits does the same (Kernels.h).
inline void plainContact(const ContactTest& test, const MotionFrame& frame, std::size_t dofs,
                         TableContact& out) {
    const Vec3 a(test.a[0], test.a[1], test.a[2]);
    const Vec3 centre = frame.pose * Vec3(test.b[0], test.b[1], test.b[2]), between = centre - a;
    const double distance = between.norm();
    const Vec3 normal = distance > 0 ? Vec3(between * (1 / distance)) : Vec3::UnitX();
    out.gap = distance - test.contactDistance;
    out.normal = normal;
    out.point = a + normal * (0.5 * distance + test.middle);
    // n . (turn x x + slide), with the part that all DOFs share in front.
    const Vec3 arm = centre.cross(normal);
    for (std::size_t k = 0; k < dofs; ++k)
        out.gradient[k] = frame.twists[k].turn.dot(arm) + frame.twists[k].slide.dot(normal);
}

} // namespace tss
