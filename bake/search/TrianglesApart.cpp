#include "bake/search/SurfacesApart.h"

#include "bake/geometry/SurfacePart.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tss {

namespace {

Vec3 normalOf(const Corners& c) {
    return (c[1] - c[0]).cross(c[2] - c[0]);
}

/// A triangle of B where it is at the centre of the cell, and how far second order lets its corners move.
struct Placed {
    Corners corners;
    std::array<double, 3> remainder;
};

class Separation {
public:
    Separation(const MeshQuery& a, const MeshQuery& b, const CellMotion& motion, double distance)
        : a_(a), b_(b), motion_(motion), distance_(distance) {
        const Vec3 toA = -a.centre();
        place_ = Eigen::Translation3d(toA) * motion.centrePose() * Eigen::Translation3d(b.centre());
    }

    /// The nodes cannot come within the distance: by a ball about B's.
    bool nodesApart(const Bvh::Node& nodeA, const Bvh::Node& nodeB) const {
        const Vec3 at = place_ * Vec3((nodeB.lower + nodeB.upper) / 2);
        const double radius = (nodeB.upper - nodeB.lower).norm() / 2;
        return std::sqrt(squaredDistance(nodeA, at)) > distance_ + ballMove(at, radius);
    }

    bool trianglesApart(std::uint32_t itemA, std::uint32_t itemB) const {
        const Corners x = a_.localTriangle(itemA);
        const Corners corners = b_.localTriangle(itemB);
        Placed y;
        for (std::size_t k = 0; k < 3; ++k) {
            y.corners[k] = place_ * corners[k];
            y.remainder[k] = motion_.pointMotion(y.corners[k] + a_.centre()).remainder;
        }
        const Vec3 normalA = normalOf(x), normalB = normalOf(y.corners);
        if (apartAlong(normalA, x, y) || apartAlong(normalB, x, y)) return true;
        std::array<Vec3, 3> edgesA, edgesB;
        for (std::size_t k = 0; k < 3; ++k) {
            edgesA[k] = x[(k + 1) % 3] - x[k];
            edgesB[k] = y.corners[(k + 1) % 3] - y.corners[k];
        }
        for (const Vec3& edge : edgesA)
            if (apartAlong(normalA.cross(edge), x, y)) return true;
        for (const Vec3& edge : edgesB)
            if (apartAlong(normalB.cross(edge), x, y)) return true;
        for (const Vec3& edgeA : edgesA)
            for (const Vec3& edgeB : edgesB)
                if (apartAlong(edgeA.cross(edgeB), x, y)) return true;
        return false;
    }

private:
    /// How far points of a ball of B may move, its centre given at the centre of the cell.
    double ballMove(const Vec3& at, double radius) const {
        return motion_.pointMotion(at + a_.centre()).move + motion_.relativeMove() * radius + radius;
    }

    /// Points of a triangle move along a direction by no more than its corners do, for they are affine in
    /// these at every pose.
    bool apartAlong(const Vec3& direction, const Corners& x, const Placed& y) const {
        const double length = direction.norm();
        if (!(length > 0)) return false;
        return apartBeyond(direction / length, x, y) || apartBeyond(-direction / length, x, y);
    }

    bool apartBeyond(const Vec3& n, const Corners& x, const Placed& y) const {
        const double upTo = std::max({n.dot(x[0]), n.dot(x[1]), n.dot(x[2])}) + distance_;
        for (std::size_t k = 0; k < 3; ++k)
            if (n.dot(y.corners[k]) - y.remainder[k] <= upTo) return false;
        std::array<double, maxDofs> slope;
        for (std::size_t k = 0; k < 3; ++k) {
            motion_.slope(y.corners[k] + a_.centre(), n, slope.data());
            double from = n.dot(y.corners[k]) - y.remainder[k];
            for (std::size_t d = 0; d < motion_.dofs(); ++d) from -= motion_.half(d) * std::abs(slope[d]);
            if (!(from > upTo)) return false;
        }
        return true;
    }

    const MeshQuery &a_, &b_;
    const CellMotion& motion_;
    const double distance_;
    Pose place_;
};

} // namespace

bool trianglesApart(const MeshQuery& a, const MeshQuery& b, const CellMotion& motion, double distance,
                    double rounding, std::uint64_t most, std::uint64_t& looked) {
    const Separation separation(a, b, motion, distance + rounding);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{0, 0}};
    while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        const Bvh::Node &nodeA = a.bvh().nodes[i], &nodeB = b.bvh().nodes[j];
        if (++looked > most) return false;
        if (separation.nodesApart(nodeA, nodeB)) continue;
        const bool divideA =
            nodeA.count == 0 && (nodeB.count > 0 || (nodeA.upper - nodeA.lower).squaredNorm() >=
                                                        (nodeB.upper - nodeB.lower).squaredNorm());
        if (divideA) {
            for (const std::uint32_t child : {nodeA.first, nodeA.first + 1}) open.emplace_back(child, j);
        } else if (nodeB.count == 0) {
            for (const std::uint32_t child : {nodeB.first, nodeB.first + 1}) open.emplace_back(i, child);
        } else {
            for (std::uint32_t x = nodeA.first; x < nodeA.first + nodeA.count; ++x)
                for (std::uint32_t y = nodeB.first; y < nodeB.first + nodeB.count; ++y)
                    if (++looked; !separation.trianglesApart(x, y)) return false;
        }
    }
    return true;
}

} // namespace tss
