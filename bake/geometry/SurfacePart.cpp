#include "bake/geometry/SurfacePart.h"

#include <bit>

namespace tss {

namespace {

/// The squared length, added up in this order whatever Eigen does: of edges that are equal but for rounding,
/// as those of any right triangle soon are, it decides which is cut, and files say so (tss:restCuts0).
double squaredLength(const Vec3& edge) {
    return edge.x() * edge.x() + edge.y() * edge.y() + edge.z() * edge.z();
}

} // namespace

std::array<Corners, 2> halves(const Corners& corners) {
    std::size_t longest = 0;
    double best = -1;
    for (std::size_t k = 0; k < 3; ++k) {
        const double length2 = squaredLength(corners[(k + 1) % 3] - corners[k]);
        if (length2 > best) {
            best = length2;
            longest = k;
        }
    }
    const Vec3 &a = corners[longest], &b = corners[(longest + 1) % 3], &c = corners[(longest + 2) % 3];
    const Vec3 middle = 0.5 * (a + b);
    return {Corners{a, middle, c}, Corners{middle, b, c}};
}

Corners corners(const TriangleMesh& mesh, SurfacePart part) {
    Corners now = mesh.corners(part.triangle);
    for (int bit = std::bit_width(part.cuts) - 2; bit >= 0; --bit) now = halves(now)[part.cuts >> bit & 1];
    return now;
}

} // namespace tss
