// Marching tetrahedra: Doi and Koide, "An efficient method of triangulating equi-valued surfaces by using
// tetrahedral cells", 1991.
#include "examples/doghead/mesh/Meshing.h"

#include "bake/base/Parallel.h"

#include <array>
#include <cmath>
#include <unordered_map>

namespace doghead {
namespace {

constexpr int blockSize = 8;

/// The cube's corners are numbered by bits (x 1, y 2, z 4); six tetrahedra around the diagonal 0-7, all of
/// the same handedness.
constexpr int tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                  {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

struct Grid {
    Vec3 origin;
    double cell;
    Eigen::Vector3i blocks;

    Vec3 at(const Eigen::Vector3i& i) const { return origin + cell * i.cast<double>(); }
    std::uint64_t key(const Eigen::Vector3i& i) const {
        return (std::uint64_t(i.z()) << 42) | (std::uint64_t(i.y()) << 21) | std::uint64_t(i.x());
    }
};

struct Block {
    Eigen::Vector3i first;
    std::vector<double> values; ///< (blockSize + 1)^3, x fastest; empty: the surface is not here

    double value(const Eigen::Vector3i& i) const {
        const Eigen::Vector3i l = i - first;
        return values[(l.z() * (blockSize + 1) + l.y()) * (blockSize + 1) + l.x()];
    }
};

void sample(const Field& field, const Grid& grid, Block& block) {
    const Vec3 half = Vec3::Constant(grid.cell * blockSize / 2);
    if (std::abs(field(grid.at(block.first) + half)) > 2 * half.norm()) return;
    for (int z = 0; z <= blockSize; ++z)
        for (int y = 0; y <= blockSize; ++y)
            for (int x = 0; x <= blockSize; ++x) {
                const double d = field(grid.at(block.first + Eigen::Vector3i(x, y, z)));
                block.values.push_back(d == 0 ? 1e-12 : d);
            }
}

/// Joins the triangles of all tetrahedra; vertices are shared by the grid edge they lie on.
class Builder {
public:
    explicit Builder(const Grid& grid) : grid_(grid) {}

    void tetrahedron(const std::array<Eigen::Vector3i, 4>& corner, const std::array<double, 4>& value) {
        std::array<int, 4> in, out;
        int ins = 0, outs = 0;
        for (int i = 0; i < 4; ++i) (value[i] < 0 ? in[ins++] : out[outs++]) = i;
        const auto cut = [&](int a, int b) { return vertex(corner[a], corner[b], value[a], value[b]); };
        Vec3 outward = Vec3::Zero();
        for (int i = 0; i < 4; ++i)
            outward +=
                corner[i].cast<double>() * (value[i] < 0 ? -1. / std::max(ins, 1) : 1. / std::max(outs, 1));
        if (ins == 1) triangle(cut(in[0], out[0]), cut(in[0], out[1]), cut(in[0], out[2]), outward);
        if (ins == 3) triangle(cut(in[0], out[0]), cut(in[1], out[0]), cut(in[2], out[0]), outward);
        if (ins == 2) {
            const int a = cut(in[0], out[0]), b = cut(in[0], out[1]), c = cut(in[1], out[1]),
                      d = cut(in[1], out[0]);
            triangle(a, b, c, outward);
            triangle(a, c, d, outward);
        }
    }

    tss::TriangleMesh mesh;

private:
    int vertex(Eigen::Vector3i a, Eigen::Vector3i b, double va, double vb) {
        if (grid_.key(b) < grid_.key(a)) std::swap(a, b), std::swap(va, vb);
        const Eigen::Vector3i step = b - a; // two corners of one cube: three bits tell the edge apart
        const int direction = (step.x() & 1) | (step.y() & 1) << 1 | (step.z() & 1) << 2;
        const auto [place, isNew] = index_.try_emplace(grid_.key(a) * 8 + direction, mesh.vertices.size());
        if (isNew) {
            const double t = std::clamp(va / (va - vb), 0.05, 0.95);
            mesh.vertices.push_back((1 - t) * grid_.at(a) + t * grid_.at(b));
        }
        return place->second;
    }

    void triangle(int a, int b, int c, const Vec3& outward) {
        const auto& v = mesh.vertices;
        const bool flip = (v[b] - v[a]).cross(v[c] - v[a]).dot(outward) < 0;
        mesh.triangles.push_back(flip ? tss::Tri(a, c, b) : tss::Tri(a, b, c));
    }

    const Grid& grid_;
    std::unordered_map<std::uint64_t, int> index_; ///< looked up only, never walked through
};

} // namespace

tss::TriangleMesh polygonize(const Field& field, double cell) {
    Grid grid{field.box.min() - Vec3::Constant(3.1 * cell), cell, {}};
    const Vec3 extent = field.box.max() + Vec3::Constant(3.1 * cell) - grid.origin;
    grid.blocks = (extent / (cell * blockSize)).array().ceil().cast<int>();

    std::vector<Block> blocks;
    for (int z = 0; z < grid.blocks.z(); ++z)
        for (int y = 0; y < grid.blocks.y(); ++y)
            for (int x = 0; x < grid.blocks.x(); ++x)
                blocks.push_back({blockSize * Eigen::Vector3i(x, y, z), {}});
    tss::parallelFor(blocks.size(), [&](std::size_t i) { sample(field, grid, blocks[i]); });

    Builder builder(grid);
    for (const Block& block : blocks) {
        if (block.values.empty()) continue;
        for (int z = 0; z < blockSize; ++z)
            for (int y = 0; y < blockSize; ++y)
                for (int x = 0; x < blockSize; ++x) {
                    std::array<Eigen::Vector3i, 8> corner;
                    std::array<double, 8> value;
                    for (int i = 0; i < 8; ++i) {
                        corner[i] =
                            block.first + Eigen::Vector3i(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
                        value[i] = block.value(corner[i]);
                    }
                    for (const auto& t : tetrahedra)
                        builder.tetrahedron({corner[t[0]], corner[t[1]], corner[t[2]], corner[t[3]]},
                                            {value[t[0]], value[t[1]], value[t[2]], value[t[3]]});
                }
    }
    return builder.mesh;
}

} // namespace doghead
