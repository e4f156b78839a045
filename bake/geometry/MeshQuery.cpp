// Winding numbers: Jacobson, Kavan and Sorkine-Hornung, "Robust inside-outside segmentation using generalized
// winding numbers", 2013; Barill, Dickson, Schmidt, Levin and Jacobson, "Fast winding numbers for soups and
// clouds", 2018.
#include "bake/geometry/MeshQuery.h"

#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/TriangleDistance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tss {

MeshQuery::MeshQuery(const TriangleMesh& mesh, bool closed) : closed_(closed) {
    checkIndices(mesh);
    Eigen::AlignedBox3d all;
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) all.extend(mesh.vertices[t[k]]);
    if (!all.isEmpty()) origin_ = all.center();
    std::vector<Eigen::AlignedBox3d> boxes;
    boxes.reserve(mesh.triangles.size());
    corners_.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        corners_.push_back(
            {mesh.corner(t, 0) - origin_, mesh.corner(t, 1) - origin_, mesh.corner(t, 2) - origin_});
        Eigen::AlignedBox3d box(corners_.back()[0]);
        boxes.push_back(box.extend(corners_.back()[1]).extend(corners_.back()[2]));
        if (!hasZeroArea(mesh, t)) continue;
        flat_.resize(mesh.triangles.size(), 0);
        flat_[t] = 1;
    }
    bvh_ = buildBvh(boxes);
    buildDipoles();
}

ClosestPoint MeshQuery::closest(const Vec3& p, double within) const {
    const Vec3 local = p - origin_;
    ClosestPoint result;
    double best2 = within * within;
    visitNearest(bvh_, local, best2, [&](std::uint32_t t) {
        const Corners& k = corners_[t];
        const Vec3 q = closestOnTriangle(local, k[0], k[1], k[2]);
        const double d2 = (q - local).squaredNorm();
        if (d2 < best2) {
            best2 = d2;
            result.point = q;
            result.triangle = static_cast<int>(t);
        }
    });
    if (result.triangle >= 0) {
        result.distance = std::sqrt(best2);
        result.point += origin_;
    }
    return result;
}

bool MeshQuery::comesWithin(const Vec3& p, double within) const {
    if (bvh_.empty() || !(within > 0)) return false;
    const Vec3 local = p - origin_;
    const double within2 = within * within;
    std::array<std::uint32_t, 128> stack; // as deep as visitNearest's
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const Bvh::Node& node = bvh_.nodes[stack[--top]];
        if (!(squaredDistance(node, local) < within2)) continue;
        // The farthest corner of the box is within the distance, and so is everything in it.
        if ((local - node.lower).cwiseAbs().cwiseMax((node.upper - local).cwiseAbs()).squaredNorm() < within2)
            return true;
        for (std::uint32_t i = 0; i < node.count; ++i) {
            const Corners& k = corners_[bvh_.items[node.first + i]];
            if ((closestOnTriangle(local, k[0], k[1], k[2]) - local).squaredNorm() < within2) return true;
        }
        if (node.count > 0) continue;
        const std::uint32_t a = node.first, b = node.first + 1;
        const bool bFirst = squaredDistance(bvh_.nodes[b], local) < squaredDistance(bvh_.nodes[a], local);
        stack[top++] = bFirst ? a : b;
        stack[top++] = bFirst ? b : a;
    }
    return false;
}

namespace {

/// Squared distance of two boxes, the second one given by its middle and half its sides.
double squaredDistanceOfBoxes(const Bvh::Node& node, const Vec3& middle, const Vec3& half) {
    return (node.lower - (middle + half)).cwiseMax((middle - half) - node.upper).cwiseMax(0.0).squaredNorm();
}

} // namespace

