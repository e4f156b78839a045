#include "bake/compare/InnerPoles.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

namespace tss::compare {

namespace {

/// Not finite for a tetrahedron so flat that its volume is lost in rounding; CGAL's own asserts there.
Vec3 circumcentre(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    const Vec3 a = q - p, b = r - p, c = s - p;
    const Vec3 sum =
        a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b);
    return p + sum / (2 * a.dot(b.cross(c)));
}

} // namespace

SphereSet innerPoles(std::span<const Vec3> places, std::span<const Vec3> normals) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
    using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex>>;
    std::vector<std::pair<Kernel::Point_3, std::uint32_t>> points;
    Eigen::AlignedBox3d box;
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        const Vec3& p = places[i];
        box.extend(p);
        points.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), i);
    }
    const double largest = 0.5 * box.diagonal().norm();
    const Delaunay delaunay(points.begin(), points.end());
    SphereSet poles(places.size(), {Vec3::Zero(), 0});
    for (auto cell = delaunay.finite_cells_begin(); cell != delaunay.finite_cells_end(); ++cell) {
        const auto place = [&](int k) -> const Vec3& { return places[cell->vertex(k)->info()]; };
        const Vec3 centre = circumcentre(place(0), place(1), place(2), place(3));
        if (!centre.allFinite()) continue;
        for (int k = 0; k < 4; ++k) {
            const std::uint32_t i = cell->vertex(k)->info();
            const Vec3 away = centre - places[i];
            const double radius = away.norm();
            if (radius > largest || away.dot(normals[i]) >= 0) continue;
            if (radius > poles[i].radius) poles[i] = {centre, radius};
        }
    }
    return poles;
}

} // namespace tss::compare
