#include "bake/verify/SeparatingAxis.h"

#include "bake/geometry/TriangleDistance.h"

#include <limits>

namespace tss::verify {

namespace {

struct Nearest {
    double squared = std::numeric_limits<double>::infinity();
    Vec3 axis = Vec3::Zero();

    void offer(double squaredDistance, const Vec3& along) {
        if (!(squaredDistance < squared)) return;
        squared = squaredDistance;
        axis = along;
    }
};

/// Where two edges are nearest inside of both: across them, which rounding does not turn however near they
/// are.
void offerEdges(Nearest& best, const Vec3& a, const Vec3& u, const Vec3& c, const Vec3& v) {
    const Vec3 across = u.cross(v), between = c - a;
    const double square = across.squaredNorm();
    if (!(square > 1e-24 * u.squaredNorm() * v.squaredNorm())) return;
    const double onA = between.cross(v).dot(across), onC = between.cross(u).dot(across);
    if (!(onA > 0 && onA < square && onC > 0 && onC < square)) return;
    const double along = between.dot(across);
    best.offer(along * along / square, across);
}

} // namespace

Vec3 separatingAxis(const Corners& s, const Corners& t) {
    Nearest best;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 fromS = closestOnTriangle(s[k], t[0], t[1], t[2]) - s[k];
        const Vec3 fromT = closestOnTriangle(t[k], s[0], s[1], s[2]) - t[k];
        best.offer(fromS.squaredNorm(), fromS);
        best.offer(fromT.squaredNorm(), fromT);
        for (std::size_t j = 0; j < 3; ++j)
            offerEdges(best, s[k], s[(k + 1) % 3] - s[k], t[j], t[(j + 1) % 3] - t[j]);
    }
    const double length = best.axis.norm();
    return length > 0 ? Vec3(best.axis / length) : Vec3::Zero();
}

} // namespace tss::verify