double MeshQuery::squaredDistanceTo(const MeshQuery& other, const Eigen::Isometry3d& otherToThis,
                                    double best2, const DistanceLimits& limits, std::uint64_t& looks) const {
    if (bvh_.empty() || other.bvh_.empty()) return best2;
    const Eigen::Matrix3d turn = otherToThis.linear(), size = turn.cwiseAbs();
    const Vec3 shift = otherToThis * other.origin_ - origin_;
    const auto bound2 = [&](std::uint32_t here, std::uint32_t there) {
        const Bvh::Node& node = other.bvh_.nodes[there];
        const Vec3 middle = turn * (0.5 * (node.lower + node.upper)) + shift;
        return squaredDistanceOfBoxes(bvh_.nodes[here], middle, size * (0.5 * (node.upper - node.lower)));
    };
    const double asked2 = best2;
    struct NodePair {
        double bound2; // of the squared distance of their boxes
        std::uint32_t here, there;
    };
    std::vector<NodePair> stack{{bound2(0, 0), 0, 0}};
    std::vector<Corners> moved;
    while (!stack.empty()) {
        const NodePair both = stack.back();
        stack.pop_back();
        if (!(both.bound2 < limits.share2 * best2)) continue;
        if (looks > limits.most) return 0;
        const Bvh::Node &a = bvh_.nodes[both.here], &b = other.bvh_.nodes[both.there];
        if (a.count > 0 && b.count > 0) {
            moved.clear();
            for (std::uint32_t j = b.first; j < b.first + b.count; ++j) {
                const Corners& k = other.corners_[other.bvh_.items[j]];
                moved.push_back({turn * k[0] + shift, turn * k[1] + shift, turn * k[2] + shift});
            }
            looks += std::uint64_t(a.count) * b.count;
            for (std::uint32_t i = a.first; i < a.first + a.count; ++i) {
                const Corners& s = corners_[bvh_.items[i]];
                for (const Corners& t : moved)
                    if (!surelyBeyond(s, t, limits.share2 * best2))
                        best2 = std::min(best2, squaredDistanceOfTriangles(s, t));
            }
            if (best2 == 0 || (limits.stopAtFirst && best2 < asked2)) return best2;
            continue;
        }
        ++looks;
        // The larger node is replaced by its children; the nearer pair goes on top of the stack.
        const bool openHere = b.count > 0 || (a.count == 0 && (a.upper - a.lower).squaredNorm() >=
                                                                  (b.upper - b.lower).squaredNorm());
        NodePair parts[2];
        for (std::uint32_t k = 0; k < 2; ++k) {
            parts[k].here = openHere ? a.first + k : both.here;
            parts[k].there = openHere ? both.there : b.first + k;
            parts[k].bound2 = bound2(parts[k].here, parts[k].there);
        }
        const bool swap = parts[0].bound2 < parts[1].bound2;
        stack.push_back(parts[swap ? 1 : 0]);
        stack.push_back(parts[swap ? 0 : 1]);
    }
    return best2;
}

double MeshQuery::distanceTo(const MeshQuery& other, const Eigen::Isometry3d& otherToThis,
                             double within) const {
    std::uint64_t looks = 0;
    const double best2 = squaredDistanceTo(other, otherToThis, within * within, {}, looks);
    return best2 < within * within ? std::sqrt(best2) : infinity;
}

double MeshQuery::roughDistanceTo(const MeshQuery& other, const Eigen::Isometry3d& otherToThis) const {
    constexpr double share = 0.95;
    std::uint64_t looks = 0;
    return std::sqrt(squaredDistanceTo(other, otherToThis, infinity, {.share2 = share * share}, looks));
}

bool MeshQuery::apart(const MeshQuery& other, const Eigen::Isometry3d& otherToThis, double distance,
                      std::uint64_t* looks, std::uint64_t most) const {
    const double distance2 = distance * distance;
    std::uint64_t seen = 0;
    const double best2 = squaredDistanceTo(other, otherToThis, distance2, {true, most}, seen);
    if (looks) *looks += seen;
    return !(best2 < distance2);
}

void MeshQuery::buildDipoles() {
    dipoles_.resize(bvh_.nodes.size());
    std::vector<double> areas(bvh_.nodes.size(), 0.0);
    // Children stand behind their parent: backwards, both are ready.
    for (std::size_t n = bvh_.nodes.size(); n-- > 0;) {
        const Bvh::Node& node = bvh_.nodes[n];
        Dipole& dipole = dipoles_[n];
        Vec3 weighted = Vec3::Zero();
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Corners& k = corners_[bvh_.items[i]];
            if (!flat_.empty() && flat_[bvh_.items[i]]) continue;
            const Vec3 normal = 0.5 * (k[1] - k[0]).cross(k[2] - k[0]);
            dipole.areaNormal += normal;
            areas[n] += normal.norm();
            weighted += normal.norm() * (k[0] + k[1] + k[2]) / 3;
        }
        if (node.count == 0)
            for (const std::uint32_t child : {node.first, node.first + 1}) {
                dipole.areaNormal += dipoles_[child].areaNormal;
                areas[n] += areas[child];
                weighted += areas[child] * dipoles_[child].centre;
            }
        dipole.centre = areas[n] > 0 ? Vec3(weighted / areas[n]) : Vec3(0.5 * (node.lower + node.upper));
        dipole.radius = (node.upper - dipole.centre).cwiseMax(dipole.centre - node.lower).norm();
    }
}

