#include "SkeletonMeshes.h"

#include "CollectTriangles.h"
#include "osgTSS/src/NodePaths.h"

#include <osgTSS/Convert>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>

namespace osgTSS {

namespace {

/// Vertices whose coordinates round to the same multiple of this share of the meshes' size are one.
constexpr double sameVertex = 1e-6;

osg::Geometry& sourceOf(osgAnimation::RigGeometry& rig) {
    return rig.getSourceGeometry() ? *rig.getSourceGeometry() : rig;
}

bool finite(const osg::Vec3d& v) {
    return v.valid() && std::isfinite(v.length2());
}

using Edge = std::pair<int, int>;

/// Closed ways along directed edges; what does not close is left out.
std::vector<std::vector<int>> loopsOf(const std::set<Edge>& edges) {
    std::vector<std::vector<int>> loops;
    std::set<Edge> left = edges;
    while (!left.empty()) {
        std::vector<int> way{left.begin()->first};
        for (int at = way.front();;) {
            const auto next = left.lower_bound({at, -1});
            if (next == left.end() || next->first != at) break;
            at = next->second;
            left.erase(next);
            // Where the way meets itself a loop is done.
            const auto before = std::ranges::find(way, at);
            if (before != way.end()) {
                loops.emplace_back(before, way.end());
                way.erase(before + 1, way.end());
            } else {
                way.push_back(at);
            }
        }
    }
    return loops;
}

} // namespace

/// All meshes as one: vertices that are at one place are one, each with what holds it.
class SkeletonMeshes::Cutter {
public:
    explicit Cutter(const SkeletonMeshes& parts) : _p(parts) {
        for (const auto& [name, held] : parts._bones) _holders.push_back(held);
        double size = 0;
        for (const Rig& rig : parts._rigs) {
            addLoose(rig);
            for (const osg::Vec3d& v : verticesOf(rig))
                if (finite(v)) size = std::max(size, v.length());
        }
        _cell = size > 0 ? sameVertex * size : 1;
        for (const Rig& rig : parts._rigs) addTriangles(rig);
    }

    std::map<int, Part> cut() {
        for (Triangle& triangle : _triangles) place(triangle);
        for (auto& [body, part] : _parts) close(body, part);
        return std::move(_parts);
    }

private:
    struct Vertex {
        osg::Vec3d point;                           ///< in the skeleton
        std::vector<std::pair<int, float>> weights; ///< of holders
    };
    struct Triangle {
        std::array<int, 3> vertices;
        const Rig* rig;
        int body = -1;
    };

    /// A vertex that no bone holds moves with the node of its mesh.
    void addLoose(const Rig& rig) {
        Held loose{nullptr, rig.place};
        loose.place.toBody = osg::Matrixd::inverse(rig.toSkeleton) * rig.place.toBody;
        _holders.push_back(loose);
    }

    /// In the skeleton.
    static std::vector<osg::Vec3d> verticesOf(const Rig& rig) {
        std::vector<osg::Vec3d> points = pointsOf(sourceOf(*rig.geometry));
        for (osg::Vec3d& point : points) point = point * rig.toSkeleton;
        return points;
    }

    void addTriangles(const Rig& rig) {
        const std::vector<osg::Vec3d> points = verticesOf(rig);
        std::vector<std::vector<std::pair<int, float>>> weights(points.size());
        if (const auto* map = rig.geometry->getInfluenceMap())
            for (const auto& [name, influence] : *map) {
                const auto bone = _p._bones.find(name);
                if (bone == _p._bones.end()) continue;
                const int holder = static_cast<int>(std::distance(_p._bones.begin(), bone));
                for (const auto& [vertex, weight] : influence)
                    if (vertex < weights.size() && weight > 0) weights[vertex].emplace_back(holder, weight);
            }
        const int loose = static_cast<int>(_p._bones.size() + (&rig - _p._rigs.data()));
        for (const auto& corner : trianglesOf(sourceOf(*rig.geometry))) {
            Triangle triangle{{}, &rig};
            const bool good = std::ranges::all_of(
                corner, [&](unsigned int v) { return v < points.size() && finite(points[v]); });
            if (!good) {
                ++part(rig.place.body, rig).dropped;
                continue;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                auto& held = weights[corner[k]];
                if (held.empty()) held.emplace_back(loose, 1.0f);
                triangle.vertices[k] = vertexAt(points[corner[k]], held);
            }
            const auto& v = triangle.vertices;
            if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) _triangles.push_back(triangle);
        }
    }

    int vertexAt(const osg::Vec3d& point, const std::vector<std::pair<int, float>>& weights) {
        const std::array<std::int64_t, 3> cell{std::llround(point.x() / _cell),
                                               std::llround(point.y() / _cell),
                                               std::llround(point.z() / _cell)};
        const auto [entry, fresh] = _vertexAt.emplace(cell, static_cast<int>(_vertices.size()));
        if (fresh) _vertices.push_back({point, weights});
        return entry->second;
    }

