#include "bake/search/ContactParts.h"

#include "bake/base/UnionFind.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace tss {

struct ContactSurface::Probe {
    const ContactSurface& other;
    const Pose& toOther;
    double reach, size;
    const PartSet& known;
    Poll& poll;
};

ContactSurface::ContactSurface(const Solid& solid, const MeshQuery& surface)
    : solid_(solid), surface_(surface), bounds_(bounds(solid.mesh())) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (std::size_t t = 0; t < mesh().triangles.size(); ++t) {
        Eigen::AlignedBox3d box(mesh().corner(t, 0));
        boxes.push_back(box.extend(mesh().corner(t, 1)).extend(mesh().corner(t, 2)));
    }
    tree_ = buildBvh(boxes, 2);
}

std::vector<SurfacePart> ContactSurface::meeting(const ContactSurface& other, const Pose& toOther,
                                                 double reach, double size, const PartSet& known,
                                                 Poll& poll) const {
    std::vector<SurfacePart> found;
    if (!tree_.empty()) visit(Probe{other, toOther, reach, size, known, poll}, 0, found);
    std::sort(found.begin(), found.end());
    return found;
}

void ContactSurface::visit(const Probe& probe, std::uint32_t node, std::vector<SurfacePart>& found) const {
    const Bvh::Node& at = tree_.nodes[node];
    const Vec3 centre = probe.toOther * Vec3(0.5 * (at.lower + at.upper));
    const double radius = 0.5 * (at.upper - at.lower).norm() * (1 + 1e-12);
    // Where the boundary is farther away, all of it is on one side.
    if (!probe.other.solid_.boundary().comesWithin(centre, radius + probe.reach)) {
        if (probe.other.inside(centre)) addAll(probe, node, found);
        return;
    }
    if (at.count == 0) {
        visit(probe, at.first, found);
        visit(probe, at.first + 1, found);
        return;
    }
    for (std::uint32_t i = 0; i < at.count; ++i) {
        const SurfacePart whole{tree_.items[at.first + i], 1};
        visit(probe, whole, corners(mesh(), whole), nullptr, found);
    }
}

void ContactSurface::addAll(const Probe& probe, std::uint32_t node, std::vector<SurfacePart>& found) const {
    const Bvh::Node& at = tree_.nodes[node];
    for (std::uint32_t child = 0; at.count == 0 && child < 2; ++child) addAll(probe, at.first + child, found);
    for (std::uint32_t i = 0; i < at.count; ++i) {
        const SurfacePart whole{tree_.items[at.first + i], 1};
        if (!probe.known.holds(whole)) found.push_back(whole);
    }
}

/// A part on the way down to its halves.
struct ContactSurface::Cut {
    Vec3 centre;         ///< in the other body's frame
    double distance = 0; ///< of the centre from the other's boundary is at least this
    Cut* whole = nullptr;
    std::optional<bool> inside = {}; ///< the centre, in the other body
};

/// Asked of the whole where the boundary does not run between its centre and this one.
bool ContactSurface::isInside(const Probe& probe, Cut& cut) const {
    if (!cut.inside) {
        const bool same =
            cut.whole && (cut.centre - cut.whole->centre).norm() * (1 + 1e-9) < cut.whole->distance;
        cut.inside = same ? isInside(probe, *cut.whole) : probe.other.inside(cut.centre);
    }
    return *cut.inside;
}

void ContactSurface::visit(const Probe& probe, SurfacePart part, const Corners& corners, Cut* whole,
                           std::vector<SurfacePart>& found) const {
    if (probe.poll.stopped() || probe.known.holds(part)) return;
    const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3;
    double radius = 0;
    for (const Vec3& corner : corners) radius = std::max(radius, (corner - middle).norm() * (1 + 1e-12));
    Cut cut{probe.toOther * middle, radius + probe.reach, whole};
    const double distance = probe.other.solid_.boundary().distance(cut.centre, cut.distance);
    if (!std::isfinite(distance)) {
        if (isInside(probe, cut)) found.push_back(part);
        return;
    }
    cut.distance = distance;
    const bool all = distance + radius <= probe.reach && !probe.known.reaches(part);
    if (all || radius <= probe.size || part.cuts >> (mostCuts - 1)) {
        found.push_back(part);
        return;
    }
    const std::array<SurfacePart, 2> parts = halves(part);
    const std::array<Corners, 2> both = halves(corners);
    for (int k = 0; k < 2; ++k) visit(probe, parts[k], both[k], &cut, found);
}

std::vector<std::vector<SurfacePart>> connected(const TriangleMesh& mesh,
                                                const std::vector<SurfacePart>& parts) {
    UnionFind together(parts.size());
    std::map<std::array<double, 3>, std::size_t> first; // the first part at each corner
    for (std::size_t i = 0; i < parts.size(); ++i)
        for (const Vec3& corner : corners(mesh, parts[i])) {
            const auto [at, fresh] = first.try_emplace({corner.x(), corner.y(), corner.z()}, i);
            together.join(at->second, i);
        }
    std::vector<std::vector<SurfacePart>> sets;
    std::vector<std::size_t> place(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::size_t r = together.root(i);
        if (r == i) {
            place[i] = sets.size();
            sets.emplace_back();
        }
        sets[place[r]].push_back(parts[i]);
    }
    return sets;
}

} // namespace tss