namespace {

/// Calls leaf(item) for the items of nodes for which, and for all of whose ancestors, descend(index) is true.
template <class Descend, class Leaf>
void visitDepthFirst(const Bvh& bvh, const Descend& descend, const Leaf& leaf) {
    std::array<std::uint32_t, 128> stack; // as deep as visitNearest's
    std::size_t top = 0;
    if (!bvh.empty()) stack[top++] = 0;
    while (top > 0) {
        const std::uint32_t index = stack[--top];
        if (!descend(index)) continue;
        const Bvh::Node& node = bvh.nodes[index];
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) leaf(bvh.items[i]);
        if (node.count > 0) continue;
        stack[top++] = node.first;
        stack[top++] = node.first + 1;
    }
}

} // namespace

double MeshQuery::approximateWinding(const Vec3& local, double beta) const {
    double sum = 0;
    const auto isNear = [&](std::uint32_t node) {
        const Dipole& dipole = dipoles_[node];
        const Vec3 d = dipole.centre - local;
        const double d2 = d.squaredNorm();
        if (!(d2 > beta * beta * dipole.radius * dipole.radius)) return true;
        sum += dipole.areaNormal.dot(d) / (d2 * std::sqrt(d2));
        return false;
    };
    visitDepthFirst(bvh_, isNear, [&](std::uint32_t triangle) { sum += solidAngleOf(triangle, local); });
    return sum / (4 * std::numbers::pi);
}

double MeshQuery::solidAngleOf(std::uint32_t triangle, const Vec3& local) const {
    if (!flat_.empty() && flat_[triangle]) return 0;
    const Corners& k = corners_[triangle];
    return solidAngle(local, k[0], k[1], k[2]);
}

double MeshQuery::exactWinding(const Vec3& local) const {
    double sum = 0;
    for (std::uint32_t t = 0; t < corners_.size(); ++t) sum += solidAngleOf(t, local);
    return sum / (4 * std::numbers::pi);
}

int MeshQuery::crossings(const Vec3& local, const Vec3& along) const {
    const Vec3 inverse = along.cwiseInverse();
    const auto meets = [&](std::uint32_t index) {
        const Bvh::Node& node = bvh_.nodes[index];
        const Eigen::Array3d low = (node.lower - local).array() * inverse.array(),
                             high = (node.upper - local).array() * inverse.array();
        const double enters = low.maxCoeff(), leaves = high.minCoeff();
        return leaves >= 0 && enters <= leaves + 1e-12 * std::abs(leaves);
    };
    // The triangle is projected along the ray, which becomes the origin, and its winding number about the
    // origin counted. A corner shared by two triangles is projected to the same bits in both, so that the ray
    // cannot slip through between them.
    const auto crossing = [&](std::uint32_t triangle) {
        const Corners& k = corners_[triangle];
        const Vec3 from[] = {k[0] - local, k[1] - local, k[2] - local};
        double y[3], z[3];
        for (int i = 0; i < 3; ++i) {
            y[i] = from[i].y() - along.y() * from[i].x();
            z[i] = from[i].z() - along.z() * from[i].x();
        }
        int turns = 0;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            const double side = y[i] * z[j] - z[i] * y[j];
            if (z[i] <= 0 && z[j] > 0) turns += side > 0;
            if (z[i] > 0 && z[j] <= 0) turns -= side < 0;
        }
        if (turns == 0) return 0;
        const double ahead = (from[1] - from[0]).cross(from[2] - from[0]).dot(from[0]);
        return ahead * turns > 0 ? turns : 0;
    };
    int count = 0;
    visitDepthFirst(bvh_, meets, [&](std::uint32_t triangle) {
        if (flat_.empty() || !flat_[triangle]) count += crossing(triangle);
    });
    return count;
}

double MeshQuery::windingNumber(const Vec3& p) const {
    const Vec3 local = p - origin_;
    // Along no axis and no diagonal of a grid.
    const int crossed = crossings(local, {1, 0.6180339887498949, 0.4142135623730951});
    if (closed_ && crossings(local, {1, -0.3027756377319946, 0.7320508075688772}) == crossed) return crossed;
    for (const double beta : {2.0, 6.0}) {
        const double w = approximateWinding(local, beta);
        if (std::abs(w - crossed) <= 0.2) return w;
    }
    // The ray and the dipoles disagree: the mesh is open, or the ray ran along an edge.
    const double w = approximateWinding(local, 20);
    return std::abs(std::abs(w) - 0.5) > 0.2 && std::abs(w) < 1.3 ? w : exactWinding(local);
}

bool MeshQuery::inside(const Vec3& p) const {
    return std::abs(windingNumber(p)) >= 0.5;
}

} // namespace tss
