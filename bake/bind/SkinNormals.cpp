#include "bake/bind/SkinNormals.h"

#include <utility>

namespace tss {
namespace {

/// The two other corners of a triangle at a vertex, in the triangle's order.
using Side = std::pair<std::uint32_t, std::uint32_t>;

/// Pairs each triangle with the next one around the vertex, if there is one that is not yet paired.
void pairUp(std::vector<Side>& sides, std::uint32_t vertex, Lists<SkinFan>& fans) {
    const auto successor = [&](std::uint32_t corner) {
        std::size_t k = 0;
        while (k < sides.size() && sides[k].first != corner) ++k;
        return k;
    };
    const auto hasPredecessor = [&](std::size_t at) {
        for (const Side& side : sides)
            if (side.second == sides[at].first) return true;
        return false;
    };
    while (!sides.empty()) {
        // At a rim begin with the first triangle, so that few remain single.
        std::size_t at = 0;
        while (at + 1 < sides.size() && hasPredecessor(at)) ++at;
        if (hasPredecessor(at)) at = 0;
        const Side side = sides[at];
        sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(at));
        const std::size_t next = successor(side.second);
        if (next == sides.size()) {
            fans.push_back({side.first, side.second, vertex});
            continue;
        }
        fans.push_back({side.second, sides[next].second, side.first});
        sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(next));
    }
    fans.endList();
}

} // namespace

std::vector<Vec3> skinNormals(const TriangleMesh& skin) {
    std::vector<Vec3> normals(skin.vertices.size(), Vec3::Zero());
    for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
        const Tri& t = skin.triangles[i];
        const Vec3 n = skin.areaNormal(i);
        for (int k = 0; k < 3; ++k) normals[t[k]] += n;
    }
    for (Vec3& n : normals)
        if (n.squaredNorm() > 0) n.normalize();
    return normals;
}

Lists<SkinFan> skinFans(const std::vector<Tri>& triangles, std::size_t count) {
    std::vector<std::vector<Side>> sides(count);
    for (const Tri& t : triangles)
        for (int k = 0; k < 3; ++k)
            if (static_cast<std::size_t>(t[k]) < count)
                sides[t[k]].emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
    Lists<SkinFan> fans;
    for (std::uint32_t v = 0; v < count; ++v) pairUp(sides[v], v, fans);
    return fans;
}

} // namespace tss