    Part& part(int body, const Rig& rig) { return _parts.try_emplace(body, Part{&rig, {}}).first->second; }

    /// The heaviest holder of a vertex that is of this body, or the other one.
    int holderOf(int vertex, int body, int other) const {
        int best = other;
        float most = 0;
        for (const auto& [holder, weight] : _vertices[vertex].weights)
            if (_holders[holder].place.body == body && weight > most) {
                most = weight;
                best = holder;
            }
        return best;
    }

    osg::Matrixd toBody(int holder) const {
        const Held& held = _holders[holder];
        return held.bone ? held.bone->getInvBindMatrixInSkeletonSpace() * held.place.toBody
                         : held.place.toBody;
    }

    void place(Triangle& triangle) {
        std::map<int, float> bodies, holders;
        for (int vertex : triangle.vertices)
            for (const auto& [holder, weight] : _vertices[vertex].weights) {
                bodies[_holders[holder].place.body] += weight;
                holders[holder] += weight;
            }
        const auto lighter = [](const auto& a, const auto& b) { return a.second < b.second; };
        triangle.body = std::ranges::max_element(bodies, lighter)->first;
        std::erase_if(holders,
                      [&](const auto& entry) { return _holders[entry.first].place.body != triangle.body; });
        const int main = std::ranges::max_element(holders, lighter)->first;
        Part& of = part(triangle.body, *triangle.rig);
        tss::Tri corners;
        for (int k = 0; k < 3; ++k) corners[k] = vertexIn(of, triangle.body, triangle.vertices[k], main);
        const osg::Matrixd& fromMesh = triangle.rig->toSkeleton;
        const bool mirrored = (determinant(fromMesh * toBody(main)) < 0) != (_holders[main].place.scale < 0);
        if (mirrored) std::swap(triangle.vertices[1], triangle.vertices[2]);
        of.mesh.triangles.push_back(mirrored ? tss::Tri(corners[0], corners[2], corners[1]) : corners);
    }

    int vertexIn(Part& of, int body, int vertex, int main) {
        const auto [entry, fresh] =
            _inPart.emplace(Edge{body, vertex}, static_cast<int>(of.mesh.vertices.size()));
        if (!fresh) return entry->second;
        const int holder = holderOf(vertex, body, main);
        const Held& held = _holders[holder];
        of.mesh.vertices.push_back(held.place.scale * toCore(_vertices[vertex].point * toBody(holder)));
        return entry->second;
    }

    /// Fans over the rims along which other parts went on.
    void close(int body, Part& of) {
        std::set<Edge> own, others, rim;
        for (const Triangle& triangle : _triangles)
            for (std::size_t k = 0; k < 3; ++k)
                (triangle.body == body ? own : others)
                    .insert({triangle.vertices[k], triangle.vertices[(k + 1) % 3]});
        for (const Edge& edge : own) {
            const Edge back{edge.second, edge.first};
            if (!own.contains(back) && others.contains(back)) rim.insert(edge);
        }
        for (const std::vector<int>& loop : loopsOf(rim)) {
            if (loop.size() < 3) continue;
            std::vector<int> at;
            tss::Vec3 middle = tss::Vec3::Zero();
            for (int vertex : loop) {
                at.push_back(_inPart.at({body, vertex}));
                middle += of.mesh.vertices[at.back()];
            }
            if (loop.size() == 3) {
                of.mesh.triangles.emplace_back(at[2], at[1], at[0]);
                continue;
            }
            const int centre = static_cast<int>(of.mesh.vertices.size());
            of.mesh.vertices.push_back(middle / static_cast<double>(loop.size()));
            for (std::size_t k = 0; k < at.size(); ++k)
                of.mesh.triangles.emplace_back(at[(k + 1) % at.size()], at[k], centre);
        }
    }

    const SkeletonMeshes& _p;
    std::vector<Held> _holders; ///< the bones, then what moves with the node of each mesh
    double _cell = 1;
    std::vector<Vertex> _vertices;
    std::map<std::array<std::int64_t, 3>, int> _vertexAt;
    std::vector<Triangle> _triangles;
    std::map<int, Part> _parts;  ///< by body
    std::map<Edge, int> _inPart; ///< (body, vertex) -> vertex of the part
};

void SkeletonMeshes::addRig(osgAnimation::RigGeometry& rig, const osg::NodePath& path,
                            const PlaceInBody& place) {
    const auto at = std::find(path.begin(), path.end(), &_skeleton);
    _rigs.push_back({&rig, alongPath(osg::NodePath(at + 1, path.end())), place});
}

std::map<int, SkeletonMeshes::Part> SkeletonMeshes::parts() const {
    return Cutter(*this).cut();
}

} // namespace osgTSS
