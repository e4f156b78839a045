#include "bake/search/ContactParts.h"

#include "bake/base/UnionFind.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace tss {

/// What meeting() was asked.
struct ContactSurface::Query {
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
    if (!tree_.empty()) visitNode({other, toOther, reach, size, known, poll}, 0, found);
    std::sort(found.begin(), found.end());
    return found;
}

void ContactSurface::visitNode(const Query& query, std::uint32_t node,
                               std::vector<SurfacePart>& found) const {
    const Bvh::Node& at = tree_.nodes[node];
    const Vec3 centre = query.toOther * Vec3(0.5 * (at.lower + at.upper));
    const double radius = 0.5 * (at.upper - at.lower).norm() * (1 + 1e-12);
    // Where the boundary is farther away than that, all below the node is inside or all is outside.
    if (!query.other.solid_.boundary().comesWithin(centre, radius + query.reach)) {
        if (query.other.inside(centre)) addAll(query, node, found);
        return;
    }
    if (at.count == 0) {
        visitNode(query, at.first, found);
        visitNode(query, at.first + 1, found);
        return;
    }
    for (std::uint32_t i = 0; i < at.count; ++i) {
        const SurfacePart whole{tree_.items[at.first + i], 1};
        visitPart(query, whole, corners(mesh(), whole), nullptr, found);
    }
}

void ContactSurface::addAll(const Query& query, std::uint32_t node, std::vector<SurfacePart>& found) const {
    const Bvh::Node& at = tree_.nodes[node];
    for (std::uint32_t child = 0; at.count == 0 && child < 2; ++child) addAll(query, at.first + child, found);
    for (std::uint32_t i = 0; i < at.count; ++i) {
        const SurfacePart whole{tree_.items[at.first + i], 1};
        if (!query.known.holds(whole)) found.push_back(whole);
    }
}

/// The centre of a part, and what is known of it.
struct ContactSurface::Centre {
    Vec3 position;                   ///< in the other body's frame
    double distance = 0;             ///< scene units: the other's boundary is at least this far away
    Centre* parent = nullptr;        ///< of the part that this one is a half of
    std::optional<bool> inside = {}; ///< whether it is inside the other body, once that was asked
};

/// Whether the centre is inside the other body. The parent's answer holds where the parent is farther from
/// the boundary than from this centre, for then no boundary runs between the two.
bool ContactSurface::isInside(const Query& query, Centre& centre) const {
    if (!centre.inside) {
        Centre* parent = centre.parent;
        const bool same =
            parent && (centre.position - parent->position).norm() * (1 + 1e-9) < parent->distance;
        centre.inside = same ? isInside(query, *parent) : query.other.inside(centre.position);
    }
    return *centre.inside;
}

void ContactSurface::visitPart(const Query& query, SurfacePart part, const Corners& corners, Centre* parent,
                               std::vector<SurfacePart>& found) const {
    if (query.poll.stopped() || query.known.holds(part)) return;
    const auto visitHalves = [&](Centre* above) {
        const std::array<SurfacePart, 2> parts = halves(part);
        const std::array<Corners, 2> both = halves(corners);
        for (int k = 0; k < 2; ++k) visitPart(query, parts[k], both[k], above, found);
    };
    // Some of it is known, so it has been near: how far away it is now mostly says to look at its halves.
    if (part.cuts > 1 && query.known.reaches(part)) return visitHalves(parent);
    const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3;
    double radius = 0;
    for (const Vec3& corner : corners) radius = std::max(radius, (corner - middle).norm() * (1 + 1e-12));
    Centre centre{query.toOther * middle, radius + query.reach, parent};
    const double distance = query.other.solid_.boundary().distance(centre.position, centre.distance);
    if (!std::isfinite(distance)) {
        if (isInside(query, centre)) found.push_back(part);
        return;
    }
    centre.distance = distance;
    const bool allWithin = distance + radius <= query.reach && !query.known.reaches(part);
    if (allWithin || radius <= query.size || part.cuts >> (mostCuts - 1)) {
        found.push_back(part);
        return;
    }
    visitHalves(&centre);
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
