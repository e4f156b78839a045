#include "DrawnVertices.h"
#include "NearPoints.h"

#include "bake/base/Order.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/motion/SmallSystems.h"

#include <osgTSS/Convert>

#include <algorithm>
#include <limits>

namespace osgTSS {

namespace {

/// A share of the mesh's size: float coordinates that went through a file or another unit agree to this.
constexpr double same = 1e-5;

std::size_t nearestCorner(const tss::TriangleMesh& mesh, const tss::MeshQuery& surface,
                          const tss::Vec3& point) {
    const int triangle = surface.closest(point).triangle;
    int best = 0;
    for (int k = 1; k < 3; ++k)
        if ((mesh.corner(triangle, k) - point).squaredNorm() <
            (mesh.corner(triangle, best) - point).squaredNorm())
            best = k;
    return static_cast<std::size_t>(mesh.triangles[triangle][best]);
}

} // namespace

std::vector<bool> verticesIn(const osg::Geometry& geometry, bool triangles) {
    const osg::Array* vertices = geometry.getVertexArray();
    std::vector<bool> used(vertices ? vertices->getNumElements() : 0, false);
    for (const auto& primitives : geometry.getPrimitiveSetList()) {
        if (!primitives || (triangles && primitives->getMode() < GL_TRIANGLES)) continue;
        for (unsigned int k = 0; k < primitives->getNumIndices(); ++k)
            if (const unsigned int vertex = primitives->index(k); vertex < used.size()) used[vertex] = true;
    }
    return used;
}

std::optional<DrawnVertices> DrawnVertices::of(const osg::Geometry& rest, const tss::TriangleMesh& mesh,
                                               double scale, std::vector<tss::Vec3> restNormals) {
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(rest.getVertexArray());
    if (!vertices || mesh.empty()) return std::nullopt;
    const Eigen::AlignedBox3d box = tss::bounds(mesh);
    const NearPoints near(mesh.vertices, same * (box.diagonal().norm() + 1e-2 * box.center().norm()) +
                                             std::numeric_limits<float>::min());
    const std::vector<bool> used = verticesIn(rest, false);
    std::vector<std::vector<std::uint32_t>> standing(mesh.vertices.size()); ///< at each vertex of the mesh
    std::vector<std::uint32_t> beside;
    for (std::uint32_t i = 0; i < vertices->size(); ++i) {
        const tss::Vec3 point = scale * toCore((*vertices)[i]);
        if (!point.allFinite()) continue;
        if (const int v = near.nearest(point); v >= 0)
            standing[v].push_back(i);
        else if (used[i])
            beside.push_back(i);
    }
    if (std::ranges::any_of(standing, [](const auto& of) { return of.empty(); })) return std::nullopt;
    if (!beside.empty()) {
        const tss::MeshQuery surface(mesh);
        for (const std::uint32_t i : beside)
            standing[nearestCorner(mesh, surface, scale * toCore((*vertices)[i]))].push_back(i);
    }
    DrawnVertices drawn;
    drawn._scale = scale;
    drawn._restNormals = std::move(restNormals);
    drawn._drawn = tss::Lists<std::uint32_t>(standing);
    for (std::size_t v = 0; v < standing.size() && !beside.empty(); ++v)
        for (const std::uint32_t i : standing[v])
            drawn._away.push_back(scale * toCore((*vertices)[i]) - mesh.vertices[v]);
    const auto* normals = dynamic_cast<const osg::Vec3Array*>(rest.getNormalArray());
    if (normals && normals->size() == vertices->size())
        for (const std::uint32_t vertex : drawn._drawn.items())
            drawn._drawnNormals.push_back(toCore((*normals)[vertex]));
    drawn._all = tss::indicesOf(mesh.vertices.size());
    return drawn;
}

void DrawnVertices::deform(SkinGeometry& shown, std::span<const std::uint32_t> vertices,
                           std::span<const tss::Vec3> positions, std::span<const tss::Vec3> normals) {
    _moved.clear();
    _positions.clear();
    _normals.clear();
    const bool turns = !_drawnNormals.empty() || !_away.empty();
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const std::size_t v = vertices[k];
        const bool turned = turns && !_restNormals.empty() && normals[k] != _restNormals[v];
        const Eigen::Quaterniond turn =
            turned ? tss::turnBetween(_restNormals[v], normals[k]) : Eigen::Quaterniond::Identity();
        std::ptrdiff_t d = _drawn[v].data() - _drawn.items().data();
        for (const std::uint32_t drawn : _drawn[v]) {
            _moved.push_back(drawn);
            _positions.push_back((_away.empty() ? positions[k] : tss::Vec3(positions[k] + turn * _away[d])) /
                                 _scale);
            if (_drawnNormals.empty())
                _normals.push_back(tss::Vec3::Zero());
            else
                _normals.push_back(turned ? tss::Vec3(turn * _drawnNormals[d]) : _drawnNormals[d]);
            ++d;
        }
    }
    shown.deform(_moved, _positions, _normals);
}

void DrawnVertices::deform(SkinGeometry& shown, std::span<const tss::Vec3> positions,
                           std::span<const tss::Vec3> normals) {
    deform(shown, _all, positions, normals);
}

} // namespace osgTSS
