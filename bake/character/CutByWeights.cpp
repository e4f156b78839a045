#include "bake/character/CutByWeights.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

namespace tss {

namespace {

/// Vertices whose coordinates round to the same multiple of this share of the meshes' size are one.
constexpr double sameVertex = 1e-6;

bool isFinite(const Vec3& v) {
    return v.allFinite() && std::isfinite(v.squaredNorm());
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

/// All meshes as one: vertices that are at one place are one, each with what holds it.
class Cutter {
public:
    Cutter(std::span<const Holder> holders, std::span<const HeldMesh> meshes)
        : holders_(holders), meshes_(meshes) {
        double size = 0;
        for (const HeldMesh& mesh : meshes)
            for (const Vec3& v : mesh.points)
                if (isFinite(v)) size = std::max(size, v.norm());
        cell_ = size > 0 ? sameVertex * size : 1;
        for (std::size_t m = 0; m < meshes.size(); ++m) addTriangles(m);
    }

    std::map<int, BodyPart> cut() {
        for (Triangle& triangle : triangles_) place(triangle);
        findRims();
        for (auto& [body, part] : parts_) close(body, part.surface);
        return std::move(parts_);
    }

private:
    struct Vertex {
        Vec3 point;                                 ///< as it is bound
        std::vector<std::pair<int, float>> weights; ///< of holders
    };
    struct Triangle {
        std::array<int, 3> vertices;
        std::size_t mesh;
        int body = -1;
    };

    void addTriangles(std::size_t index) {
        const HeldMesh& mesh = meshes_[index];
        for (const auto& corner : mesh.triangles) {
            Triangle triangle{{}, index};
            const bool good = std::ranges::all_of(
                corner, [&](unsigned int v) { return v < mesh.points.size() && isFinite(mesh.points[v]); });
            if (!good) {
                ++part(holders_[mesh.loose].body, index).dropped;
                continue;
            }
            for (std::size_t k = 0; k < 3; ++k) triangle.vertices[k] = vertexAt(mesh, corner[k]);
            const auto& v = triangle.vertices;
            if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) triangles_.push_back(triangle);
        }
    }

    int vertexAt(const HeldMesh& mesh, unsigned int v) {
        const Vec3& point = mesh.points[v];
        const std::array<std::int64_t, 3> cell{std::llround(point.x() / cell_),
                                               std::llround(point.y() / cell_),
                                               std::llround(point.z() / cell_)};
        const auto [entry, fresh] = vertexAt_.emplace(cell, static_cast<int>(vertices_.size()));
        if (fresh) {
            vertices_.push_back({point, mesh.weights[v]});
            if (vertices_.back().weights.empty()) vertices_.back().weights.emplace_back(mesh.loose, 1.0f);
        }
        return entry->second;
    }

    BodyPart& part(int body, std::size_t mesh) {
        return parts_.try_emplace(body, BodyPart{mesh, {}, {}}).first->second;
    }

    /// The heaviest holder of a vertex that is of this body, or the other one.
    int holderOf(int vertex, int body, int other) const {
        int best = other;
        float most = 0;
        for (const auto& [holder, weight] : vertices_[vertex].weights)
            if (holders_[holder].body == body && weight > most) {
                most = weight;
                best = holder;
            }
        return best;
    }

    void place(Triangle& triangle) {
        std::map<int, float> bodies, holders;
        for (int vertex : triangle.vertices)
            for (const auto& [holder, weight] : vertices_[vertex].weights) {
                bodies[holders_[holder].body] += weight;
                holders[holder] += weight;
            }
        const auto lighter = [](const auto& a, const auto& b) { return a.second < b.second; };
        triangle.body = std::ranges::max_element(bodies, lighter)->first;
        std::erase_if(holders,
                      [&](const auto& entry) { return holders_[entry.first].body != triangle.body; });
        const int main = std::ranges::max_element(holders, lighter)->first;
        TriangleMesh& surface = part(triangle.body, triangle.mesh).surface;
        Tri corners;
        for (int k = 0; k < 3; ++k) corners[k] = vertexIn(surface, triangle.body, triangle.vertices[k], main);
        const bool turned = holders_[main].toBody.linear().determinant() < 0;
        const bool mirrored = turned != meshes_[triangle.mesh].mirrored;
        if (mirrored) std::swap(triangle.vertices[1], triangle.vertices[2]);
        surface.triangles.push_back(mirrored ? Tri(corners[0], corners[2], corners[1]) : corners);
    }

    int vertexIn(TriangleMesh& surface, int body, int vertex, int main) {
        const auto [entry, fresh] =
            inPart_.emplace(Edge{body, vertex}, static_cast<int>(surface.vertices.size()));
        if (fresh)
            surface.vertices.push_back(holders_[holderOf(vertex, body, main)].toBody *
                                       vertices_[vertex].point);
        return entry->second;
    }

    /// The edges of each part along which others went on.
    void findRims() {
        std::set<std::array<int, 3>> edges; // from, to, body
        for (const Triangle& triangle : triangles_)
            for (std::size_t k = 0; k < 3; ++k)
                edges.insert({triangle.vertices[k], triangle.vertices[(k + 1) % 3], triangle.body});
        for (const auto& [from, to, body] : edges) {
            if (edges.contains({to, from, body})) continue;
            for (auto back = edges.lower_bound({to, from, -1});
                 back != edges.end() && (*back)[0] == to && (*back)[1] == from; ++back) {
                rims_[body].insert({from, to});
                parts_.at(body).neighbours.insert((*back)[2]);
            }
        }
    }

    /// Fans over the rims.
    void close(int body, TriangleMesh& surface) {
        for (const std::vector<int>& loop : loopsOf(rims_[body])) {
            if (loop.size() < 3) continue;
            std::vector<int> at;
            Vec3 middle = Vec3::Zero();
            for (int vertex : loop) {
                at.push_back(inPart_.at({body, vertex}));
                middle += surface.vertices[at.back()];
            }
            if (loop.size() == 3) {
                surface.triangles.emplace_back(at[2], at[1], at[0]);
                continue;
            }
            const int centre = static_cast<int>(surface.vertices.size());
            surface.vertices.push_back(middle / static_cast<double>(loop.size()));
            for (std::size_t k = 0; k < at.size(); ++k)
                surface.triangles.emplace_back(at[(k + 1) % at.size()], at[k], centre);
        }
    }

    const std::span<const Holder> holders_;
    const std::span<const HeldMesh> meshes_;
    double cell_ = 1;
    std::vector<Vertex> vertices_;
    std::map<std::array<std::int64_t, 3>, int> vertexAt_;
    std::vector<Triangle> triangles_;
    std::map<int, BodyPart> parts_;      ///< by body
    std::map<int, std::set<Edge>> rims_; ///< by body
    std::map<Edge, int> inPart_;         ///< (body, vertex) -> vertex of the part
};

} // namespace

std::map<int, BodyPart> cutByWeights(std::span<const Holder> holders, std::span<const HeldMesh> meshes) {
    return Cutter(holders, meshes).cut();
}

} // namespace tss
