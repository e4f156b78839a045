#include "bake/geometry/SurfacePart.h"

#include <bit>

namespace tss {

std::array<Corners, 2> halves(const Corners& corners) {
    std::size_t longest = 0;
    double best = -1;
    for (std::size_t k = 0; k < 3; ++k) {
        const double length2 = (corners[(k + 1) % 3] - corners[k]).squaredNorm();
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
