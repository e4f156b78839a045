#include "bake/geometry/PartSet.h"

#include "bake/base/Order.h"

#include <algorithm>
#include <map>

namespace tss {

namespace {

std::uint64_t key(std::uint32_t triangle, std::uint32_t cuts) {
    return std::uint64_t{triangle} << 32 | cuts;
}

double area(const Corners& c) {
    return 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
}

using Place = std::array<double, 9>;

/// The corners, turned so that the least comes first.
Place placeOfCorners(const Corners& c) {
    Place least{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &x = c[k], &y = c[(k + 1) % 3], &z = c[(k + 2) % 3];
        const Place turned{x.x(), x.y(), x.z(), y.x(), y.y(), y.z(), z.x(), z.y(), z.z()};
        if (k == 0 || turned < least) least = turned;
    }
    return least;
}

Vec3 middle(const Corners& c) {
    return (c[0] + c[1] + c[2]) / 3;
}

/// SurfacePart::cuts of the part of a triangle that has the wanted corners and lies as deep as `cuts`; 0
/// where halving the triangle's longest edges never makes that part.
std::uint32_t cutsOf(Corners whole, const Corners& wanted, std::uint32_t cuts) {
    std::uint32_t found = 1;
    for (; cuts > 1; cuts >>= 1) {
        const std::array<Corners, 2> both = halves(whole);
        const Vec3 at = middle(wanted);
        const bool second = (middle(both[1]) - at).squaredNorm() < (middle(both[0]) - at).squaredNorm();
        whole = both[second];
        found = found * 2 + second;
    }
    return placeOfCorners(whole) == placeOfCorners(wanted) ? found : 0;
}

} // namespace

void PartSet::insert(SurfacePart part) {
    if (contains(part)) return;
    parts_.insert(key(part.triangle, part.cuts));
    for (std::uint32_t cuts = part.cuts; cuts > 0; cuts >>= 1)
        if (!ancestors_.insert(key(part.triangle, cuts)).second) break;
    // Where both halves are in the set now, their parent takes their place.
    if (part.cuts > 1 && parts_.erase(key(part.triangle, part.cuts ^ 1u)) > 0) {
        parts_.erase(key(part.triangle, part.cuts));
        insert({part.triangle, part.cuts >> 1});
    }
}

bool PartSet::contains(SurfacePart part) const {
    if (!ancestors_.count(key(part.triangle, 1))) return false;
    for (std::uint32_t cuts = part.cuts; cuts > 0; cuts >>= 1)
        if (parts_.count(key(part.triangle, cuts))) return true;
    return false;
}

bool PartSet::holds(SurfacePart part) const {
    return parts_.count(key(part.triangle, part.cuts)) > 0;
}

bool PartSet::reaches(SurfacePart part) const {
    return ancestors_.count(key(part.triangle, part.cuts)) > 0;
}

std::vector<SurfacePart> PartSet::merged() const {
    std::vector<SurfacePart> parts;
    for (const std::uint64_t one : parts_) {
        const SurfacePart part{static_cast<std::uint32_t>(one >> 32), static_cast<std::uint32_t>(one)};
        const bool whole = part.cuts == 1 || !contains({part.triangle, part.cuts >> 1});
        if (whole) parts.push_back(part);
    }
    std::sort(parts.begin(), parts.end());
    return parts;
}

std::array<SurfacePart, 2> halves(SurfacePart part) {
    return {SurfacePart{part.triangle, part.cuts * 2}, SurfacePart{part.triangle, part.cuts * 2 + 1}};
}

std::vector<SurfacePart> partsOf(const TriangleMesh& other, const TriangleMesh& mesh,
                                 const std::vector<SurfacePart>& parts) {
    std::map<Place, std::vector<std::uint32_t>> at;
    for (const SurfacePart& part : parts) at[placeOfCorners(mesh.corners(part.triangle))];
    for (std::uint32_t t = 0; t < other.triangles.size() && !at.empty(); ++t)
        if (const auto found = at.find(placeOfCorners(other.corners(t))); found != at.end())
            found->second.push_back(t);
    std::vector<SurfacePart> result;
    for (const SurfacePart& part : parts) {
        const Corners whole = mesh.corners(part.triangle);
        for (const std::uint32_t t : at[placeOfCorners(whole)]) {
            const Corners there = other.corners(t);
            const std::uint32_t cuts =
                there == whole ? part.cuts : cutsOf(there, corners(mesh, part), part.cuts);
            if (cuts > 0) result.push_back({t, cuts});
        }
    }
    sortOnce(result);
    return result;
}

TriangleMesh meshOf(const TriangleMesh& mesh, const std::vector<SurfacePart>& parts) {
    TriangleMesh result;
    for (const SurfacePart& part : parts) {
        const int first = static_cast<int>(result.vertices.size());
        for (const Vec3& corner : corners(mesh, part)) result.vertices.push_back(corner);
        result.triangles.emplace_back(first, first + 1, first + 2);
    }
    return result;
}

double area(const TriangleMesh& mesh, const std::vector<SurfacePart>& parts) {
    double sum = 0;
    for (const SurfacePart& part : parts) sum += area(corners(mesh, part));
    return sum;
}

double area(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += area(mesh.corners(t));
    return sum;
}

} // namespace tss
