#include "DrawnVertices.h"
#include "PointGrid.h"

#include "bake/motion/TurnBetween.h"

#include <osgTSS/Convert>

#include <limits>
#include <numeric>

namespace osgTSS {

namespace {

/// Of the mesh's size: float coordinates that went through a file or another unit agree to this.
constexpr double same = 1e-5;

} // namespace

std::optional<DrawnVertices> DrawnVertices::of(const osg::Geometry& rest, const tss::TriangleMesh& mesh,
                                               double scale, std::vector<tss::Vec3> restNormals) {
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(rest.getVertexArray());
    if (!vertices || mesh.empty()) return std::nullopt;
    const Eigen::AlignedBox3d box = tss::bounds(mesh);
    const PointGrid grid(mesh.vertices, same * (box.diagonal().norm() + 1e-2 * box.center().norm()) +
                                            std::numeric_limits<float>::min());
    std::vector<int> meshVertex;
    std::vector<std::uint32_t> count(mesh.vertices.size() + 1, 0);
    for (const osg::Vec3& vertex : *vertices) {
        const tss::Vec3 point = scale * toCore(vertex);
        meshVertex.push_back(point.allFinite() ? grid.nearest(point) : -1);
        if (meshVertex.back() >= 0) ++count[static_cast<std::size_t>(meshVertex.back()) + 1];
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        if (count[v + 1] == 0) return std::nullopt;

    DrawnVertices drawn;
    drawn._scale = scale;
    drawn._restNormals = std::move(restNormals);
    drawn._start = std::move(count);
    std::partial_sum(drawn._start.begin(), drawn._start.end(), drawn._start.begin());
    drawn._drawn.resize(drawn._start.back());
    std::vector<std::uint32_t> next(drawn._start.begin(), drawn._start.end() - 1);
    for (std::size_t i = 0; i < meshVertex.size(); ++i)
        if (meshVertex[i] >= 0) drawn._drawn[next[meshVertex[i]]++] = static_cast<std::uint32_t>(i);
    const auto* normals = dynamic_cast<const osg::Vec3Array*>(rest.getNormalArray());
    if (normals && normals->size() == vertices->size())
        for (const std::uint32_t vertex : drawn._drawn)
            drawn._drawnNormals.push_back(toCore((*normals)[vertex]));
    drawn._all.resize(mesh.vertices.size());
    std::iota(drawn._all.begin(), drawn._all.end(), 0u);
    return drawn;
}

void DrawnVertices::deform(SkinGeometry& shown, std::span<const std::uint32_t> vertices,
                           std::span<const tss::Vec3> positions, std::span<const tss::Vec3> normals) {
    _moved.clear();
    _positions.clear();
    _normals.clear();
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const std::size_t v = vertices[k];
        const bool turned = !_drawnNormals.empty() && normals[k] != _restNormals[v];
        const Eigen::Quaterniond turn =
            turned ? tss::turnBetween(_restNormals[v], normals[k]) : Eigen::Quaterniond::Identity();
        for (std::uint32_t d = _start[v]; d < _start[v + 1]; ++d) {
            _moved.push_back(_drawn[d]);
            _positions.push_back(positions[k] / _scale);
            if (_drawnNormals.empty())
                _normals.push_back(tss::Vec3::Zero());
            else
                _normals.push_back(turned ? tss::Vec3(turn * _drawnNormals[d]) : _drawnNormals[d]);
        }
    }
    shown.deform(_moved, _positions, _normals);
}

void DrawnVertices::deform(SkinGeometry& shown, std::span<const tss::Vec3> positions,
                           std::span<const tss::Vec3> normals) {
    deform(shown, _all, positions, normals);
}

} // namespace osgTSS
