// Ears are cut off one after the other (Meisters, "Polygons have ears", 1975).
#include "bake/geometry/Polygon.h"

#include "bake/base/Infinity.h"
#include "bake/base/Order.h"

#include <cmath>

namespace tss {

namespace {

using Point = Eigen::Vector2d;

/// Of the polygon: its length is twice its area.
Vec3 normalOf(std::span<const Vec3> corners) {
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 2; k < corners.size(); ++k)
        normal += (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]);
    return normal;
}

/// Along the axis that it faces most, so that it turns to the left as seen from there. No coordinate is
/// rounded.
std::vector<Point> flattened(std::span<const Vec3> corners) {
    const Vec3 normal = normalOf(corners);
    int k = 0;
    normal.cwiseAbs().maxCoeff(&k);
    int x = (k + 1) % 3, y = (k + 2) % 3;
    if (normal[k] < 0) std::swap(x, y);
    std::vector<Point> points;
    for (const Vec3& corner : corners) points.emplace_back(corner[x], corner[y]);
    return points;
}

/// Twice the area of the triangle: above 0 where it turns to the left.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

class Ears {
public:
    explicit Ears(std::span<const Vec3> corners)
        : points_(flattened(corners)), ring_(indicesOf<int>(corners.size())) {}

    std::vector<Tri> cut() {
        std::vector<Tri> triangles;
        std::size_t at = 1; // so that a convex one becomes a fan about corner 0
        while (ring_.size() > 3) {
            at = next(at);
            triangles.emplace_back(before(at), ring_[at], after(at));
            ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(at));
            at = at == ring_.size() ? 0 : at; // the corner after the one that is gone
        }
        if (ring_.size() == 3) triangles.emplace_back(ring_[0], ring_[1], ring_[2]);
        return triangles;
    }

private:
    int before(std::size_t at) const { return ring_[(at + ring_.size() - 1) % ring_.size()]; }
    int after(std::size_t at) const { return ring_[(at + 1) % ring_.size()]; }

    double turnAt(std::size_t at) const {
        return turn(points_[before(at)], points_[ring_[at]], points_[after(at)]);
    }

    /// The place in the ring of the first ear from there on. Where rounding or a border that crosses itself
    /// leaves none, that of the corner that takes the least area with it.
    std::size_t next(std::size_t from) const {
        std::size_t least = from;
        double area = infinity;
        for (std::size_t k = 0; k < ring_.size(); ++k) {
            const std::size_t at = (from + k) % ring_.size();
            const double own = turnAt(at);
            if (own > 0 && isEar(at)) return at;
            if (std::abs(own) < area) {
                area = std::abs(own);
                least = at;
            }
        }
        return least;
    }

    /// No other corner lies in the triangle, or on its border elsewhere than at its corners: where a hole is
    /// reached along an edge, corners stand at one place.
    bool isEar(std::size_t at) const {
        const Point &a = points_[before(at)], &b = points_[ring_[at]], &c = points_[after(at)];
        for (const int v : ring_) {
            const Point& p = points_[v];
            if (p == a || p == b || p == c) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }

    std::vector<Point> points_;
    std::vector<int> ring_; ///< corners that are left, in their order
};

} // namespace

std::vector<Tri> triangulated(std::span<const Vec3> corners) {
    if (corners.size() < 3) return {};
    if (corners.size() == 3) return {Tri(0, 1, 2)};
    return Ears(corners).cut();
}

} // namespace tss
